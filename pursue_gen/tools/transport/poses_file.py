"""Where the points are on the robots' own map: a poses.yaml as workspaces have it, read for a scenario."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_gen.language.scenario import Poi, Pose, Ref, Scenario, Spot
from pursue_gen.language.similar import closest
from pursue_gen.language.tokens import shown

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_FORM = "write NAME: [x, y, z, qx, qy, qz, qw]: metres on the map, and a unit quaternion; 0, 0, 0, 1 looks along x"
_KEYS = ("format", "computed", "poses", "robots", "spare")
_FARTHEST = 1e6  # metres; anything beyond is a slip of the pen
_LOOSE = 0.05  # so much may a quaternion's length be off, as in scenarios
_ROUNDING = 1e-9


@dataclass(frozen=True)
class GivenPoses:
    """The poses of a file: place → pose, and robot → place → pose for single robots."""

    places: Mapping[str, Pose]
    own: Mapping[str, Mapping[str, Pose]]


def with_poses(scenario: Scenario, file: Path) -> Scenario:
    """The scenario with the poses of the file. Those that the scenario has at the places of the file do not count.

    Raises PursueError (exit status 2) with the places of everything that is wrong.
    """
    robots = tuple(agent.name for agent in scenario.agents if agent.is_robot)
    given = read_poses(file, tuple(poi.name for poi in scenario.pois), robots)
    return replace(scenario, pois=tuple(_placed(poi, given) for poi in scenario.pois))


def _placed(poi: Poi, given: GivenPoses) -> Poi:
    """The point with what is given for it."""
    if poi.name not in given.places:
        return poi
    own = [(robot, table[poi.name]) for robot, table in given.own.items() if poi.name in table]
    spots = tuple(Spot(Ref(robot, poi.span), pose) for robot, pose in own)
    return replace(poi, pose=given.places[poi.name], spots=spots)


def read_poses(file: Path, points: Tuple[str, ...], robots: Tuple[str, ...] = ()) -> GivenPoses:
    """The poses in a poses.yaml; `points` and `robots` are the names that it may have. Raises as `with_poses`."""
    text = read_text(file, "a file of poses, such as config/poses.yaml of a workspace's UI")
    reader = _PosesReader(str(file), points, robots)
    poses = reader.poses(compose_yaml(text, str(file), "TRN011", _FORM))
    if reader.findings:
        raise PursueError(reader.findings)
    return poses


class _PosesReader:
    """Walks over YAML's nodes, which know their places, and gathers what is wrong."""

    def __init__(self, file: str, points: Tuple[str, ...], robots: Tuple[str, ...]) -> None:
        self._file = file
        self._points = points
        self._robots = robots
        self.findings: List[Diagnostic] = []

    def poses(self, root: Any) -> GivenPoses:
        top = {} if root is None else self._entries(root, "the lines format: 1 and poses:")
        form, computed, listed, robots, _ = (top.get(name, (None, None))[1] for name in _KEYS)
        if form is not None and form.value not in ("1", "2", "3"):
            self._wrong(form, "this is of a format that is not known; expected format: 1, 2 or 3", _FORM)
        if computed is not None and str(computed.value).lower() in ("true", "yes", "on"):
            hint = "put your map's poses here and say computed: false; for simulated robots use --computed-poses"
            self._wrong(computed, "these poses are computed from distances, not measured", hint)
        for name in [name for name in top if name not in _KEYS]:
            self._wrong(top[name][0], f"'{shown(name)}' is not known here; expected {', '.join(_KEYS)}", _FORM)
        if listed is None:
            self._wrong(root, "there are no poses here; expected poses: and a line for each point", _FORM)
            return GivenPoses({}, {})
        places = self._table(listed)
        own: Dict[str, Dict[str, Pose]] = {}
        tables = {} if robots is None else self._entries(robots, "a table of poses for each robot")
        for robot, (key, node) in tables.items():
            if robot not in self._robots:
                self._unknown(key, "robot", robot, self._robots)
                continue
            own[robot] = self._table(node)
            for name in [name for name in own[robot] if name not in places]:
                self._wrong(node, f"{robot} has a pose at {name}, which is not among poses:", _FORM)
        return GivenPoses(places, own)

    def _table(self, root: Any) -> Dict[str, Pose]:
        """The poses in a mapping of points."""
        found = {}
        for name, (key, node) in self._entries(root, "a line for each point").items():
            if name in self._points:
                found[name] = self._pose(node)
            else:
                self._unknown(key, "point", name, self._points)
        return {name: pose for name, pose in found.items() if pose is not None}

    def _unknown(self, key: Any, kind: str, name: str, known: Tuple[str, ...]) -> None:
        meant = closest(name, known)
        hint = f"did you mean {meant}?" if meant else f"its {kind}s are {', '.join(known)}"
        self._wrong(key, f"the scenario has no {kind} '{shown(name)}'", hint)

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
                message = f"a pose is off the map: farther than {_FARTHEST:,.0f} m from its origin"
                return self._wrong(item, message, _FORM)
        x, y, z, qx, qy, qz, qw = (float(item.value) for item in node.value)
        length = math.sqrt(qx * qx + qy * qy + qz * qz + qw * qw)
        if abs(length - 1) > _LOOSE:
            return self._wrong(node.value[3], f"the last four numbers have length {length:.2f}; expected 1", _FORM)
        if abs(length - 1) > _ROUNDING:
            qx, qy, qz, qw = qx / length, qy / length, qz / length, qw / length
        return Pose(x, y, z, qx, qy, qz, qw)

    def _wrong(self, node: Any, message: str, hint: str) -> None:
        self.findings.append(error("TRN011", message, span_of(node, self._file), hint))
