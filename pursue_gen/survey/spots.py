"""A spot for each robot at each place: on free ground, apart from the others, beside the ways where there is room."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree

from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Poi, Pose, Scenario
from pursue_gen.survey.grid import Array, Grid, Point
from pursue_gen.survey.times import yaw_of

_REACH = 4
"""How far from a place its spots are looked for: so many times the room of a robot, and 3 m at least."""
_LEAST_REACH = 3.0
_DENSE = 0.1
"""Metres between the points that are tried, and between those of a way."""

_NEARLY = 0.25
"""Metres within which points are equally near to a place."""
_LEAVING = 1.5
"""A spot may be in the way of robots that come to its place or leave it, up to so many times the room of a robot."""

Spots = Dict[str, List[Tuple[str, Optional[Pose]]]]
"""place → robots without a pose of their own there, with the spot that is proposed; None: there is no room."""


def proposed_spots(
    scenario: Scenario, grid: Grid, places: Iterable[str], room: float, ways: Mapping[Tuple[str, str], Sequence[Point]]
) -> Spots:
    """Spots for all robots that share a place with others and have no pose of their own there.

    The first of them has the pose of the place. `places`: those whose pose is on free ground; `room`: metres that the
    centres of two robots keep between them; `ways`: the paths that robots take. A spot is as near to the pose of its
    place as possible, more or less, beside it rather than before or behind it, seen from it, and first of all out of
    the way of other robots.
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
        candidates = _Candidates(grid, poi.pose, room, _passing(poi, passed, room))
        found[poi.name] = []
        for robot in robots:
            point = candidates.best(taken)
            found[poi.name].append((robot, None if point is None else replace(poi.pose, x=point[0], y=point[1])))
            taken += [] if point is None else [point]
    return found


def _given(poi: Poi, present: Sequence[str]) -> List[Point]:
    """The points that robots have by what the scenario says: their own, and the place's if one has none."""
    own = [(spot.pose.x, spot.pose.y) for spot in poi.spots]
    alone = poi.pose is not None and not {spot.robot.name for spot in poi.spots}.issuperset(present or {""})
    return [*own, (poi.pose.x, poi.pose.y)] if alone and poi.pose is not None else own


class _Candidates:
    """The free points around a place from which it can be reached, in the order in which they are wanted."""

    def __init__(self, grid: Grid, pose: Pose, room: float, passed: Array) -> None:
        """`passed`: points of ways at which robots are in each other's way."""
        self._grid, self._room, self._middle = grid, room, grid.cell(pose.x, pose.y)
        reach = max(_LEAST_REACH, _REACH * room)
        cells = _connected(grid, self._middle, reach) + 0.5
        points = np.round(np.column_stack(grid.metres((cells[:, 0], cells[:, 1]))), 3) + 0.0
        x, y = points[:, 0] - pose.x, points[:, 1] - pose.y
        apart = np.hypot(x, y)
        aside = cKDTree(passed).query(points)[0] >= room if len(passed) else np.ones(len(points), dtype=bool)
        ahead = np.abs(x * math.cos(yaw_of(pose)) + y * math.sin(yaw_of(pose)))
        order = np.lexsort((points[:, 1], points[:, 0], np.round(ahead, 3), apart // _NEARLY, ~aside))
        self._points = points[order][apart[order] <= reach]

    def best(self, taken: Sequence[Point]) -> Optional[Point]:
        """The first of the points that is far enough from those that are taken, if possible one that sees the place;
        None: there is none."""
        free = np.ones(len(self._points), dtype=bool)
        for x, y in taken:
            free &= np.hypot(self._points[:, 0] - x, self._points[:, 1] - y) >= self._room
        points = [(float(x), float(y)) for x, y in self._points[free]]
        seen = (point for point in points if self._grid.sees(self._middle, self._grid.cell(*point)))
        return next(seen, points[0] if points else None)


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


def _passing(poi: Poi, ways: Sequence[Tuple[Tuple[str, str], Array]], room: float) -> Array:
    """The points of ways near a place, without those at the place itself of the ways that end there."""
    assert poi.pose is not None
    found = [np.zeros((0, 2))]
    for ends, points in ways:
        apart = np.hypot(points[:, 0] - poi.pose.x, points[:, 1] - poi.pose.y)
        least = _LEAVING * room if poi.name in ends else 0.0
        found.append(points[(apart >= least) & (apart <= max(_LEAST_REACH, _REACH * room) + room)])
    return np.concatenate(found)
