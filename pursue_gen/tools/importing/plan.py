"""A building as places and ways in metres: what robots can drive on, without points where nothing is decided.

A vertex without a name and without a property, between two others, is no place: its two lanes are one way. Dead ends of
that kind lead nowhere. So a scenario has as many places as people and crossings need.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace
from typing import Any, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.tools.importing.building import DEGREES, Building, Edge, Level, Properties, Vertex

Node = Tuple[str, int]
"""A level's name and the number of a vertex."""

_RADIUS_OF_EARTH = 6_371_000.0
_LONGEST = 100_000.0
"""Metres of a lane: where one is longer, the scale is wrong."""
_PASSED_OVER = ("is_passthrough_point", "human_goal_set_name")
"""Properties of vertices that make no place."""


@dataclass(frozen=True)
class Stop:
    """A place: metres from the origin of the drawing, x to the right and y upwards, z the elevation."""

    node: Node
    vertex: Vertex
    x: float
    y: float
    z: float

    @property
    def lift(self) -> str:
        """The lift whose cabin this is; empty for all else."""
        return str(self.vertex.properties.get("lift_cabin") or "")


@dataclass(frozen=True)
class Track:
    """A way between two stops, `metres` long. `there`, `back`: the navigation graphs on which robots drive it from its
    start to its end, and back; `doors`: those that it passes; `parts`: its lanes' metres, each with the metres
    per second that robots may drive there (0: as fast as they like); `mutex`: the group of lanes and vertices of which
    one robot may have one, "" for none."""

    start: Node
    end: Node
    metres: float
    there: FrozenSet[int]
    back: FrozenSet[int]
    doors: Tuple[Node, ...] = ()
    parts: Tuple[Tuple[float, float], ...] = ()
    mutex: str = ""

    def seconds(self, speed: float) -> float:
        """How long a robot of this speed takes, which keeps to what is allowed."""
        return sum(metres / min(speed, limit or speed) for metres, limit in self.parts)

    def is_limited(self, speed: float) -> bool:
        """True where a robot of this speed may not drive so fast."""
        return any(0 < limit < speed for _, limit in self.parts)

    @property
    def graphs(self) -> FrozenSet[int]:
        """The graphs that have it, in one direction at least."""
        return self.there | self.back

    def turned(self) -> Track:
        """The same from its end to its start."""
        doors, parts = self.doors[::-1], self.parts[::-1]
        return Track(self.end, self.start, self.metres, self.back, self.there, doors, parts, self.mutex)


@dataclass(frozen=True)
class RobotStart:
    """A robot, where it stands, and the graphs whose lanes begin or end there."""

    name: str
    type: str
    node: Node
    graphs: FrozenSet[int]


@dataclass(frozen=True)
class DoorPlace:
    """A door: the middle of it, in metres as for a `Stop`, and in which direction one looks through it, in radians."""

    name: str
    x: float
    y: float
    z: float
    yaw: float


@dataclass(frozen=True)
class FloorPlan:
    """Places, ways, lifts (name → their cabins, from the lowest level up) and robots, in the order of the file; the
    doors that ways pass, by their level and their number there."""

    stops: Tuple[Stop, ...]
    tracks: Tuple[Track, ...]
    lifts: Mapping[str, Tuple[Node, ...]]
    robots: Tuple[RobotStart, ...]
    doors: Mapping[Node, DoorPlace]


def floor_plan(building: Building) -> FloorPlan:
    """What robots can drive on. Raises PursueError (exit status 2) where there is no scale, no lane or no robot."""
    where = _metres(building)
    vertices = {(level.name, k): vertex for level in building.levels for k, vertex in enumerate(level.vertices)}
    robots = _robots(building, vertices)
    used = frozenset(graph for robot in robots for graph in robot.graphs)
    tracks = [track for level in building.levels for track in _tracks(level, where) if track.graphs & used]
    needed = {node for node, vertex in vertices.items() if _is_place(vertex)}
    tracks = _joined(_without_dead_ends(tracks, needed), needed)
    ends = {node for track in tracks for node in (track.start, track.end)} | {robot.node for robot in robots}
    nodes = [node for node in vertices if node in ends]
    elevations = {level.name: level.elevation for level in building.levels}
    stops = [Stop(node, vertices[node], *where[node], elevations[node[0]]) for node in nodes]
    lifts: Dict[str, List[Stop]] = {}
    for stop in stops:
        if stop.lift:
            lifts.setdefault(stop.lift, []).append(stop)
    cabins = {
        name: tuple(stop.node for stop in sorted(some, key=lambda one: one.z))
        for name, some in lifts.items()
        if len(some) > 1
    }
    passed = {door for track in tracks for door in track.doors}
    doors = {
        (level.name, k): _door_place(level, door, where)
        for level in building.levels
        for k, door in enumerate(level.doors)
        if (level.name, k) in passed
    }
    return FloorPlan(tuple(stops), tuple(tracks), cabins, robots, doors)


