"""Spots against a map of the building: is there room where robots are sent, and if not, where nearby is there some?"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Callable, Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, warning
from pursue_gen.drawing.ground import FREE, OCCUPIED, OUTSIDE, UNKNOWN, Clearance, Ground, Point, to_line
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read, without_errors
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.workspace.levels import Level, Ways, check_levels
from pursue_gen.workspace.map_spots import NEAR, fit_on, is_seen, room_on
from pursue_gen.workspace.robot_size import ALIKE, RobotSize, Sizes
from pursue_gen.workspace.spots import Fit, placing

_FAR = 5.0
"""Metres around a point in which any room is looked for."""

_CORRECT = "poses are metres, from the origin that the map's yaml file gives for its lower left corner"
_SMALLER = "if the robots are smaller, say so: agent … radius METRES, or --robot PARAMETERS.yaml"
_TOUCH = 1e-9
"""Metres by which a distance counts as equal; numbers are as exact."""

_OF_WAYS = frozenset(("PML153", "PML154", "PML201", "PML230"))
"""Errors that a scenario has because ways are missing."""

_SAYS = {OUTSIDE: "is off the map", OCCUPIED: "is in an obstacle of the map", UNKNOWN: "is unknown to the map"}
"""What a message says on ground that is not free."""


def read_placed(text: str, file: str) -> Scenario:
    """A scenario whose places can be looked at on a map: without errors, but some ways may be missing. Raises
    PursueError."""
    reading = read(text, file)
    return without_errors(reading.scenario, but_for_ways(check_reading(reading)))


def but_for_ways(findings: Sequence[Diagnostic]) -> Tuple[Diagnostic, ...]:
    """The findings, without those that a scenario has because ways are missing."""
    return tuple(finding for finding in findings if finding.code not in _OF_WAYS)


def check_spots(
    scenario: Scenario,
    levels: Sequence[Level],
    distance: float,
    sizes: Sizes = ALIKE,
    may_be: Mapping[str, Callable[[Point], bool]] = MappingProxyType({}),
) -> Tuple[Diagnostic, ...]:
    """A warning for each place or spot that is not on free ground, has too little room for a robot, or is too near
    another one, with the nearest point at which there is room; places without a pose are left out.

    Each is measured against the largest of the robots that are sent there.

    `distance`: metres between the robots at one place; those without a pose of their own stand where there is room.
    `may_be`: level → whether a point of it (metres) may be proposed. Spots on the way of others are warned about where
    the paths of ways are known. Raises PursueError for places that are on no level.
    """
    found = list(check_levels(scenario, levels))
    everywhere = tuple(_points(scenario, distance, fit_on(levels, sizes)))
    present = robots_at(scenario)
    for level in levels:
        points = tuple(point for point in everywhere if level.has(point.pose))
        anywhere = may_be.get(level.name, lambda point: True)
        look = _Look(level.ground, Clearance(level.ground), sizes, points, anywhere, level.ways)
        for number, point in enumerate(points):
            finding = look.on_ground(point) or look.room(point)
            found += [finding] if finding else []
            found += look.neighbour(point, points[:number])
            found += look.on_a_way(point, present)
    return tuple(found)


@dataclass(frozen=True)
class _Point:
    """Where robots are sent: what it is in words, who is sent there (nobody: a place that no robot gets to), and whose
    spot has to be written to change it; "": the pose stands there. `is_spot`: of one robot, not the pose of a place."""

    what: str
    pose: Pose
    span: Span
    place: str
    robots: FrozenSet[str] = frozenset()
    unwritten: str = ""
    is_spot: bool = True

    def __str__(self) -> str:
        return f"{self.what} ({self.pose.x:g}, {self.pose.y:g})"

    def apart(self, x: float, y: float) -> float:
        return math.dist((self.pose.x, self.pose.y), (x, y))

    def meets(self, other: _Point) -> bool:
        """Return True if two robots may stand there, one at each."""
        return not (self.robots and other.robots) or len(self.robots | other.robots) > 1


@dataclass(frozen=True)
class _Look:
    """The points of a scenario on the ground; `proposed`: where some of them should be instead."""

    ground: Ground
    clearance: Clearance
    sizes: Sizes
    points: Tuple[_Point, ...]
    may_be: Callable[[Point], bool]
    ways: Ways
    proposed: Dict[_Point, Point] = field(default_factory=dict)

    def size(self, point: _Point) -> RobotSize:
        """That of the largest robot that is sent to a point."""
        return self.sizes.of(point.robots)

    def on_ground(self, point: _Point) -> Optional[Diagnostic]:
        """A point that is not on free ground."""
        kind = self.ground.at(point.pose.x, point.pose.y)
        if kind == FREE:
            return None
        more = _extent(self.ground) if kind == OUTSIDE else _CORRECT
        return warning("WSP008", f"{point} {_SAYS[kind]}", point.span, f"{self.remedy(point)}; {more}")

    def room(self, point: _Point) -> Optional[Diagnostic]:
        """A point that is too near an obstacle."""
        robot = self.size(point)
        metres = self.clearance.metres(point.pose.x, point.pose.y, robot.wanted + 1)
        if metres > robot.wanted + _TOUCH:
            return None
        if metres > robot.needed + _TOUCH:
            better = self._better(point, robot.wanted, NEAR, beyond_walls=False)
            if better is None:
                return None  # there is no better one
            message = f"{point} is {metres:.2f} m from an obstacle: a robot that stops there reaches into what is "
            message += f"inflated, where TrajectoryPlannerROS may move to and fro; more than {robot.wanted:.10g} m, "
            message += f"its radius of {robot.radius:g} m, its goal tolerance of {robot.tolerance:g} m and its "
            message += f"inflation radius of {robot.inflation:g} m, are enough for any planner"
            return warning("MAP003", message, point.span, self._move(point, better))
        if metres > robot.radius + _TOUCH:
            message = f"{point} is {metres:.2f} m from an obstacle: to stop and turn there a robot needs more than "
            message += f"{robot.needed:g} m, its radius of {robot.radius:g} m and its goal tolerance of "
            message += f"{robot.tolerance:g} m"
        else:
            message = f"{point} is nearer than {robot.radius:g} m, the robots' radius, to an obstacle"
        return warning("MAP003", message, point.span, f"{self.remedy(point)}; {_SMALLER}")

    def neighbour(self, point: _Point, others: Sequence[_Point]) -> List[Diagnostic]:
        """The nearest of other points, where two robots cannot stand there and here."""
        x, y, size = point.pose.x, point.pose.y, self.size(point)
        close = [one for one in others if point.meets(one) and one.apart(x, y) < self._room(point, one) - _TOUCH]
        other = min(close, key=lambda one: one.apart(x, y), default=None)
        if other is None:
            return []
        room, radii = self._room(point, other), f"a radius of {size.radius:g} m"
        tolerances = f"a goal tolerance of {size.tolerance:g} m"
        if self.size(other) != size:
            radii = f"{radii} and of {self.size(other).radius:g} m"
            tolerances = f"{tolerances} and of {self.size(other).tolerance:g} m"
        message = f"{point} is {other.apart(x, y):.2f} m from {other.what}: two robots with {radii} and {tolerances} "
        message += f"need {room:g} m"
        hint = f"{self.remedy(point)}; or keep robots from being at both at once (objective: avoid …); {_SMALLER}"
        return [warning("MAP005", message, point.span, hint)]

    def on_a_way(self, point: _Point, present: Mapping[str, Sequence[str]]) -> List[Diagnostic]:
        """The nearest way of other robots that a robot's spot is on; ways through places are told of the ways."""
        if not point.is_spot:
            return []
        here = point.pose.x, point.pose.y
        near = []
        for (a, b), line in self.ways.items():
            metres, room = to_line(line, here)[0], self._room_on((a, b), line, point)
            if metres < room - _TOUCH and set(present[a]) & set(present[b]) - point.robots:
                near.append((metres, a, b, room))
        if not near:
            return []
        metres, a, b, room = min(near)
        message = f"{point} is {metres:.2f} m from the way from {a} to {b}: who stands there is in the way of others, "
        message += f"who need {room:g} m"
        return [warning("MAP006", message, point.span, f"{self.remedy(point)}; {_SMALLER}")]

    def _room_on(self, ends: Tuple[str, str], line: Sequence[Point], point: _Point) -> float:
        """How far from a way a robot at a point has to stand; a place itself is where its ways end."""
        size = self.sizes.largest
        if point.place not in ends:
            return size.apart
        return room_on(line, line[0] if ends[0] == point.place else line[-1], size) if point.is_spot else 0.0

    def _room(self, point: _Point, other: _Point) -> float:
        """How far apart robots at two points have to be."""
        return self.size(point).needed + self.size(other).needed

    def remedy(self, point: _Point) -> str:
        """What to do about a point where there is too little room."""
        size = self.size(point)
        better = self._better(point, size.wanted, NEAR)
        if better is None:
            better = self._better(point, size.needed, _FAR)
            wanted = better and self._better(point, size.wanted, NEAR, beyond_walls=False, start=better)
            better = wanted or better
        if better is None:
            return f"move it: near it, beside all others, there is no room for a robot that needs {size.needed:g} m"
        return self._move(point, better)

    def _better(
        self, point: _Point, radius: float, reach: float, beyond_walls: bool = True, start: Optional[Point] = None
    ) -> Optional[Point]:
        """The nearest point that is farther from obstacles than a radius, far enough from where all others should be;
        if there is such a one, not on the way of others and not beyond a wall, or else none where it must not be there.
        `start`: from where, if not from the point itself.
        """
        if point in self.proposed:
            return self.proposed[point]
        x, y = start or (point.pose.x, point.pose.y)
        rooms = [(line, self._room_on(ends, line, point)) for ends, line in self.ways.items()]

        def is_apart(at: Point) -> bool:
            others = ((one, self.proposed.get(one, (one.pose.x, one.pose.y))) for one in self.points if one != point)
            return self.may_be(at) and all(math.dist(at, there) >= self._room(point, one) for one, there in others)

        def is_here(at: Point) -> bool:
            aside = all(to_line(line, at)[0] >= room for line, room in rooms)
            return aside and is_apart(at) and is_seen(self.ground, (x, y), at)

        here = self.clearance.nearest(x, y, radius, reach, is_here) if self.ground.at(x, y) == FREE else None
        return here or (self.clearance.nearest(x, y, radius, reach, is_apart) if beyond_walls else None)

    def _move(self, point: _Point, to: Point) -> str:
        self.proposed[point] = to
        x, y = (round(number, 3) + 0.0 for number in to)
        where = f"there is room at {x:.10g}, {y:.10g}, {point.apart(x, y):.2f} m from there"
        if not point.unwritten:
            return where
        one = replace(point.pose, x=x, y=y)
        numbers = ", ".join(f"{n:.10g}" for n in (one.x, one.y, one.z, one.qx, one.qy, one.qz, one.qw))
        return f"{where}: write a pose for it behind that of {point.place}: {point.unwritten} [{numbers}]"


