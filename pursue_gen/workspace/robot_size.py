"""What a robot needs where it stands: its size, from the parameters of its move_base or in metres."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence

from pursue_gen.diagnostics import usage_error
from pursue_gen.files import read_text
from pursue_runtime.bounded import SETTINGS, BadText, read_yaml

_LARGEST = 100.0
"""Metres."""
_PADDING = 0.01
"""Metres that costmap_2d adds to a footprint where `footprint_padding` does not say otherwise."""
_FORM = "METRES, or the yaml file of a robot's costmap or planner, with footprint, robot_radius, inflation_radius or "
_FORM += "xy_goal_tolerance"


@dataclass(frozen=True)
class RobotSize:
    """What robots need, in metres: those of the largest one.

    `radius`: from the middle to the farthest part, so that it can turn; `tolerance`: how far from its goal it stops at
    most (`xy_goal_tolerance`); `inflation`: how far from obstacles its planners avoid to drive, 0 where that is not
    known.
    """

    radius: float = 0.3
    tolerance: float = 0.1
    inflation: float = 0.0

    @property
    def needed(self) -> float:
        """How far from an obstacle its goal has to be: it stops within its tolerance, and turns there."""
        return self.radius + self.tolerance

    @property
    def wanted(self) -> float:
        """How far from an obstacle its goal should be, so that its planners need not cross what is inflated."""
        return max(self.needed, self.inflation)

    @property
    def apart(self) -> float:
        """How far apart the goals of two robots have to be."""
        return 2 * self.needed


USUAL = RobotSize()
"""That of robots of which nothing is known."""


def read_size(texts: Sequence[str]) -> RobotSize:
    """The size of robots: of each text a radius in metres, or a yaml file with parameters of costmaps and planners.

    The largest number counts of each, and that of `USUAL` where there is none. Raises PursueError (exit
    status 2).
    """
    found: Dict[str, List[float]] = {"radius": [], "tolerance": [], "inflation": []}
    for text in texts:
        metres = _as_metres(text)
        for name, value in [("radius", metres)] if metres is not None else _in_file(Path(text)):
            found[name].append(value)
    return replace(USUAL, **{name: max(values) for name, values in found.items() if values})


def _as_metres(text: str) -> Optional[float]:
    try:
        metres = float(text)
    except ValueError:
        return None
    if not 0 <= metres <= _LARGEST:
        raise usage_error(f"--robot {text}: no robot has such a radius", f"expected {_FORM}")
    return metres


def _in_file(file: Path) -> List[Any]:
    text = read_text(file, "parameters of a robot, such as costmap_common_params.yaml, or its radius in metres")
    try:
        found = list(_sizes(read_yaml(text, SETTINGS), file))
    except BadText as problem:
        hint = "expected lines such as inflation_radius: 0.55"
        raise usage_error(f"{file} cannot be read: {problem}", hint) from None
    if not found:
        raise usage_error(f"{file} says nothing of a robot's size", f"expected {_FORM}")
    return found


def _sizes(data: Any, file: Path) -> Iterator[Any]:
    """The numbers in parameters, on whatever level they stand."""
    if not isinstance(data, dict):
        return
    padding = _number(data, "footprint_padding", file)
    if _is_there(data, "footprint"):  # which goes before the radius, as for costmap_2d
        yield "radius", _circumscribed(data["footprint"], _PADDING if padding is None else padding, file)
    elif _is_there(data, "robot_radius"):
        radius = _number(data, "robot_radius", file)
        assert radius is not None
        yield "radius", radius + (_PADDING if padding is None else padding)
    for key, name in (("inflation_radius", "inflation"), ("xy_goal_tolerance", "tolerance")):
        value = _number(data, key, file)
        if value is not None:
            yield name, value
    for value in data.values():
        yield from _sizes(value, file)


def _is_there(data: Mapping[str, Any], key: str) -> bool:
    return data.get(key) not in (None, "", [], "[]")


def _number(data: Mapping[str, Any], key: str, file: Path) -> Optional[float]:
    value = data.get(key)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= _LARGEST:
        raise usage_error(f"{file}: {key} is {_shown(value)}", f"expected metres, from 0 to {_LARGEST:g}")
    return float(value)


def _circumscribed(footprint: Any, padding: float, file: Path) -> float:
    """The distance of the farthest corner from the middle, with the padding of costmap_2d."""
    try:
        corners = read_yaml(footprint, SETTINGS) if isinstance(footprint, str) else footprint
        farthest = max(math.hypot(abs(float(x)) + padding, abs(float(y)) + padding) for x, y in corners)
    except (BadText, TypeError, ValueError):
        farthest = math.nan
    if not 0 <= farthest <= _LARGEST:
        message = f"{file}: footprint is {_shown(footprint)}"
        raise usage_error(message, "expected its corners in metres: [[0.2, 0.15], [-0.2, 0.15], …]")
    return farthest


def _shown(value: Any) -> str:
    words = repr(value)
    return words if len(words) <= 60 else words[:59] + "…"