def _door_place(level: Level, door: Edge, where: Mapping[Node, Tuple[float, float]]) -> DoorPlace:
    (x1, y1), (x2, y2) = where[level.name, door.start], where[level.name, door.end]
    yaw = math.atan2(y2 - y1, x2 - x1) + math.pi / 2
    return DoorPlace(str(door.properties.get("name") or ""), (x1 + x2) / 2, (y1 + y2) / 2, level.elevation, yaw)


def _is_place(vertex: Vertex) -> bool:
    """True if people know it by a name, or something is there."""
    return bool(vertex.name) or any(
        value not in (False, "", None) for name, value in vertex.properties.items() if name not in _PASSED_OVER
    )


def _robots(building: Building, vertices: Mapping[Node, Vertex]) -> Tuple[RobotStart, ...]:
    graphs: Dict[Node, Set[int]] = {}
    for level in building.levels:
        for lane in level.lanes:
            for end in (lane.start, lane.end):
                graphs.setdefault((level.name, end), set()).add(_graph(lane))
    if not graphs:
        hint = "draw lanes in the traffic editor, or write ways by hand; see docs/import.md"
        raise PursueError([error("IMP003", "the building has no lanes to drive on", building.levels[0].span, hint)])
    found: List[RobotStart] = []
    for node, vertex in vertices.items():
        name = str(vertex.properties.get("spawn_robot_name") or "")
        if name and node in graphs:
            if any(robot.name == name for robot in found):
                hint = "give each its own spawn_robot_name in the traffic editor"
                raise PursueError([error("IMP004", f"two robots are called {name!r}", vertex.span, hint)])
            kind = str(vertex.properties.get("spawn_robot_type") or "")
            found.append(RobotStart(name, kind, node, frozenset(graphs[node])))
    if not found:
        hint = "give a vertex on a lane the property spawn_robot_name in the traffic editor"
        raise PursueError([error("IMP004", "no robot stands on a lane", building.levels[0].span, hint)])
    return tuple(found)


def _graph(lane: Edge) -> int:
    value = lane.properties.get("graph_idx", 0)
    return value if isinstance(value, int) else 0


def _tracks(level: Level, where: Mapping[Node, Tuple[float, float]]) -> List[Track]:
    """The lanes of a level; all those between the same two vertices are one track."""
    found: Dict[FrozenSet[Node], Track] = {}
    for lane in level.lanes:
        start, end, graph = (level.name, lane.start), (level.name, lane.end), frozenset({_graph(lane)})
        if start == end:
            continue
        track = found.get(frozenset({start, end}))
        if track is None:
            doors = tuple((level.name, k) for k, door in enumerate(level.doors) if _crosses(level, lane, door))
            metres = math.dist(where[start], where[end])
            if metres > _LONGEST:
                message = f"a lane would be {metres / 1000:.0f} km long"
                raise PursueError([error("IMP002", message, lane.span, "look at measurements and coordinate_system")])
            track = Track(start, end, metres, frozenset(), frozenset(), doors, ((metres, 0.0),))
        track = track if track.start == start else track.turned()
        back = track.back | graph if lane.properties.get("bidirectional") is True else track.back
        limits = [limit for limit in (track.parts[0][1], _limit(lane)) if limit > 0]
        parts = ((track.metres, min(limits, default=0.0)),)
        mutex = track.mutex or mutex_of(lane.properties)
        found[frozenset({start, end})] = replace(track, there=track.there | graph, back=back, parts=parts, mutex=mutex)
    return list(found.values())


def mutex_of(properties: Properties) -> str:
    """The group of lanes and vertices of which one robot may have one; "" for none."""
    value = properties.get("mutex")
    return value.strip() if isinstance(value, str) else ""


def _limit(lane: Edge) -> float:
    """Metres per second that robots may drive on a lane; 0: as fast as they like."""
    value = lane.properties.get("speed_limit")
    return float(value) if isinstance(value, (int, float)) and not isinstance(value, bool) and value > 0 else 0.0


def _crosses(level: Level, lane: Edge, door: Edge) -> bool:
    """True if the lane leads through the door: their segments cross, or a lane's end is in the door."""
    a, b, c, d = (level.vertices[k] for k in (lane.start, lane.end, door.start, door.end))
    return _side(a, b, c) * _side(a, b, d) <= 0 and _side(c, d, a) * _side(c, d, b) <= 0


def _side(a: Vertex, b: Vertex, c: Vertex) -> float:
    """On which side of the line from a to b the point c is: positive, negative, or 0 on it."""
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)


# Fewer places --------------------------------------------------------------------------------------------------------


def _without_dead_ends(tracks: Sequence[Track], needed: Set[Node]) -> List[Track]:
    """The tracks without those that lead to a point where nothing is, and nowhere else."""
    left = list(tracks)
    while True:
        ends = _at(left)
        kept = [t for t in left if all(node in needed or len(ends[node]) > 1 for node in (t.start, t.end))]
        if len(kept) == len(left):
            return kept
        left = kept


