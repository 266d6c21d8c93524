"""poses.yaml: where the places of a mission are on the robots' map, for each robot.

`poses` has a pose for each place, for every robot that commands of this package are for. `robots` (format 2) has, by
robot and place, those that differ: two robots at one place stand side by side. `spare` (format 3) has, by robot and
place, where this robot alone may stand instead, if its navigation cannot bring it to its pose. `doors` (format 4) has,
by robot and location, the doors of a way, and where the robot waits for them; on a way by lift (format 5) a list: the
lift where it gets in, and then, in the cabin, where it gets out. `levels` (format 6) has the elevation of each level,
where each has a map of its own.
"""

from __future__ import annotations

import math
from typing import Any, Dict, FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError

POSES = "poses.yaml"
LENGTH = 7  # x, y, z in metres, then the orientation qx, qy, qz, qw

Table = Dict[str, List[float]]
"""place → x, y, z, qx, qy, qz, qw."""


class Doorway(NamedTuple):
    """The doors of a way; `wait`: the pose at which a robot waits for them, None: where it sets off. `aboard`: that is
    in the cabin of a lift, which is at `out` on the map of the floor where it gets out; None: at the same pose."""

    doors: FrozenSet[str]
    wait: Optional[List[float]] = None
    aboard: bool = False
    out: Optional[List[float]] = None


Doorways = Dict[str, Tuple[Doorway, ...]]
"""The location in which the robot is on the way → the doors of the way, one after the other."""


class Poses(NamedTuple):
    """The poses of the `places`, and by robot the ones of its `own`, its `spare` ones, and its ways through doors; the
    `levels` of the building with their elevations (metres), where each has a map of its own."""

    places: Table
    own: Dict[str, Table]
    spare: Dict[str, Table]
    doors: Dict[str, Doorways]
    levels: Dict[str, float]

    def of(self, robots: Iterable[str]) -> Dict[str, Table]:
        """Return for each of the robots where it is sent: a pose for each place."""
        return {robot: {**self.places, **self.own.get(robot, {})} for robot in robots}


def read_poses(data: Mapping[str, Any]) -> Poses:
    """Read the content of poses.yaml. Raises DataError."""
    places = data.get("poses")
    if not isinstance(places, dict):
        raise DataError("poses.yaml: expected poses: and a line for each place")
    where = _table(places, "")
    own, spare = (_of_robots(data, key, where) for key in ("robots", "spare"))
    return Poses(where, own, spare, _doorways(data), _levels(data.get("levels", {})))


def _levels(given: Any) -> Dict[str, float]:
    known = isinstance(given, dict) and all(isinstance(z, (int, float)) and math.isfinite(z) for z in given.values())
    if not known:
        raise DataError("poses.yaml: expected levels: and the elevation of each, in metres")
    return {str(name): float(z) for name, z in given.items()}


def _doorways(data: Mapping[str, Any]) -> Dict[str, Doorways]:
    robots = data.get("doors", {})
    found: Dict[str, Doorways] = {}
    if not isinstance(robots, dict) or not all(isinstance(ways, dict) for ways in robots.values()):
        raise DataError("poses.yaml: expected doors: and a table for each robot")
    for robot, ways in robots.items():
        for location, way in ways.items():
            some = way if isinstance(way, list) and way else [way]
            found.setdefault(str(robot), {})[str(location)] = tuple(_doorway(robot, location, one) for one in some)
    return found


def _doorway(robot: object, location: object, way: Any) -> Doorway:
    names = way.get("doors") if isinstance(way, dict) else None
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        what = f"poses.yaml: the doors of {robot} on {location}"
        raise DataError(f"{what}: expected {{doors: [name], wait: [x, y, z, qx, qy, qz, qw]}}, got {way!r}")
    where = f"where {robot} waits on {location}"
    wait, out = (None if way.get(key) is None else _pose(way[key], where) for key in ("wait", "out"))
    return Doorway(frozenset(names), wait, way.get("aboard") is True, out)


def _of_robots(data: Mapping[str, Any], key: str, places: Table) -> Dict[str, Table]:
    robots, own = data.get(key, {}), {}
    if not isinstance(robots, dict):
        raise DataError(f"poses.yaml: expected {key}: and a table for each robot")
    for robot, table in robots.items():
        if not isinstance(table, dict):
            raise DataError(f"poses.yaml: expected a line for each place of {robot}'s own, got {table!r}")
        own[str(robot)] = _table(table, f" for {robot}")
        unknown = sorted(set(own[str(robot)]) - set(places))
        if unknown:
            raise DataError(f"poses.yaml: {robot} has a pose at {unknown[0]}, which is not a place under poses:")
    return own


def _table(given: Mapping[Any, Any], whose: str) -> Table:
    return {str(place): _pose(pose, f"the pose of {place}{whose}") for place, pose in given.items()}


def _pose(given: Any, what: str) -> List[float]:
    try:
        numbers = [float(number) for number in given]  # YAML takes 1e3 for a text
    except (TypeError, ValueError, OverflowError):
        numbers = []
    if len(numbers) != LENGTH or not all(math.isfinite(number) for number in numbers):
        raise DataError(f"poses.yaml: {what} is {given!r}; expected seven numbers x, y, z, qx, qy, qz, qw")
    return numbers
