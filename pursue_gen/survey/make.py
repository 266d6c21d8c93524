"""A survey: a scenario's places on a map of the building, and a copy of the scenario with what was measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Dict, FrozenSet, Iterator, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, Severity, counted, error, in_order, usage_error
from pursue_gen.drawing.ground import Clearance
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
from pursue_gen.survey.routes import Drive, Route, Routes, window
from pursue_gen.survey.spots import Spots, Standing, proposed_spots
from pursue_gen.workspace.levels import Level, check_levels, on_level
from pursue_gen.workspace.map_check import check_spots
from pursue_gen.workspace.map_spots import with_poses, with_spots
from pursue_gen.workspace.robot_size import Sizes
from pursue_runtime.controller.whereabouts import STOREY

MOST_PLACES = 200
"""More places than that take too long and too much memory."""

BY_LIFT = "it goes by lift"  # why the distance of a way is never measured
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


def surveyed(scenario: Scenario, levels: Sequence[Level], options: Options, copy: str = "") -> Survey:
    """The survey of a scenario (`read_placed`) on the maps of its levels; `copy`: the file to which it is written.

    A scenario without ways gets those that are missing in any case. Raises PursueError where nothing can be measured.
    """
    _check_robots(scenario, options)
    _check_places(scenario)
    tuple(check_levels(scenario, levels))  # before what takes long
    floors = [_floor(scenario, level, options) for level in levels]
    known = [(way.a, way.b) for way in scenario.connections]
    missing = {pair: floor for floor in floors for pair in floor.plan.own_ways(known)}
    new = missing if options.ways or not scenario.connections else {}
    with_new = _with_ways(scenario, new, options)
    floors = [floor.with_ways(with_new) for floor in floors]
    spots: Spots = {}
    for floor in floors:
        spots.update(_spots(on_level(with_new, floor.level), floor, options))
    poses = {place: {robot: pose for robot, pose in found if pose is not None} for place, found in spots.items()}
    placed = with_poses(replace(scenario, connections=with_new.connections), poses)
    works = [_Work(with_new, placed, floor, options) for floor in floors]
    ways = {way: _work(way, works).way(way, given=(way.a, way.b) not in new) for way in with_new.connections}
    text, errors = _copy(works, ways, spots, copy or f"the copy of {scenario.file}")
    findings = [
        *_found_on_map(placed, scenario, floors, options, 0),
        *found_wrong.without_room(scenario, spots),
        *found_wrong.other_unit(scenario, _compared(scenario, ways), _timed(with_new, ways), options.unit),
    ]
    proposals = [floor.proposed(*pair, scenario, options) for pair, floor in missing.items() if pair not in new]
    return Survey(text, in_order(findings), errors, (*ways.values(), *proposals), poses)


def found_on_map(
    scenario: Scenario, levels: Sequence[Level], distance: float, sizes: Sizes
) -> Tuple[Tuple[Diagnostic, ...], Tuple[Level, ...]]:
    """What is wrong on the maps with a scenario's places, spots and ways, in order, as far as it can be measured, and
    the levels with the paths of the ways.

    `distance`: metres between the robots at one place that have no pose of their own. All pixels of the maps are known.
    """
    options = Options(sizes)
    try:
        _check_places(scenario)
        floors = [_floor(scenario, level, options).with_ways(scenario) for level in levels]
    except Invalid:  # too few places, or too many
        return check_spots(scenario, levels, distance, sizes), tuple(levels)
    known = tuple(floor.level for floor in floors)
    placed = with_spots(scenario, known, distance, sizes)
    return in_order(_found_on_map(placed, scenario, floors, options, distance)), known


@dataclass(frozen=True)
class _Floor:
    """A level, its grid, and the places on it."""

    level: Level
    grid: Grid
    plan: Plan

    def with_ways(self, scenario: Scenario) -> _Floor:
        """The same, whose level has the paths of the scenario's ways."""
        routes = {(way.a, way.b): self.plan.route(way.a, way.b) for way in scenario.connections}
        lines = {pair: route.bends for pair, route in routes.items() if route is not None}
        return replace(self, level=replace(self.level, ways=lines))

    def proposed(self, a: str, b: str, scenario: Scenario, options: Options) -> SurveyedWay:
        """A way that is missing."""
        route = self.plan.route(a, b)
        assert route is not None
        distance = rounded(route.length, options.unit, scenario)
        return SurveyedWay(a, b, None, route.length, distance, "", tuple(self.plan.crossed(a, b)), (), route.bends)


