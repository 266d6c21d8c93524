"""Where the points of interest are: the poses that the author gave, and a planar layout where some are missing."""

from __future__ import annotations

import heapq
import math
from dataclasses import replace
from typing import Dict, List, Mapping, Sequence, Tuple

from pursue_gen.language.scenario import Pose, Scenario

Point = Tuple[float, float]
Distances = Mapping[str, Mapping[str, float]]

_ROUNDS = 300
_STILL = 1e-4  # metres; the layout is finished when no point moves farther in a round
_DECIMALS = 2
MOST_PLACES = 400
"""More places cannot be read on one picture, and to lay them out takes long."""


def drawable(scenario: Scenario) -> Scenario:
    """Without what an unfinished text may hold, but no picture can show."""
    pois = tuple({poi.name: poi for poi in reversed(scenario.pois)}.values())[::-1]
    names = {poi.name for poi in pois}
    long = (way if way.distance > 0 else replace(way, distance=1) for way in scenario.connections)
    ways = {
        (way.directions[0] if way.one_way else frozenset((way.a, way.b)), way.whom_text): way
        for way in long
        if way.a != way.b and {way.a, way.b} <= names
    }
    agents = tuple(agent for agent in scenario.agents if agent.location.name in names)
    return replace(scenario, pois=pois, connections=tuple(ways.values()), agents=agents)


def poses(scenario: Scenario) -> Tuple[Mapping[str, Pose], bool]:
    """A pose for each POI, and whether some of them are computed.

    A computed pose looks along x; its place is chosen so that distances on the map come close to those of the
    connections, one metre per unit of distance (stress minimisation over shortest ways), and is rounded to
    centimetres. Given poses stay as they are and the others are laid out around them. Parts of the map that are not
    connected stand side by side. The same scenario always gets the same layout.
    """
    given = {poi.name: poi.pose for poi in scenario.pois if poi.pose is not None}
    if len(given) == len(scenario.pois):
        return given, False
    fixed = {name: (pose.x, pose.y) for name, pose in given.items()}
    places = _layout(scenario, fixed)
    flat = {name: Pose(x, y, 0.0, 0.0, 0.0, 0.0, 1.0) for name, (x, y) in places.items() if name not in given}
    return {poi.name: given.get(poi.name) or flat[poi.name] for poi in scenario.pois}, True


def yaw_of(pose: Pose) -> float:
    """The direction in which a pose looks (radians)."""
    return math.atan2(2 * (pose.qw * pose.qz + pose.qx * pose.qy), 1 - 2 * (pose.qy * pose.qy + pose.qz * pose.qz))


def _layout(scenario: Scenario, fixed: Mapping[str, Point]) -> Dict[str, Point]:
    """A place for each POI; those in `fixed` are kept."""
    places: Dict[str, Point] = dict(fixed)
    edge = max((x for x, _ in fixed.values()), default=0.0)
    for part, distances in _parts(scenario):
        anchored = any(name in fixed for name in part)
        found = _place(part, distances, fixed)
        shift = (0.0, 0.0)
        if not anchored:
            gap = _typical(scenario) if places else 0.0
            shift = (edge + gap - min(x for x, _ in found.values()), -min(y for _, y in found.values()))
        for name in part:
            x, y = found[name]
            places.setdefault(name, (_rounded(x + shift[0]), _rounded(y + shift[1])))
            edge = max(edge, places[name][0])
    return places


def _parts(scenario: Scenario) -> List[Tuple[List[str], Distances]]:
    """The connected parts of the map, each with the lengths of the shortest ways within it, in order of declaration."""
    names = [poi.name for poi in scenario.pois]
    distances = {name: _shortest(scenario, name) for name in names}
    firsts = [name for name in names if name == next(other for other in names if other in distances[name])]
    return [([name for name in names if name in distances[first]], distances) for first in firsts]


def _shortest(scenario: Scenario, start: str) -> Mapping[str, float]:
    """The length of the shortest way from a POI to each that can be reached from it (Dijkstra)."""
    found: Dict[str, float] = {}
    open_: List[Tuple[float, str]] = [(0.0, start)]
    while open_:
        length, here = heapq.heappop(open_)
        if here in found:
            continue
        found[here] = length
        for way in scenario.connections:
            if here in (way.a, way.b):
                heapq.heappush(open_, (length + way.distance, way.b if here == way.a else way.a))
    return found


def _typical(scenario: Scenario) -> float:
    """The mean length of a connection: the gap between parts that are not connected."""
    lengths = [float(way.distance) for way in scenario.connections]
    return sum(lengths) / len(lengths) if lengths else 1.0


def _place(part: Sequence[str], distances: Distances, fixed: Mapping[str, Point]) -> Dict[str, Point]:
    """Minimises stress by majorisation (Gansner, Koren, North 2004), point by point, from a circle.

    Stress is the sum over pairs of (distance on the map - length of the shortest way)² / length².
    """
    anchors = [fixed[name] for name in part if name in fixed]
    centre = (_mean([x for x, _ in anchors]), _mean([y for _, y in anchors]))
    radius = max((length for name in part for length in distances[name].values()), default=0.0) / 2
    places: Dict[str, Point] = {}
    for index, name in enumerate(part):
        angle = 2 * math.pi * index / len(part)
        on_circle = (centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle))
        places[name] = fixed.get(name, on_circle)
    for _ in range(_ROUNDS):
        moved = 0.0
        for name in part:
            if name not in fixed and len(part) > 1:
                place = _better(name, part, distances[name], places)
                moved = max(moved, math.dist(place, places[name]))
                places[name] = place
        if moved < _STILL:
            break
    return places


def _better(name: str, part: Sequence[str], lengths: Mapping[str, float], places: Mapping[str, Point]) -> Point:
    """Where the others want a point: the weighted mean of the places at the right distance from each of them."""
    x, y = places[name]
    total = sum_x = sum_y = 0.0
    for other in part:
        length = lengths[other]
        if other == name or not length:
            continue
        ox, oy = places[other]
        away = math.hypot(x - ox, y - oy) or 1e-9
        weight = 1 / (length * length)
        sum_x += weight * (ox + length * (x - ox) / away)
        sum_y += weight * (oy + length * (y - oy) / away)
        total += weight
    return (sum_x / total, sum_y / total) if total else (x, y)


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _rounded(value: float) -> float:
    return round(value, _DECIMALS) + 0.0  # + 0.0: no -0.0 in generated files