def _extent(ground: Ground) -> str:
    """How far the map reaches."""
    ends = [ground.middle(i - 0.5, j - 0.5) for i in (0, ground.width) for j in (0, ground.height)]
    (left, right), (low, high) = ((min(one), max(one)) for one in zip(*ends))
    return f"the map reaches from {left:.1f} to {right:.1f} in x and from {low:.1f} to {high:.1f} in y"


def _points(scenario: Scenario, distance: float, fit: Fit) -> Iterator[_Point]:
    """The poses of the places, and the spots of the robots that may be there where they are other points."""
    where, present = placing(scenario, distance, fit), robots_at(scenario)
    for poi in scenario.pois:
        own = {spot.robot.name: spot.robot.span for spot in poi.spots}
        spots = {robot: where.spots[robot][poi.name] for robot in present[poi.name]}
        if poi.pose is not None and (not spots or set(spots) - set(own)):
            robots = frozenset(robot for robot, spot in spots.items() if spot == poi.pose)
            yield _Point(f"the pose of {poi.name}", poi.pose, poi.span, poi.name, robots, is_spot=False)
        for robot, spot in spots.items():
            what = f"the spot of {robot} at {poi.name}"
            if robot in own:
                yield _Point(what, spot, own[robot], poi.name, frozenset((robot,)))
            elif poi.pose is not None and spot != poi.pose:
                yield _Point(what, spot, poi.span, poi.name, frozenset((robot,)), robot)