def _spots(part: Scenario, floor: _Floor, options: Options) -> Spots:
    """The spots that are proposed on a level; `part` has no other places' poses."""
    ground, size = floor.level.ground, options.robots.largest
    kinds = {one: Standing(grid_of(ground, one.needed), grid_of(ground, one.wanted)) for one in options.robots.kinds}
    given = part, floor.grid, floor.plan.places, options.room, floor.level.ways, 2 * size.radius
    return proposed_spots(*given, lambda robot: kinds[options.robots.of([robot])])


def _found_on_map(
    placed: Scenario, scenario: Scenario, floors: Sequence[_Floor], options: Options, distance: float
) -> Iterator[Diagnostic]:
    """What is wrong with places, spots and ways; `placed` has a pose for each robot that shares a place."""
    size = options.robots.largest
    for floor in floors:
        level, part = floor.level, on_level(placed, floor.level)
        yield from found_wrong.empty(scenario, level)
        yield from found_wrong.apart(scenario, floor.plan, Clearance(level.ground), size.needed)
        yield from found_wrong.crossing(scenario, floor.plan)
        yield from found_wrong.shut_in_places(part, floor.grid, level.ways, size.radius, options.room)
    spots = scenario if distance else placed  # those that are not written are called so
    joined = {floor.level.name: floor.plan.is_joined for floor in floors}
    yield from check_spots(spots, [floor.level for floor in floors], distance, options.robots, joined)


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


def _check_places(scenario: Scenario) -> None:
    """Raises PursueError where fewer than two places have a pose."""
    posed = sum(poi.pose is not None for poi in scenario.pois)
    if posed < 2:
        message = f"{counted(posed, 'place')} of {len(scenario.pois)} with a pose: nothing can be measured"
        hint = 'write a pose behind each place: poi "desk" //[x, y, z, qx, qy, qz, qw], metres on the map'
        raise Invalid([error("MAP001", message, scenario.pois[0].span, hint)])


def _floor(scenario: Scenario, level: Level, options: Options) -> _Floor:
    """The places of a level on its grid. Raises PursueError where nothing can be measured."""
    grid, span = grid_of(level.ground, options.robots.largest.radius), scenario.pois[0].span
    points = {poi.name: (poi.pose.x, poi.pose.y) for poi in scenario.pois if poi.pose and level.has(poi.pose)}
    if len(points) > MOST_PLACES:
        message = f"{len(points)} places; at most {MOST_PLACES} can be surveyed on one map"
        raise Invalid([error("MAP001", message, span, "give each floor a map of its own, or survey parts of this one")])
    if not grid.free.any():
        message = f"{level.map_name} has no free ground for a robot with a radius of "
        message += f"{options.robots.largest.radius:g} m"
        hint = "look at negate, free_thresh, resolution and the picture's opacity, or try a smaller --radius"
        raise Invalid([error("MAP001", message, span, hint)])
    places = {name: at for name, at in points.items() if grid.is_free(grid.cell(*at))}
    return _Floor(level, grid, Plan(graph_of(grid), places, options.room))


def _with_ways(scenario: Scenario, new: Mapping[Pair, _Floor], options: Options) -> Scenario:
    """The scenario with further ways, in its text as well."""
    if not new:
        return scenario
    lines = []
    for (a, b), floor in new.items():
        way = floor.proposed(a, b, scenario, options)
        assert way.metres is not None and way.written is not None
        lines.append((a, b, way.written, _measured(way.metres, floor.level, options.unit)))
    reading = read(with_ways(scenario, lines), scenario.file, scenario.name)
    return without_errors(reading.scenario, reading.diagnostics)


