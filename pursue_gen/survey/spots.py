"""A spot for each robot at each place: on free ground, apart from the others, beside the ways where there is room."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import islice
from typing import Callable, Dict, Iterable, List, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from pursue_gen.drawing.layout import yaw_of
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Poi, Pose, Scenario
from pursue_gen.survey.grid import Array, Grid, Point
from pursue_gen.workspace.levels import Ways
from pursue_gen.workspace.map_spots import NEAR

_REACH = 4
"""How far from a place its spots are looked for: so many times the room of a robot, and 3 m at least."""
_LEAST_REACH = 3.0
_DENSE = 0.1
"""Metres between the points that are tried, and between those of a way."""

_NEARLY = 0.25
"""Metres within which points are equally near to a place."""
_LEAVING = 1.5
"""A spot may be in the way of robots that come to its place or leave it, up to so many times the room of a robot."""

_AROUND = 1.0
"""Metres around spots and exits in which a robot looks for a path from one to the other."""
_TRIES = 200
"""So many points are looked at for one from which nobody is shut in."""


@dataclass(frozen=True)
class Standing:
    """Where on a grid robots may stand: as far from obstacles as they need (`may`), and as their planners like it."""

    may: Grid
    likes: Grid


Spots = Dict[str, List[Tuple[str, Optional[Pose]]]]
"""place → robots without a pose of their own there, with the spot that is proposed; None: there is no room."""


def proposed_spots(
    scenario: Scenario,
    grid: Grid,
    places: Iterable[str],
    room: float,
    ways: Ways,
    body: float = 0.0,
    standing: Optional[Callable[[str], Standing]] = None,
) -> Spots:
    """Spots for all robots that share a place with others and have no pose of their own there.

    The first of them has the pose of the place. `places`: those whose pose is on free ground; `room`: metres that the
    centres of two robots keep between them; `ways`: the paths that robots take; `body`: metres by which the centres of
    two robots are apart that touch each other; `standing`: where a robot may stand, by its name. A spot is first of all
    out of the way of other robots, then where planners like it, then as near to the pose of its place as possible, more
    or less, beside it rather than before or behind it, and seen from it. Where that is possible, each robot can leave
    while the others stand there.
    """
    present, wanted = robots_at(scenario), set(places)
    taken = [point for poi in scenario.pois for point in _given(poi, present[poi.name])]
    found: Spots = {}
    passed = [(ends, _samples(line)) for ends, line in ways.items()]
    for poi in scenario.pois:
        own = {spot.robot.name for spot in poi.spots}
        robots = [robot for robot in present[poi.name] if robot not in own][1:]
        if poi.name not in wanted or poi.pose is None or not robots:
            continue
        passing = ((_passing(poi, passed, room), room), (_ending(poi, passed), body))
        candidates: Dict[int, _Candidates] = {}  # by where they may stand
        found[poi.name] = []
        others = [one for one in _given(poi, present[poi.name]) if grid.is_free(grid.cell(*one))]
        exits = exits_of(poi.name, (poi.pose.x, poi.pose.y), ways, room)
        for robot in robots:
            where = standing(robot) if standing is not None else None
            if id(where) not in candidates:
                candidates[id(where)] = _Candidates(grid, poi.pose, room, passing, where)
            point = candidates[id(where)].best(taken, others, exits, body)
            found[poi.name].append((robot, None if point is None else replace(poi.pose, x=point[0], y=point[1])))
            taken += [] if point is None else [point]
            others += [] if point is None else [point]
    return found


def shut_in(grid: Grid, points: Sequence[Point], exits: Sequence[Point], body: float) -> List[int]:
    """The numbers of those points from which a robot gets to none of the exits while others stand at all other points,
    though it does without them."""
    scale = grid.settings.resolution
    cells = [grid.cell(*point) for point in points]
    away = [grid.cell(*point) for point in exits]
    margin = math.ceil(_AROUND / scale)
    left, bottom = (max(0, math.floor(min(one[axis] for one in (*cells, *away))) - margin) for axis in (0, 1))
    right, top = (math.floor(max(one[axis] for one in (*cells, *away))) + margin + 1 for axis in (0, 1))
    free = grid.free[bottom:top, left:right]
    rows, columns = np.ogrid[: free.shape[0], : free.shape[1]]
    apart = [np.hypot(columns + 0.5 + left - x, rows + 0.5 + bottom - y) * scale for x, y in cells]

    def gets_away(number: int, others: Sequence[int]) -> bool:
        labels, _ = ndimage.label(free & np.all([apart[other] >= body for other in others], axis=0))
        here = labels[math.floor(cells[number][1]) - bottom, math.floor(cells[number][0]) - left]
        return bool(here) and any(labels[math.floor(y) - bottom, math.floor(x) - left] == here for x, y in away)

    return [
        number
        for number in range(len(points))
        if gets_away(number, ()) and not gets_away(number, [one for one in range(len(points)) if one != number])
    ]


def exits_of(place: str, middle: Point, ways: Ways, room: float) -> List[Point]:
    """Where robots are that have just left a place, beyond its spots, for each of its ways."""
    found, left = [], max(_LEAST_REACH, _REACH * room) + room
    for ends, line in ways.items():
        if place in ends:
            points = _samples(line)
            far = np.hypot(points[:, 0] - middle[0], points[:, 1] - middle[1]) >= left
            points = points if ends[0] == place else points[::-1]
            far = far if ends[0] == place else far[::-1]
            first = int(np.argmax(far)) if far.any() else len(points) - 1
            found.append((float(points[first, 0]), float(points[first, 1])))
    return found


def _given(poi: Poi, present: Sequence[str]) -> List[Point]:
    """The points that robots have by what the scenario says: their own, and the place's if one has none."""
    own = [(spot.pose.x, spot.pose.y) for spot in poi.spots]
    alone = poi.pose is not None and not {spot.robot.name for spot in poi.spots}.issuperset(present or {""})
    return [*own, (poi.pose.x, poi.pose.y)] if alone and poi.pose is not None else own


