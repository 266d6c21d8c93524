"""A survey: a scenario's places on a map of the building, and a copy of the scenario with what was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Dict, FrozenSet, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, Severity, counted, error, in_order, usage_error
from pursue_gen.drawing.clearance import Clearance
from pursue_gen.drawing.ground import Ground
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.checks import check_reading
from pursue_gen.language.numbers import Number
from pursue_gen.language.parser import read, without_errors
from pursue_gen.language.rewriting import Movement
from pursue_gen.language.scenario import Connection, Pose, Scenario
from pursue_gen.language.similar import closest
from pursue_gen.outcomes import Invalid
from pursue_gen.survey import findings as found_wrong
from pursue_gen.survey.copying import SURVEY, others_windows, rounded, with_ways, written
from pursue_gen.survey.graph import graph_of
from pursue_gen.survey.grid import Grid, grid_of
from pursue_gen.survey.plan import Pair, Plan
from pursue_gen.survey.routes import Route, Routes
from pursue_gen.survey.spots import Spots, Standing, proposed_spots
from pursue_gen.survey.times import Drive, window
from pursue_gen.workspace.map_check import check_spots
from pursue_gen.workspace.map_spots import Ways, with_poses, with_spots
from pursue_gen.workspace.robot_size import Sizes

MOST_PLACES = 200
"""More places than that take too long and too much memory."""

_STOREY = 0.5
"""Metres in height by which places on different floors differ: this map is of one floor."""

_LONGER = 1.3
"""So much longer than by way of the places a path in the graph is between spots beside them, at most, more or less."""

@dataclass(frozen=True)
class Options:
    """What a survey assumes. `robots`: their sizes; `clearance`: metres between two of them, None: as their
    tolerances need it; `unit`: metres per unit of distance. `ways`: write the ways that are missing, too. `keep`: ways
    whose distances stay (pairs of places).
    """

    robots: Sizes = field(default_factory=Sizes)
    clearance: Optional[float] = None
    unit: float = 1.0
    ways: bool = False
    keep: Tuple[Pair, ...] = ()
    drive: Drive = field(default_factory=Drive)

    @property
    def room(self) -> float:
        """Metres that the centres of two robots keep between them."""
        size = self.robots.largest
        return size.apart if self.clearance is None else 2 * size.radius + self.clearance


@dataclass(frozen=True)
class SurveyedWay:
    """A way of the scenario, or one that is missing there (`given` None).

    `metres`: how long it is on the map, None where that is not known; `written`: its distance in the copy. `kept`: why
    the distance is still the one that was given; "" where it is measured. `crossed`: places that it leads through.
    `windows`: robot, from, to, window in time units; `line`: its bends on the map (metres).
    """

    a: str
    b: str
    given: Optional[Number]
    metres: Optional[float]
    written: Optional[Number]
    kept: str
    crossed: Tuple[str, ...]
    windows: Tuple[Tuple[str, str, str, int, int], ...]
    line: Tuple[Tuple[float, float], ...]


@dataclass(frozen=True)
class Survey:
    """What was found: the `text` of the copy, the findings on the map, the ways, and the spots that were added.

    `errors`: those of the copy, which cannot be solved before they are mended; () where it is right.
    """

    text: str
    findings: Tuple[Diagnostic, ...]
    errors: Tuple[Diagnostic, ...]
    ways: Tuple[SurveyedWay, ...]
    spots: Mapping[str, Mapping[str, Pose]]


def surveyed(scenario: Scenario, ground: Ground, map_name: str, options: Options, copy: str = "") -> Survey:
    """The survey of a scenario (`read_placed`) on the map with this name; `copy`: the file to which it is written.

    A scenario without ways gets those that are missing in any case. Raises PursueError where nothing can be measured.
    """
    _check_robots(scenario, options)
    size = options.robots.largest
    grid = grid_of(ground, size.radius)
    plan = _plan(scenario, grid, options)
    missing = plan.own_ways([(way.a, way.b) for way in scenario.connections])
    new = missing if options.ways or not scenario.connections else []
    with_new = _with_ways(scenario, new, plan, map_name, options)
    kinds = {one: Standing(grid_of(ground, one.needed), grid_of(ground, one.wanted)) for one in options.robots.kinds}
    lines, body = _lines(with_new, plan), 2 * size.radius
    spots = proposed_spots(
        with_new, grid, plan.places, options.room, lines, body, lambda robot: kinds[options.robots.of([robot])]
    )
    poses = {place: {robot: pose for robot, pose in found if pose is not None} for place, found in spots.items()}
    placed = with_poses(replace(scenario, connections=with_new.connections), poses)
    work = _Work(with_new, placed, plan, options, map_name)
    ways = {way: work.way(way, given=(way.a, way.b) not in new) for way in with_new.connections}
    text, errors = _copy(work, ways, spots, copy or f"the copy of {scenario.file}")
    findings = [
        *_found_on_map(placed, scenario, ground, _OnMap(grid, plan, lines), options, 0),
        *found_wrong.without_room(scenario, spots),
        *found_wrong.other_unit(scenario, _compared(scenario, ways), _timed(with_new, ways), options.unit),
    ]
    proposals = [work.proposed(*pair) for pair in missing if pair not in new]
    return Survey(text, in_order(findings), errors, (*ways.values(), *proposals), poses)


def found_on_map(
    scenario: Scenario, ground: Ground, distance: float, sizes: Sizes
) -> Tuple[Tuple[Diagnostic, ...], Ways]:
    """What is wrong on a map with a scenario's places, spots and ways, in order, and the paths of the ways; as far as
    it can be measured.

    `distance`: metres between the robots at one place that have no pose of their own. The pixels of `ground` are known.
    """
    options = Options(sizes)
    grid = grid_of(ground, sizes.largest.radius)
    try:
        plan = _plan(scenario, grid, options)
    except Invalid:  # too few places, or too many
        return check_spots(scenario, ground, distance, sizes), {}
    here = _OnMap(grid, plan, _lines(scenario, plan))
    placed = with_spots(scenario, ground, distance, sizes, here.lines)
    return in_order(_found_on_map(placed, scenario, ground, here, options, distance)), here.lines


@dataclass(frozen=True)
class _OnMap:
    """A scenario on the map: the grid, its places, and the paths of its ways."""

    grid: Grid
    plan: Plan
    lines: Ways


def _found_on_map(
    placed: Scenario, scenario: Scenario, ground: Ground, here: _OnMap, options: Options, distance: float
) -> Iterator[Diagnostic]:
    """What is wrong with places, spots and ways; `placed` has a pose for each robot that shares a place."""
    size, plan = options.robots.largest, here.plan
    yield from found_wrong.apart(scenario, plan, Clearance(ground), size.needed)
    yield from found_wrong.crossing(scenario, plan)
    yield from found_wrong.shut_in_places(placed, here.grid, here.lines, size.radius, options.room)
    spots = scenario if distance else placed  # those that are not written are called so
    yield from check_spots(spots, ground, distance, options.robots, plan.is_joined, here.lines)


def _check_robots(scenario: Scenario, options: Options) -> None:
    """Raises PursueError (exit status 2) for a speed of what is no moving robot, and for a way that there is not."""
    robots = {agent.name: agent for agent in scenario.agents if agent.is_robot}
    for name in options.drive.speeds:
        if name not in robots or robots[name].mobile is None:
            what = "does not move" if name in robots else "is not a robot of the scenario"
            moving = [robot for robot, agent in robots.items() if agent.mobile is not None]
            near = closest(name, tuple(moving))
            hint = f"did you mean {near}?" if near else f"expected one of: {', '.join(moving) or 'none of them moves'}"
            raise usage_error(f"--speed {name}=…: {name} {what}", hint)
    pairs = {frozenset((way.a, way.b)) for way in scenario.connections}
    for pair in options.keep:
        if frozenset(pair) not in pairs:
            hint = "name the two places of a connect, such as --keep desk,shelf"
            raise usage_error(f"--keep {','.join(pair)}: the scenario has no such way", hint)


def _plan(scenario: Scenario, grid: Grid, options: Options) -> Plan:
    """The places on the grid. Raises PursueError where nothing can be measured."""
    posed = [poi for poi in scenario.pois if poi.pose is not None]
    span = scenario.pois[0].span
    if len(posed) < 2:
        message = f"{counted(len(posed), 'place')} of {len(scenario.pois)} with a pose: nothing can be measured"
        hint = 'write a pose behind each place: poi "desk" //[x, y, z, qx, qy, qz, qw], metres on the map'
        raise Invalid([error("MAP001", message, span, hint)])
    if len(posed) > MOST_PLACES:
        message = f"{len(posed)} places; at most {MOST_PLACES} can be surveyed at once"
        raise Invalid([error("MAP001", message, span, "survey the floors of the building one by one")])
    if not grid.free.any():
        message = f"the map has no free ground for a robot with a radius of {options.robots.largest.radius:g} m"
        hint = "look at negate, free_thresh, resolution and the picture's opacity, or try a smaller --radius"
        raise Invalid([error("MAP001", message, span, hint)])
    points = {poi.name: (poi.pose.x, poi.pose.y) for poi in posed if poi.pose is not None}
    return Plan(graph_of(grid), {name: at for name, at in points.items() if grid.is_free(grid.cell(*at))}, options.room)


def _with_ways(scenario: Scenario, new: Sequence[Pair], plan: Plan, map_name: str, options: Options) -> Scenario:
    """The scenario with further ways, in its text as well."""
    if not new:
        return scenario
    lines = []
    for a, b in new:
        route = plan.route(a, b)
        assert route is not None
        distance = rounded(route.length, options.unit, _mobiles(scenario))
        lines.append((a, b, distance, _measured(route.length, map_name, options.unit)))
    reading = read(with_ways(scenario, lines), scenario.file, scenario.name)
    return without_errors(reading.scenario, reading.diagnostics)


def _mobiles(scenario: Scenario) -> List[Number]:
    """Those of the agents whose times are not rounded."""
    return [agent.mobile for agent in scenario.agents if agent.mobile is not None and agent.speed is None]


def _measured(metres: float, map_name: str, unit: float) -> str:
    """The remark on a distance."""
    scale = "" if unit == 1 else f", {unit:g} m per unit"
    return f"{SURVEY}: {metres:.2f} m on {map_name}{scale}"


def _lines(scenario: Scenario, plan: Plan) -> Ways:
    """The paths of the scenario's ways."""
    pairs = [(way.a, way.b) for way in scenario.connections if {way.a, way.b} <= set(plan.places)]
    return {pair: route.bends for pair in pairs for route in [plan.route(*pair)] if route is not None}


