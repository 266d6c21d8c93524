"""Where each robot stands at each place: at its own pose if the scenario has one, else beside the place's pose."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass, replace
from functools import partial
from itertools import compress, count, islice
from typing import Callable, DefaultDict, Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, counted, warning
from pursue_gen.drawing.layout import poses, yaw_of
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Poi, Pose, Scenario
from pursue_runtime.controller.whereabouts import STOREY

SPOT_DISTANCE = 0.8
"""Metres between the robots at one place, by default: room for two robots of the size of a Turtlebot."""

_DECIMALS = 3
_ROUNDING = 0.002  # metres by which two rounded spots may be nearer
_RINGS, _ANGLES = 4, 12  # around a place that are tried on a map, and directions on the first of them
_ROOM = 4  # spots that are tried for each robot until it may be near another place

Point = Tuple[float, float]
Table = Mapping[str, Pose]
"""place → pose."""
Fit = Callable[[Pose, Sequence[str], Pose], int]
"""How well, beside the pose of a place, robots stand at a spot: from 0 (not at all) to `BEST`."""
BEST = 4


@dataclass(frozen=True)
class Placing:
    """Where robots are sent: `places` has the places' poses, `spots` a table for each robot.

    `computed`: some of the places' poses are, from distances. `distance`: metres between the robots at one place.
    """

    places: Table
    spots: Mapping[str, Table]
    computed: bool
    distance: float


def placing(scenario: Scenario, distance: float, fit: Optional[Fit] = None) -> Placing:
    """The poses of a scenario, computed ones for places without, and the robots' spots."""
    places, computed = poses(scenario)
    return Placing(places, spots(scenario, places, distance, fit), computed, distance)


def spots(scenario: Scenario, places: Table, distance: float, fit: Optional[Fit] = None) -> Dict[str, Dict[str, Pose]]:
    """robot → place → the pose to which the robot is sent there; `places` has the places' own poses.

    A pose that the scenario gives for a robot stays as it is. Of the other robots that may be at a place, the first has
    the place's pose, and so has each that is never there together with one that has it. The rest stand beside it, left
    and right in turn, `distance` metres from each other and, where there is room, from the poses of other places. All
    look in the same direction. Positions are rounded to millimetres. With distance 0 all have the place's pose.

    `fit`: how well robots stand at a spot beside a pose that a person has given. Those that fit best come first, then
    those nearer to the place, and beside it before any other direction; where nothing fits all is as without.
    """
    own = {poi.name: {spot.robot.name: spot.pose for spot in poi.spots} for poi in scenario.pois}
    found = {
        agent.name: {place: own[place].get(agent.name, pose) for place, pose in places.items()}
        for agent in scenario.agents
        if agent.is_robot
    }
    if distance <= 0:
        return found
    present = robots_at(scenario)
    given = {poi.name: [places[poi.name], *own[poi.name].values()] for poi in scenario.pois}
    everywhere = _Taken(distance, (pose for those in given.values() for pose in those))
    for poi in scenario.pois:
        groups = _groups(scenario, poi, present[poi.name])[1:]
        here = _Taken(distance, given[poi.name])
        free = _beside(places[poi.name], distance, here, everywhere, _ROOM * len(groups))
        used: List[Point] = []
        for robots in groups:
            some = free
            if fit is not None and poi.pose is not None:
                some = _fitting(poi.pose, distance, partial(fit, poi.pose, robots), everywhere, free, used)
            spot = next(some)
            found.update({robot: {**found[robot], poi.name: spot} for robot in robots})
            everywhere.add(spot)
    return found


def moved(scenario: Scenario, distance: float, fit: Optional[Fit] = None) -> List[str]:
    """A sentence for each place whose pose a person has given and some robots are sent beside: which, and how far."""
    found, present = [], robots_at(scenario)
    where = placing(scenario, distance, fit)
    for poi in scenario.pois:
        groups = _groups(scenario, poi, present[poi.name])
        if poi.pose is None or len(groups) < 2 or distance <= 0:
            continue
        away = []
        for robot in (robot for robots in groups[1:] for robot in robots):
            spot = where.spots[robot][poi.name]
            away.append(f"{robot} {round(math.dist((spot.x, spot.y), (poi.pose.x, poi.pose.y)), _DECIMALS):g} m")
        first = " and ".join(groups[0])
        found.append(f"at {poi.name} {first} has the pose of the place; beside it: {', '.join(away)} (--spot-distance)")
    return found


def spots_in_one(scenario: Scenario, distance: float) -> Tuple[Diagnostic, ...]:
    """A warning for the first place at which several robots have one pose, because their distance is 0."""
    present = robots_at(scenario)
    shared = [(poi, [robots[0] for robots in _groups(scenario, poi, present[poi.name])]) for poi in scenario.pois]
    crowded = [(poi, robots) for poi, robots in shared if len(robots) > 1]
    if distance > 0 or not crowded:
        return ()
    poi, robots = crowded[0]
    more = f" ({counted(len(crowded) - 1, 'more place')} like this)" if len(crowded) > 1 else ""
    message = f"{' and '.join(robots)} have one pose at {poi.name}: real robots would run into each other{more}"
    hint = f"leave --spot-distance 0 out, or give each its own: {poi.name} //[…] {robots[1]} [x, y, z, qx, qy, qz, qw]"
    return (warning("WSP007", message, poi.span, hint),)


