"""What a robot needs where it stands: its size, from the scenario, the parameters of its move_base, or in metres."""

from __future__ import annotations

import math
import re
from dataclasses import astuple, dataclass, field, replace
from functools import reduce
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Set

from pursue_gen.diagnostics import usage_error
from pursue_gen.files import read_text
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.language.similar import closest
from pursue_gen.language.statements.agent import MOST_METRES
from pursue_runtime.bounded import SETTINGS, BadText, read_yaml

_PADDING = 0.01
"""Metres that costmap_2d adds to a footprint where `footprint_padding` does not say otherwise."""
_CARELESS = "DWAPlannerROS"
"""The planner that drives to goals within what is inflated: it weighs obstacles little in comparison with its path."""
_OF_ONE = re.compile(r"([^\W\d]\w*)=(.*)", re.DOTALL)
_FORM = "METRES, or the yaml file of a robot's costmap or planner, with footprint, robot_radius, inflation_radius or "
_FORM += "xy_goal_tolerance"


@dataclass(frozen=True)
class RobotSize:
    """What a robot needs, in metres.

    `radius`: from the middle to the farthest part, so that it can turn; `tolerance`: how far from its goal it stops at
    most (`xy_goal_tolerance`); `inflation`: how far around obstacles its planner does not like any part of it to be, 0
    where that is not known, or its planner does not care.
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
        """How far from an obstacle its goal should be, so that no part of it comes into what is inflated."""
        return self.needed + self.inflation

    @property
    def apart(self) -> float:
        """How far apart the goals of two robots of this size have to be."""
        return 2 * self.needed

    def or_larger(self, other: RobotSize) -> RobotSize:
        """What both robots need, the larger number of each."""
        return RobotSize(*(max(pair) for pair in zip(astuple(self), astuple(other))))


USUAL = RobotSize()
"""That of robots of which nothing is known."""


@dataclass(frozen=True)
class Sizes:
    """The sizes of a scenario's robots: `own` has those that are known, `largest` is that of the largest one."""

    largest: RobotSize = USUAL
    own: Mapping[str, RobotSize] = field(default_factory=dict)

    @property
    def kinds(self) -> Set[RobotSize]:
        """The sizes that there are."""
        return {self.largest, *self.own.values()}

    def of(self, robots: Iterable[str]) -> RobotSize:
        """What all of these robots need; without any the largest one."""
        sizes = [self.own.get(robot, self.largest) for robot in robots]
        return reduce(RobotSize.or_larger, sizes) if sizes else self.largest

    def with_radius(self, radius: Optional[float]) -> Sizes:
        """The sizes with this radius for all robots; None: as they are."""
        if radius is None:
            return self
        own = {robot: replace(size, radius=radius) for robot, size in self.own.items()}
        return Sizes(replace(self.largest, radius=radius), own)


ALIKE = Sizes()
"""Those of robots of which nothing is known."""

Told = Mapping[str, Mapping[str, float]]
"""What commands are told of sizes: robot ("": all others) → `radius`, `tolerance`, `inflation` as far as given."""
NOTHING_TOLD: Told = {}


def sizes_of(scenario: Scenario, told: Told = NOTHING_TOLD) -> Sizes:
    """The sizes of the scenario's robots: what was told goes before what the scenario says, and that before `USUAL`.

    Raises PursueError (exit status 2) where something was told of what is no robot of the scenario.
    """
    own = {agent.name: replace(USUAL, **_said(agent)) for agent in scenario.agents if agent.is_robot}
    for name in set(told) - {""} - set(own):
        near = closest(name, tuple(own))
        hint = f"did you mean {near}?" if near else f"expected one of: {', '.join(own) or 'it has none'}"
        raise usage_error(f"--robot {name}=…: {name} is not a robot of the scenario", hint)
    own = {name: replace(size, **{**told.get("", {}), **told.get(name, {})}) for name, size in own.items()}
    return Sizes(reduce(RobotSize.or_larger, own.values()) if own else replace(USUAL, **told.get("", {})), own)


def _said(agent: Agent) -> Dict[str, float]:
    size = {"radius": agent.radius, "tolerance": agent.tolerance, "inflation": agent.inflation}
    return {name: float(metres) for name, metres in size.items() if metres is not None}


def read_sizes(texts: Sequence[str]) -> Told:
    """The sizes in texts: each is a radius in metres, or a yaml file with parameters of costmaps and planners, of all
    robots or with `bot1=` before it.

    The largest number counts of each, in whole millimetres, as scenarios have it. Raises PursueError (exit status 2).
    """
    found: Dict[str, Dict[str, float]] = {}
    for text in texts:
        match = _OF_ONE.match(text)
        robot, size = (match[1], match[2]) if match else ("", text)
        metres = _as_metres(size)
        sizes = found.setdefault(robot, {})
        for name, value in [("radius", metres)] if metres is not None else _in_file(Path(size)):
            sizes[name] = max(sizes.get(name, 0.0), math.ceil(round(1000 * value, 6)) / 1000)
    for sizes in found.values():
        if sizes.pop(_CARELESS, 0.0):
            sizes.pop("inflation", None)
    return found


def _as_metres(text: str) -> Optional[float]:
    try:
        metres = float(text)
    except ValueError:
        return None
    if not 0 <= metres <= MOST_METRES:
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
    for name, value in data.items():
        if name == _CARELESS or (name == "base_local_planner" and str(value).endswith(_CARELESS)):
            yield _CARELESS, 1.0
        yield from _sizes(value, file)


def _is_there(data: Mapping[str, Any], key: str) -> bool:
    return data.get(key) not in (None, "", [], "[]")


def _number(data: Mapping[str, Any], key: str, file: Path) -> Optional[float]:
    value = data.get(key)
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value <= MOST_METRES:
        raise usage_error(f"{file}: {key} is {_shown(value)}", f"expected metres, from 0 to {MOST_METRES:g}")
    return float(value)


def _circumscribed(footprint: Any, padding: float, file: Path) -> float:
    """The distance of the farthest corner from the middle, with the padding of costmap_2d."""
    try:
        corners = read_yaml(footprint, SETTINGS) if isinstance(footprint, str) else footprint
        farthest = max(math.hypot(abs(float(x)) + padding, abs(float(y)) + padding) for x, y in corners)
    except (BadText, TypeError, ValueError):
        farthest = math.nan
    if not 0 <= farthest <= MOST_METRES:
        message = f"{file}: footprint is {_shown(footprint)}"
        raise usage_error(message, "expected its corners in metres: [[0.2, 0.15], [-0.2, 0.15], …]")
    return farthest


def _shown(value: Any) -> str:
    words = repr(value)
    return words if len(words) <= 60 else words[:59] + "…"