@dataclass(frozen=True)
class _Work:
    """A scenario with all its ways, the same one with all its spots, and its places on the map."""

    scenario: Scenario
    placed: Scenario
    plan: Plan
    options: Options
    map_name: str

    def way(self, way: Connection, given: bool) -> SurveyedWay:
        """What was found out about a way; `given`: its distance is the author's."""
        route = self.route(way)
        kept = self._kept(way, route)
        metres = None if route is None else route.length
        distance = way.distance
        if metres is not None and not kept:
            distance = rounded(metres, self.options.unit, _mobiles(self.scenario))
        windows = () if route is None or kept else tuple(self._windows(way))
        crossed = () if route is None else tuple(self.plan.crossed(way.a, way.b))
        line = () if route is None else route.bends
        number = way.distance if given else None
        return SurveyedWay(way.a, way.b, number, metres, distance, kept, crossed, windows, line)

    def proposed(self, a: str, b: str) -> SurveyedWay:
        """A way that is missing."""
        route = self.plan.route(a, b)
        assert route is not None
        distance = rounded(route.length, self.options.unit, _mobiles(self.scenario))
        crossed = tuple(self.plan.crossed(a, b))
        return SurveyedWay(a, b, None, route.length, distance, "", crossed, (), route.bends)

    def route(self, way: Connection) -> Optional[Route]:
        """The path of a way; None where there is none, or one of its places is not on the map."""
        return self.plan.route(way.a, way.b) if {way.a, way.b} <= set(self.plan.places) else None

    def _kept(self, way: Connection, route: Optional[Route]) -> str:
        """Why the distance of a way stays as it is; "": it does not."""
        poses = {poi.name: poi.pose for poi in self.scenario.pois}
        if way.by is not None:
            return "it goes by lift"
        for name in (way.a, way.b):
            if poses[name] is None:
                return f"{name} has no pose"
        a, b = poses[way.a], poses[way.b]
        if a is not None and b is not None and abs(a.z - b.z) > _STOREY:
            return "its places are on different floors"
        for name in (way.a, way.b):
            if name not in self.plan.places:
                return f"{name} is not on free ground"
        if route is None:
            return "the map has no path"
        if frozenset((way.a, way.b)) in map(frozenset, self.options.keep):
            return "--keep"
        for other in self.scenario.connections:
            if {other.a, other.b} == {way.a, way.b} and other.distance != way.distance:
                return "each direction has its own" if way.one_way and other.one_way else "agents have their own"
        return ""

    def _windows(self, way: Connection) -> Iterator[Tuple[str, str, str, int, int]]:
        drive = self.options.drive
        for a, b in way.directions:
            for robot, speed in drive.speeds.items():
                start, end = self._standing.get((robot, a)), self._standing.get((robot, b))
                if not way.admits(robot) or start is None or end is None or (robot, a, b) in self._others:
                    continue
                points = (start.x, start.y), (end.x, end.y)
                if points == (self.plan.places.get(a), self.plan.places.get(b)):
                    route = self.plan.route(a, b)
                else:
                    route = self._between.both(*points)  # which is the same line in both directions
                if route is not None:
                    yield (robot, a, b, *window(route, (start, end), speed, drive))

    @cached_property
    def _others(self) -> FrozenSet[Movement]:
        return others_windows(self.scenario)

    @cached_property
    def _standing(self) -> Dict[Tuple[str, str], Pose]:
        """Where each robot with a speed stands at each place at which it may be."""
        found, present = {}, robots_at(self.placed)
        for poi in self.placed.pois:
            own = {spot.robot.name: spot.pose for spot in poi.spots}
            for robot in present[poi.name]:
                pose = own.get(robot, poi.pose)
                if robot in self.options.drive.speeds and pose is not None:
                    found[robot, poi.name] = pose
        return found

    @cached_property
    def _between(self) -> Routes:
        """The paths of robots that do not stand at the poses of both places."""
        pairs, longest = [], 0.0
        for way in self.scenario.connections:
            straight = self.route(way)
            for robot in filter(way.admits, self.options.drive.speeds):
                poses = [self._standing.get((robot, place)) for place in (way.a, way.b)]
                points = [(pose.x, pose.y) for pose in poses if pose is not None]
                places = [self.plan.places.get(place) for place in (way.a, way.b)]
                if straight is not None and len(points) == 2 and points != places:
                    pairs.append((points[0], points[1]))
                    aside = sum(math.dist(point, place) for point, place in zip(points, places) if place is not None)
                    longest = max(longest, straight.length + aside)
        return self.plan.routes(pairs, _LONGER * longest)


