"""What a survey finds wrong, in words."""

from __future__ import annotations

import math
from typing import AbstractSet, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, listed, warning
from pursue_gen.drawing.ground import Clearance
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.rewriting import Movement
from pursue_gen.language.scenario import Connection, Pose, Scenario
from pursue_gen.survey.grid import Grid
from pursue_gen.survey.plan import Plan
from pursue_gen.survey.spots import exits_of, shut_in
from pursue_gen.workspace.levels import Level, Ways

_SOME = 8  # places that a message lists
_REACH = 5.0  # metres around a place in which a point that can be reached is looked for


def empty(scenario: Scenario, level: Level) -> Iterator[Diagnostic]:
    """A map on which nothing is in the way."""
    free = level.ground.free_pixels()
    if free is not None and 0 not in free:
        message = f"{level.map_name} has no obstacle: each path on it is a straight line"
        hint = "where robots have to follow lanes or roads, leave the distances as they are written: --keep"
        yield warning("MAP011", message, scenario.pois[0].span, hint)


def apart(scenario: Scenario, plan: Plan, clearance: Clearance, needed: float) -> Iterator[Diagnostic]:
    """Ways whose ends cannot be reached from each other, and places that cannot be reached from most others; `needed`:
    how far from obstacles a place has to be (metres)."""
    spans = {poi.name: poi.span for poi in scenario.pois}
    first, *others = plan.parts() or [[]]

    def hint(names: Iterable[str]) -> str:
        found = "look for a door that is closed or narrow on the map, clean the map, or try a smaller --radius"
        for name in names:
            point = None if name in first else clearance.nearest(*plan.places[name], needed, _REACH, plan.is_joined)
            if point is not None:
                metres = math.dist(point, plan.places[name])
                return f"{first[0]} reaches {point[0]:.2f}, {point[1]:.2f}, {metres:.2f} m from {name}; or {found}"
        return found

    named = set()
    for way in scenario.connections:
        if way.by is None and {way.a, way.b} <= set(plan.places) and plan.route(way.a, way.b) is None:
            named |= {way.a, way.b}
            message = f"on the map a robot cannot get from {way.a} to {way.b}"
            yield warning("MAP004", message, way.span, hint((way.a, way.b)))
    for part in others:
        if not named.intersection(part):
            message = f"on the map a robot cannot get from {_listed(first)} to {_listed(part)}"
            yield warning("MAP004", message, spans[part[0]], hint(part))


def crossing(scenario: Scenario, plan: Plan) -> Iterator[Diagnostic]:
    """Ways that lead through third places."""
    for way in scenario.connections:
        places = plan.crossed(way.a, way.b) if way.by is None else []
        if places:
            message = f"the way from {way.a} to {way.b} leads through {_listed(places)}, where a robot may stand"
            stops = [way.a, *places, way.b]
            instead = ", ".join(f"{a} and {b}" for a, b in zip(stops, stops[1:]))
            yield warning("MAP006", message, way.span, f"connect {instead} instead, or move the place aside")


def without_room(scenario: Scenario, spots: Mapping[str, Sequence[Tuple[str, Optional[Pose]]]]) -> Iterator[Diagnostic]:
    """Robots for which there is no spot at a place."""
    spans = {poi.name: poi.span for poi in scenario.pois}
    for place, found in spots.items():
        names = [robot for robot, pose in found if pose is None]
        if names:
            hint = f"move the place to where there is more room, or write objective: place {place} holds 1 robot"
            yield warning("MAP007", f"there is no room for {_listed(names)} beside {place}", spans[place], hint)


def shut_in_places(scenario: Scenario, grid: Grid, ways: Ways, radius: float, room: float) -> Iterator[Diagnostic]:
    """Robots that cannot leave a place while the others stand there; `scenario` has all spots."""
    present = robots_at(scenario)
    for poi in scenario.pois:
        own = {spot.robot.name: spot.pose for spot in poi.spots}
        standing = {robot: own.get(robot, poi.pose) for robot in present[poi.name]}
        points = {robot: (pose.x, pose.y) for robot, pose in standing.items() if pose is not None}
        points = {robot: point for robot, point in points.items() if grid.is_free(grid.cell(*point))}
        if poi.pose is None or len(set(points.values())) < 2:
            continue
        exits = exits_of(poi.name, (poi.pose.x, poi.pose.y), ways, room)
        names = [list(points)[number] for number in shut_in(grid, list(points.values()), exits, 2 * radius)]
        if names:
            hint = f"move the place out of the dead end, or write objective: place {poi.name} holds 1 robot"
            yield warning(
                "MAP009", f"{_listed(names)} cannot leave {poi.name} while all others stand there", poi.span, hint
            )


def other_unit(
    scenario: Scenario, measured: Mapping[Connection, float], timed: AbstractSet[Movement], unit: float
) -> Iterator[Diagnostic]:
    """Distances that are not of the unit in which they are written now, where times depend on them.

    `measured`: the lengths (metres) of ways whose distances change; `timed`: movements that have windows in the copy.
    """
    ratios = [(metres / unit / float(way.distance), way.span) for way, metres in measured.items()]
    ratios.sort(key=lambda one: one[0])
    changed = {ends for way in measured for ends in way.directions}
    movers = [
        agent.name
        for agent in scenario.agents
        if any((agent.name, *ends) not in timed for ends in changed & scenario.movements(agent).keys())
    ]
    if not ratios or not movers:
        return
    ratio, span = ratios[len(ratios) // 2]
    if not 2 / 3 <= ratio <= 1.5:
        message = f"ways are {ratio:.1f} times as long as written, so with the same mobile {_listed(movers)} "
        other = "" if scenario.in_metres else f"say what a unit of distance is: --unit {ratio * unit:.2g}; or "
        hint = f"{other}change mobile, or give robots a --speed"
        yield warning("MAP008", message + f"will take {ratio:.1f} times as long", span, hint)


def _listed(names: Iterable[str]) -> str:
    """`a, b and c`, cut where there are many."""
    known: List[str] = list(names)
    return listed(known[:_SOME] + (["…"] if len(known) > _SOME else []))