def _groups(scenario: Scenario, poi: Poi, present: Sequence[str]) -> List[List[str]]:
    """The robots without a pose of their own at the place, those together that may have one: no two of them are ever
    there at one time. Only objectives that have to be met (`never_with`, `holds`) are relied on: a new plan keeps them
    too.
    """
    kept = [one for one in scenario.safety if not one.optional]
    groups: List[List[str]] = []
    for robot in _without_own(poi, present):
        for group in groups:
            if all(any(one.apart(robot, other, poi.name) for one in kept) for other in group):
                group.append(robot)
                break
        else:
            groups.append([robot])
    return groups


def _without_own(poi: Poi, robots: Sequence[str]) -> List[str]:
    """Those of the robots that have no pose of their own at the place."""
    own = {spot.robot.name for spot in poi.spots}
    return [robot for robot in robots if robot not in own]


class _Taken:
    """Points from which others on the same floor have to be `distance` metres away."""

    def __init__(self, distance: float, poses: Iterable[Pose]) -> None:
        self._distance = distance
        self._cells: DefaultDict[Tuple[int, int], List[Pose]] = defaultdict(list)
        for pose in poses:
            self.add(pose)

    def add(self, pose: Pose) -> None:
        """Take the point of a pose."""
        self._cells[self._cell(pose)].append(pose)

    def near(self, pose: Pose) -> bool:
        """Return True if a point is too near to the pose."""
        i, j = self._cell(pose)
        around = (other for x in (i - 1, i, i + 1) for y in (j - 1, j, j + 1) for other in self._cells.get((x, y), ()))
        here = ((other.x, other.y) for other in around if abs(other.z - pose.z) <= STOREY)
        return any(math.dist(point, (pose.x, pose.y)) < self._distance - _ROUNDING for point in here)

    def _cell(self, pose: Pose) -> Tuple[int, int]:
        return math.floor(pose.x / self._distance), math.floor(pose.y / self._distance)


def _beside(pose: Pose, distance: float, here: _Taken, everywhere: _Taken, most: int) -> Iterator[Pose]:
    """Spots beside a pose: those of the nearest `most` that are free, then those that are free as far as this place
    goes. They are `distance` apart from each other."""
    line = _line(pose, distance)
    nearest = list(islice(line, most))
    room = [not everywhere.near(spot) for spot in nearest]
    yield from compress(nearest, room)
    yield from (spot for spot, is_free in zip(nearest, room) if not is_free and not here.near(spot))
    yield from (spot for spot in line if not here.near(spot))


def _fitting(
    pose: Pose,
    distance: float,
    fit: Callable[[Pose], int],
    everywhere: _Taken,
    others: Iterator[Pose],
    used: List[Point],
) -> Iterator[Pose]:
    """The spots around a pose that fit, the best ones first, as far as they are free; then the others. `used`: those
    that fitted and were taken."""
    around = [(fit(spot), spot) for spot in _rings(pose, distance)]
    for wanted in range(BEST, 0, -1):
        for level, spot in around:
            if level == wanted and not everywhere.near(spot):
                used.append((spot.x, spot.y))
                yield spot
    for spot in others:
        if all(math.dist(one, (spot.x, spot.y)) >= distance - _ROUNDING for one in used):
            yield spot


def _rings(pose: Pose, distance: float) -> Iterator[Pose]:
    """The points of some rings around a pose, the nearest first, and of each ring those beside it first."""
    for ring in range(1, _RINGS + 1):
        angles = [math.tau * k / (_ANGLES * ring) for k in range(_ANGLES * ring)]
        for angle in sorted(angles, key=lambda one: (round(abs(math.cos(one)), 9), math.sin(one) < 0)):
            yield _at(pose, ring * distance, angle)


def _line(pose: Pose, distance: float) -> Iterator[Pose]:
    """The points on both sides of a pose, the nearest first, the left one before the right one."""
    for steps in count(1):
        for offset in (steps * distance, -steps * distance):
            yield _at(pose, offset, math.pi / 2)


def _at(pose: Pose, distance: float, angle: float) -> Pose:
    """The point so far from a pose, in a direction seen from its own (radians)."""
    direction = yaw_of(pose) + angle
    x, y = pose.x + distance * math.cos(direction), pose.y + distance * math.sin(direction)
    return replace(pose, x=_rounded(x), y=_rounded(y))


def _rounded(metres: float) -> float:
    return round(metres, _DECIMALS) + 0.0  # + 0.0: no -0.0 in generated files