def _joined(tracks: Sequence[Track], needed: Set[Node]) -> List[Track]:
    """The same with one track in place of two that meet where nothing is decided."""
    at = _at(tracks)
    for node in [node for node in at if node not in needed]:
        some = at[node]
        if len(some) != 2:
            continue
        one, other = some
        whole = _one_of(one, other, node)
        if whole is None or any({t.start, t.end} == {whole.start, whole.end} for t in at[whole.start]):
            continue  # there would be two ways between the same places, or they are not alike
        for track in (one, other):
            for end in (track.start, track.end):
                at[end] = [t for t in at[end] if t is not track]
        del at[node]
        for end in (whole.start, whole.end):
            at[end].append(whole)
    return list(dict.fromkeys(track for some in at.values() for track in some))


def _at(tracks: Sequence[Track]) -> Dict[Node, List[Track]]:
    """The tracks that begin or end at each node."""
    found: Dict[Node, List[Track]] = {}
    for track in tracks:
        for node in (track.start, track.end):
            found.setdefault(node, []).append(track)
    return found


def _one_of(one: Track, other: Track, node: Node) -> Optional[Track]:
    """The track over both, which meet at the node; None where they differ in who may drive where."""
    one = one if one.end == node else one.turned()
    other = other if other.start == node else other.turned()
    if (one.there, one.back, one.mutex) != (other.there, other.back, other.mutex) or one.start == other.end:
        return None
    doors = one.doors + tuple(door for door in other.doors if door not in one.doors)
    return replace(one, end=other.end, metres=one.metres + other.metres, doors=doors, parts=one.parts + other.parts)


# Metres --------------------------------------------------------------------------------------------------------------


def _metres(building: Building) -> Dict[Node, Tuple[float, float]]:
    """Where each vertex is, in metres, on the map of the reference level. Raises PursueError without a scale."""
    if building.coordinates == DEGREES:
        return _from_degrees(building)
    reference = next((level for level in building.levels if level.name == building.reference), building.levels[0])
    found: Dict[Node, Tuple[float, float]] = {}
    for level in building.levels:
        if not level.lanes:
            continue
        a, b = (1 + 0j, 0j) if level is reference else _aligned(level, reference)
        scale = _scale(reference if (a, b) != (1, 0) else level)
        for k, vertex in enumerate(level.vertices):
            point = (a * complex(vertex.x, vertex.y) + b) * scale
            found[level.name, k] = (point.real, -point.imag)  # the drawing's y goes down
    return found


def _scale(level: Level) -> float:
    """Metres of a pixel: the mean of what was measured."""
    found: List[float] = []
    for one in level.measurements:
        a, b = level.vertices[one.start], level.vertices[one.end]
        metres, pixels = one.properties.get("distance"), math.hypot(a.x - b.x, a.y - b.y)
        if isinstance(metres, (int, float)) and metres > 0 and pixels > 0:
            found.append(metres / pixels)
    if not found:
        message = f"level {level.name} has no measurement, so nothing says how long a pixel is"
        hint = "measure the distance of two vertices in the traffic editor"
        raise PursueError([error("IMP002", message, level.span, hint)])
    return sum(found) / len(found)


def _aligned(level: Level, reference: Level) -> Tuple[complex, complex]:
    """a and b by which the pixel z of the level is above a·z + b of the reference level: a turn, a size and a shift by
    the least squares over common fiducials; 1 and 0 where fewer than two are common."""
    names = [name for name in level.fiducials if name in reference.fiducials]
    here = [complex(*level.fiducials[name]) for name in names]
    there = [complex(*reference.fiducials[name]) for name in names]
    if len(names) < 2:
        return 1 + 0j, 0j
    middle, middle_there = sum(here) / len(here), sum(there) / len(there)
    spread = sum(abs(z - middle) ** 2 for z in here)
    if spread == 0:
        return 1 + 0j, 0j
    a = sum((w - middle_there) * (z - middle).conjugate() for z, w in zip(here, there)) / spread
    return (a, middle_there - a * middle) if cmath.isfinite(a) and a else (1 + 0j, 0j)


def _from_degrees(building: Building) -> Dict[Node, Tuple[float, float]]:
    """Metres to the east and to the north of the first vertex: what a campus has, the earth is flat."""
    vertices = {(level.name, k): vertex for level in building.levels for k, vertex in enumerate(level.vertices)}
    first: Any = next(iter(vertices.values()), None)
    return {
        node: (
            math.radians(vertex.x - first.x) * _RADIUS_OF_EARTH * math.cos(math.radians(first.y)),
            math.radians(vertex.y - first.y) * _RADIUS_OF_EARTH,
        )
        for node, vertex in vertices.items()
    }