def _measured(metres: float, level: Level, unit: float) -> str:
    """The remark on a distance."""
    scale = "" if unit == 1 else f", {unit:g} m per unit"
    return f"{SURVEY}: {metres:.2f} m on {level.map_name}{scale}"


@dataclass(frozen=True)
class _Work:
    """A scenario with all its ways, the same one with all its spots, and a level with its places on the map."""

    scenario: Scenario
    placed: Scenario
    floor: _Floor
    options: Options

    @property
    def plan(self) -> Plan:
        """The places of the level."""
        return self.floor.plan

    def way(self, way: Connection, given: bool) -> SurveyedWay:
        """What was found out about a way; `given`: its distance is the author's."""
        route, number = self.plan.route(way.a, way.b), way.distance if given else None
        kept = self._kept(way, route)
        if route is None:
            return SurveyedWay(way.a, way.b, number, None, way.distance, kept, (), (), ())
        distance = way.distance if kept else rounded(route.length, self.options.unit, self.scenario)
        crossed, windows = tuple(self.plan.crossed(way.a, way.b)), () if kept else tuple(self._windows(way))
        return SurveyedWay(way.a, way.b, number, route.length, distance, kept, crossed, windows, route.bends)

    def _kept(self, way: Connection, route: Optional[Route]) -> str:
        """Why the distance of a way stays as it is; "": it does not."""
        poses = {poi.name: poi.pose for poi in self.scenario.pois}
        if way.by is not None:
            return BY_LIFT
        for name in (way.a, way.b):
            if poses[name] is None:
                return f"{name} has no pose"
        a, b = poses[way.a], poses[way.b]
        if a is not None and b is not None and abs(a.z - b.z) > STOREY:
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
            straight = self.plan.route(way.a, way.b)
            for robot in filter(way.admits, self.options.drive.speeds):
                poses = [self._standing.get((robot, place)) for place in (way.a, way.b)]
                points = [(pose.x, pose.y) for pose in poses if pose is not None]
                places = [self.plan.places.get(place) for place in (way.a, way.b)]
                if straight is not None and len(points) == 2 and points != places:
                    pairs.append((points[0], points[1]))
                    aside = sum(math.dist(point, place) for point, place in zip(points, places) if place is not None)
                    longest = max(longest, straight.length + aside)
        return self.plan.routes(pairs, _LONGER * longest)


def _work(way: Connection, works: Sequence[_Work]) -> _Work:
    """That of the level on which a way begins."""
    pose = next(poi.pose for poi in works[0].scenario.pois if poi.name == way.a)
    return next((work for work in works if work.floor.level.has(pose)), works[0])


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
    works: Sequence[_Work], ways: Mapping[Connection, SurveyedWay], spots: Spots, file: str
) -> Tuple[str, Tuple[Diagnostic, ...]]:
    """The text of the copy, and its errors: what cannot be reached on the map, for example."""
    options, scenario = works[0].options, works[0].scenario
    levels = {way: _work(way, works).floor.level for way in ways}
    distances = {
        way: (one.written, _measured(one.metres, levels[way], options.unit))
        for way, one in ways.items()
        if one.metres is not None and one.written is not None and one.written != way.distance
    }
    speeds = options.drive.speeds
    windows = {
        (robot, a, b): (low, high, f"{SURVEY}: at {speeds[robot]:g} m/s on {levels[way].map_name}")
        for way, one in ways.items()
        for robot, a, b, low, high in one.windows
    }
    maps = {place: work.floor.level.map_name for work in works for place in work.plan.places}
    text = written(scenario, distances, windows, spots, maps)
    found = check_reading(read(text, file, scenario.name))
    return text, tuple(finding for finding in found if finding.severity is Severity.ERROR)