class _Candidates:
    """The free points around a place from which it can be reached, in the order in which they are wanted."""

    def __init__(
        self, grid: Grid, pose: Pose, room: float, passed: Iterable[Tuple[Array, float]], standing: Optional[Standing]
    ) -> None:
        """`passed`: points of ways, and metres from them within which robots are in each other's way."""
        self._grid, self._room, self._middle = grid, room, grid.cell(pose.x, pose.y)
        reach = max(_LEAST_REACH, _REACH * room)
        found = _connected(grid, self._middle, reach)
        if standing is not None:
            found = found[standing.may.free[found[:, 1], found[:, 0]]]
        cells = found + 0.5
        points = np.round(np.column_stack(grid.metres((cells[:, 0], cells[:, 1]))), 3) + 0.0
        x, y = points[:, 0] - pose.x, points[:, 1] - pose.y
        apart = np.hypot(x, y)
        likes = apart <= NEAR
        if standing is not None:
            likes &= standing.likes.free[found[:, 1], found[:, 0]]
        aside = np.ones(len(points), dtype=bool)
        for others, least in passed:
            aside &= cKDTree(others).query(points)[0] >= least if len(others) else True
        ahead = np.abs(x * math.cos(yaw_of(pose)) + y * math.sin(yaw_of(pose)))
        order = np.lexsort((points[:, 1], points[:, 0], np.round(ahead, 3), apart // _NEARLY, ~likes, ~aside))
        self._points = points[order][apart[order] <= reach]

    def best(
        self, taken: Sequence[Point], standing: Sequence[Point], exits: Sequence[Point], body: float
    ) -> Optional[Point]:
        """The first of the points that is far enough from those that are taken, if possible one that sees the place and
        lets those who are standing there leave; None: there is none."""
        free = np.ones(len(self._points), dtype=bool)
        for x, y in taken:
            free &= np.hypot(self._points[:, 0] - x, self._points[:, 1] - y) >= self._room
        points = [(float(x), float(y)) for x, y in self._points[free]]
        seen = (point for point in points if self._grid.sees(self._middle, self._grid.cell(*point)))
        first = list(islice(seen, _TRIES)) or points[:_TRIES]
        open_ = (point for point in first if not shut_in(self._grid, [*standing, point], exits, body))
        return next(open_, first[0] if first else None)


def _connected(grid: Grid, middle: Point, reach: float) -> Array:
    """Cells (column, row) around a free point from which it can be reached without going farther; not all, if many."""
    cells = math.ceil(reach / grid.settings.resolution)
    column, row = math.floor(middle[0]), math.floor(middle[1])
    left, bottom = max(0, column - cells), max(0, row - cells)
    labels, _ = ndimage.label(grid.free[bottom : row + cells + 1, left : column + cells + 1])
    found = np.argwhere(labels == labels[row - bottom, column - left])[:, ::-1] + (left, bottom)
    step = max(1, int(_DENSE / grid.settings.resolution))
    return found[((found - (column, row)) % step == 0).all(axis=1)]


def _samples(line: Sequence[Point]) -> Array:
    """Points on a line with bends, close to each other."""
    parts = [np.array(line[:1])]
    for a, b in zip(line, line[1:]):
        parts.append(np.linspace(a, b, max(1, math.ceil(math.dist(a, b) / _DENSE)) + 1))
    return np.concatenate(parts)


def _ending(poi: Poi, ways: Sequence[Tuple[Tuple[str, str], Array]]) -> Array:
    """The points of the ways that end at a place."""
    return np.concatenate([np.zeros((0, 2)), *(points for ends, points in ways if poi.name in ends)])


def _passing(poi: Poi, ways: Sequence[Tuple[Tuple[str, str], Array]], room: float) -> Array:
    """The points of ways near a place, without those at the place itself of the ways that end there."""
    assert poi.pose is not None
    found = [np.zeros((0, 2))]
    for ends, points in ways:
        apart = np.hypot(points[:, 0] - poi.pose.x, points[:, 1] - poi.pose.y)
        least = _LEAVING * room if poi.name in ends else 0.0
        found.append(points[(apart >= least) & (apart <= max(_LEAST_REACH, _REACH * room) + room)])
    return np.concatenate(found)