def _compared(scenario: Scenario, ways: Mapping[Connection, SurveyedWay]) -> Dict[Connection, float]:
    """The lengths in metres of the scenario's ways whose distances change."""
    known = {(way.a, way.b): one for way, one in ways.items() if one.written != way.distance}
    found = {way: known[way.a, way.b].metres for way in scenario.connections if (way.a, way.b) in known}
    return {way: metres for way, metres in found.items() if metres is not None}


def _timed(scenario: Scenario, ways: Mapping[Connection, SurveyedWay]) -> Set[Movement]:
    """The movements that have windows in the copy."""
    new = {(robot, a, b) for one in ways.values() for robot, a, b, _, _ in one.windows}
    return new | {(travel.agent.name, *travel.way) for travel in scenario.travels}


def _copy(
    work: _Work, ways: Mapping[Connection, SurveyedWay], spots: Spots, file: str
) -> Tuple[str, Tuple[Diagnostic, ...]]:
    """The text of the copy, and its errors: what cannot be reached on the map, for example."""
    unit, name = work.options.unit, work.map_name
    distances = {
        way: (one.written, _measured(one.metres, name, unit))
        for way, one in ways.items()
        if one.metres is not None and one.written is not None and one.written != way.distance
    }
    speeds = work.options.drive.speeds
    windows = {
        (robot, a, b): (low, high, f"{SURVEY}: at {speeds[robot]:g} m/s on {name}")
        for one in ways.values()
        for robot, a, b, low, high in one.windows
    }
    text = written(work.scenario, distances, windows, spots, name)
    found = check_reading(read(text, file, work.scenario.name))
    return text, tuple(finding for finding in found if finding.severity is Severity.ERROR)
