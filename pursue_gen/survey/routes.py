"""Ways on a map: the shortest path of a robot's centre between two points, as a line with bends.

A path is looked for in the graph of regions, and then pulled tight among the free cells of the whole grid. So it can be
driven, and is no shorter than the shortest path; docs/survey.md says how much longer it may be. From its speed follows
how long a robot takes for a path: the window of a `travel`.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Callable, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np

from pursue_gen.drawing.layout import yaw_of
from pursue_gen.language.scenario import Pose
from pursue_gen.survey.graph import Graph
from pursue_gen.survey.grid import Array, Grid, Point

Cell = Tuple[int, int]

_GAIN = 0.002
"""A path is tight when pulling it once more makes it shorter by less than this part."""
_ROUNDS = 20
_FARTHEST = 16
"""Points are added at distances of half a cell and its doubles, up to 2 ** 15 cells."""
_SIDES = tuple((i, j, math.hypot(i, j)) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j)


@dataclass(frozen=True)
class Route:
    """A path between two points: its bends on the map, both ends included (metres), and its `length` (metres)."""

    bends: Tuple[Point, ...]
    length: float

    def reversed(self) -> Route:
        """The path in the other direction."""
        return Route(self.bends[::-1], self.length)


class Routes:
    """The paths from some points of a grid to any others; the searches for all of them are made at once."""

    def __init__(self, graph: Graph, sources: Sequence[Point], most: float = math.inf) -> None:
        """`sources`: free points of the map (metres). Paths of more than `most` metres are looked for one by one."""
        self._graph, self._is_limited = graph, most < math.inf
        self._sources = {source: number for number, source in enumerate(dict.fromkeys(sources))}
        nodes = [graph.node(graph.grid.cell(*source)) for source in self._sources]
        found: Tuple[Array, Array] = graph.searched(nodes, most / graph.grid.settings.resolution) if nodes else ([], [])
        self._lengths, self._before = found
        self._found: Dict[Tuple[Point, Point], Optional[Route]] = {}
        self._joined: Callable[[int, int], List[Point]] = lru_cache(maxsize=None)(self._joined_anew)

    def both(self, a: Point, b: Point) -> Optional[Route]:
        """The path between two points, the lesser of which is a source; the same line in both directions. None if there
        is none."""
        if a > b:
            back = self.both(b, a)
            return None if back is None else back.reversed()
        if (a, b) not in self._found:
            self._found[a, b] = self.route(a, b)
        return self._found[a, b]

    def estimate(self, source: Point, target: Point) -> float:
        """The length in metres of the path in the graph, a little longer than the path itself; infinite: none."""
        grid = self._graph.grid
        found = self._lengths[self._sources[source]][self._graph.node(grid.cell(*target))]
        return float(found) * grid.settings.resolution

    def route(self, source: Point, target: Point) -> Optional[Route]:
        """The path from one of the sources to a free point; None if there is none, or they are other points."""
        grid = self._graph.grid
        if source not in self._sources or not grid.is_free(grid.cell(*target)):
            return None
        number, node = self._sources[source], self._graph.node(grid.cell(*target))
        if self._is_limited and not math.isfinite(self._lengths[number][node]):
            lengths, before = self._graph.searched([self._graph.node(grid.cell(*source))])
            self._lengths[number], self._before[number] = lengths[0], before[0]
        if not math.isfinite(self._lengths[number][node]):
            return None
        nodes = [node]
        while self._before[number][nodes[-1]] >= 0:
            nodes.append(int(self._before[number][nodes[-1]]))
        nodes.reverse()
        start, end = grid.cell(*source), grid.cell(*target)
        line = [start, *self._between(start, self._point(nodes[0])), self._point(nodes[0])]
        for a, b in zip(nodes, nodes[1:]):
            line += [*(self._joined(a, b) if a < b else self._joined(b, a)[::-1]), self._point(b)]
        line += [*self._between(self._point(nodes[-1]), end), end]
        tight = tightened(grid, line)
        scale = grid.settings.resolution
        return Route((source, *(grid.metres(one) for one in tight[1:-1]), target), length(tight) * scale)

    def _point(self, node: int) -> Point:
        x, y = self._graph.points[node]
        return float(x), float(y)

    def _joined_anew(self, a: int, b: int) -> List[Point]:
        return self._between(self._point(a), self._point(b))

    def _between(self, a: Point, b: Point) -> List[Point]:
        """The points between two points of regions that are neighbours, or one: none where one sees the other."""
        grid, block = self._graph.grid, self._graph.block
        if grid.sees(a, b):
            return []
        low = [math.floor(min(x, y) / block) * block for x, y in zip(a, b)]
        high = [math.floor(max(x, y) / block) * block + block for x, y in zip(a, b)]
        return _cells_between(grid, (low[0], low[1]), (high[0], high[1]), a, b)


def _cells_between(grid: Grid, low: Cell, high: Cell, a: Point, b: Point) -> List[Point]:
    """The centres of the cells on a shortest path from one point to another within a few blocks."""
    free = np.pad(grid.free[low[1] : high[1], low[0] : high[0]], 1).tolist()
    left, bottom = low[0] - 1, low[1] - 1
    start, goal = ((math.floor(one[0]) - left, math.floor(one[1]) - bottom) for one in (a, b))
    before: Dict[Cell, Cell] = {start: start}
    best = {start: 0.0}
    queue = [(0.0, start)]
    while queue:
        done, (column, row) = heapq.heappop(queue)
        if (column, row) == goal:
            break
        if done > best[column, row]:
            continue
        for right, up, size in _SIDES:
            x, y = column + right, row + up
            if free[y][x] and free[row][x] and free[y][column] and done + size < best.get((x, y), math.inf):
                best[x, y], before[x, y] = done + size, (column, row)
                heapq.heappush(queue, (done + size, (x, y)))
    found = [goal]
    while found[-1] != start:
        found.append(before[found[-1]])
    return [(left + column + 0.5, bottom + row + 0.5) for column, row in reversed(found)]


# Pulling paths tight --------------------------------------------------------------------------------------------------


def tightened(grid: Grid, line: Sequence[Point]) -> List[Point]:
    """A line of the same ends through free cells, no longer than the given one and tight around its obstacles."""
    found = _shortened(grid, line)
    before = math.inf
    for _ in range(_ROUNDS):
        now = length(found)
        if len(found) == 2 or now > before * (1 - _GAIN):
            break
        before = now
        found = _shortened(grid, _with_more_points(found)[::-1])[::-1]
        found = _shortened(grid, _with_more_points(found))
    return found


def length(line: Sequence[Point]) -> float:
    """The length of a line with bends."""
    return sum(math.dist(a, b) for a, b in zip(line, line[1:]))


def _shortened(grid: Grid, line: Sequence[Point]) -> List[Point]:
    """The line without the points between two that see each other, from its beginning on."""
    found, here = [line[0]], 0
    while here < len(line) - 1:
        step, far = 1, here + 1
        while far < len(line) - 1:  # ever larger steps while they are seen, then ever smaller ones
            following = min(len(line) - 1, far + step)
            if not grid.sees(line[here], line[following]):
                break
            far, step = following, step * 2
        while step > 1:
            step //= 2
            following = min(len(line) - 1, far + step)
            if following > far and grid.sees(line[here], line[following]):
                far = following
        found.append(line[far])
        here = far
    return found


def _with_more_points(line: Sequence[Point]) -> List[Point]:
    """The line with points on both sides of each bend, closer to it the denser."""
    found = [line[0]]
    last = len(line) - 2
    for number, (a, b) in enumerate(zip(line, line[1:])):
        size = math.dist(a, b)
        near = [far for far in (2.0**power for power in range(-1, _FARTHEST)) if far < size / 2]
        shares = [far / size for far in near] if number else []
        shares += [0.5] if near else []
        shares += [1 - far / size for far in reversed(near)] if number < last else []
        found += [(a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])) for share in shares]
        found.append(b)
    return found


_EXACT = 0.97
"""What a path is at least, in proportion to its length: what is found may be a little longer than the shortest one."""

_SHARP = math.radians(30)
"""Bends from here on are taken to need a stop."""


@dataclass(frozen=True)
class Drive:
    """How robots drive. `speeds`: metres per second, by robot; only these get windows.

    `time_unit`: seconds per time unit, as `~time_unit` of the mission. `turning`: radians per second on the spot;
    `acceleration`: metres per second per second, when a robot starts and when it stops; `start`: seconds for planning
    in a movement. A movement may take `reserve` (a part, such as 0.25) longer than computed, and a robot has arrived
    `tolerance` metres before the pose at the earliest.
    """

    speeds: Mapping[str, float] = field(default_factory=dict)
    time_unit: float = 1.0
    turning: float = 0.5
    acceleration: float = 0.5
    start: float = 2.0
    reserve: float = 0.25
    tolerance: float = 0.4


def window(route: Route, ends: Tuple[Pose, Pose], speed: float, drive: Drive) -> Tuple[int, int]:
    """The window of a movement along a path, in whole time units: later than the first, at the second at the latest.

    `ends`: the poses at which it begins and ends. The first number is the time for the path at this speed, without any
    turn, to where the robot has arrived at the earliest. The second one is the time for the path, for all turns on the
    spot, from the direction of the first pose to that of the second one, for starting and stopping, also at each sharp
    bend, and for planning, with the reserve.
    """
    shortest = max(0.0, route.length * _EXACT - 2 * drive.tolerance)
    turns = turned(route, ends)
    stops = 1 + sum(turn >= _SHARP for turn in turns[1:-1])
    moving = route.length / speed + stops * speed / drive.acceleration
    longest = (moving + sum(turns) / drive.turning + drive.start) * (1 + drive.reserve)
    low = math.floor(shortest / speed / drive.time_unit)
    return low, max(low + 1, math.ceil(longest / drive.time_unit))


def turned(route: Route, ends: Tuple[Pose, Pose]) -> List[float]:
    """All turns (radians) of a robot that looks along its path, from the one at its beginning to the one at its end."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in zip(route.bends, route.bends[1:]) if a != b]
    directions = [yaw_of(ends[0]), *headings, yaw_of(ends[1])]
    return [abs(math.remainder(b - a, 2 * math.pi)) for a, b in zip(directions, directions[1:])]
