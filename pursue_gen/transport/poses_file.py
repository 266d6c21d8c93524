"""Where the points are on the robots' own map: a poses.yaml as workspaces have it, read for a scenario."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, List, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_gen.language.messages import shown
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.language.similar import closest

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_FORM = "write NAME: [x, y, z, qx, qy, qz, qw]: metres on the map, and a unit quaternion; 0, 0, 0, 1 looks along x"
_FARTHEST = 1e6  # metres; anything beyond is a slip of the pen
_LOOSE = 0.05  # so much may a quaternion's length be off, as in scenarios
_ROUNDING = 1e-9


def with_poses(scenario: Scenario, file: Path) -> Scenario:
    """The scenario with the poses of the file, which come before its own.

    Raises PursueError (exit status 2) with the places of everything that is wrong.
    """
    poses = read_poses(file, tuple(poi.name for poi in scenario.pois))
    return replace(scenario, pois=tuple(replace(poi, pose=poses.get(poi.name, poi.pose)) for poi in scenario.pois))


def read_poses(file: Path, points: Tuple[str, ...]) -> Dict[str, Pose]:
    """The poses in a poses.yaml; `points` are the names that it may have. Raises as `with_poses`."""
    text = read_text(file, "a file of poses, such as config/poses.yaml of a workspace")
    reader = _Reader(str(file), points)
    poses = reader.poses(compose_yaml(text, str(file), "TRN011", _FORM))
    if reader.findings:
        raise PursueError(reader.findings, exit_status=2)
    return poses


class _Reader:
    """Walks over YAML's nodes, which know their places, and gathers what is wrong."""

    def __init__(self, file: str, points: Tuple[str, ...]) -> None:
        self._file = file
        self._points = points
        self.findings: List[Diagnostic] = []

    def poses(self, root: Any) -> Dict[str, Pose]:
        top = {} if root is None else self._entries(root, "the lines format: 1 and poses:")
        form, computed, listed = (top.get(name, (None, None))[1] for name in ("format", "computed", "poses"))
        if form is not None and form.value != "1":
            self._wrong(form, "this is of a format that is not known; expected format: 1", _FORM)
        if computed is not None and str(computed.value).lower() in ("true", "yes", "on"):
            hint = "put your map's poses here and say computed: false; for simulated robots use --computed-poses"
            self._wrong(computed, "these poses are computed from distances, not measured", hint)
        for name in [name for name in top if name not in ("format", "computed", "poses")]:
            self._wrong(top[name][0], f"'{shown(name)}' is not known here; expected format, computed, poses", _FORM)
        if listed is None:
            self._wrong(root, "there are no poses here; expected poses: and a line for each point", _FORM)
            return {}
        found = {}
        for name, (key, node) in self._entries(listed, "a line for each point").items():
            if name in self._points:
                found[name] = self._pose(node)
                continue
            meant = closest(name, self._points)
            hint = f"did you mean {meant}?" if meant else f"its points are {', '.join(self._points)}"
            self._wrong(key, f"the scenario has no point '{shown(name)}'", hint)
        return {name: pose for name, pose in found.items() if pose is not None}

    def _entries(self, node: Any, expected: str) -> Dict[str, Tuple[Any, Any]]:
        """name → the nodes of this key and of its value, of a mapping."""
        if getattr(node, "id", "") != "mapping":
            self._wrong(node, f"expected {expected}", _FORM)
            return {}
        found: Dict[str, Tuple[Any, Any]] = {}
        for key, value in node.value:
            if key.id != "scalar" or key.value in found:
                self._wrong(key, "this is here twice" if key.id == "scalar" else "expected a name", _FORM)
                continue
            found[key.value] = (key, value)
        return found

    def _pose(self, node: Any) -> Any:
        """The pose in a list of seven numbers; None where it is none."""
        if node.id != "sequence" or len(node.value) != 7:
            number = len(node.value) if node.id == "sequence" else "none"
            return self._wrong(node, f"a pose has seven numbers, here are {number}", _FORM)
        for item in node.value:
            if item.id != "scalar" or item.style is not None or not _NUMBER.fullmatch(item.value):
                return self._wrong(item, "expected a number", _FORM)
            if not abs(float(item.value)) <= _FARTHEST:
                return self._wrong(item, "a pose farther than a thousand kilometres away cannot be meant", _FORM)
        x, y, z, qx, qy, qz, qw = (float(item.value) for item in node.value)
        length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
        if abs(length - 1) > _LOOSE:
            return self._wrong(node.value[3], f"the last four numbers have length {length:.2f}; expected 1", _FORM)
        if abs(length - 1) > _ROUNDING:
            qx, qy, qz, qw = qx / length, qy / length, qz / length, qw / length
        return Pose(x, y, z, qx, qy, qz, qw)

    def _wrong(self, node: Any, message: str, hint: str) -> None:
        self.findings.append(error("TRN011", message, span_of(node, self._file), hint))
