"""Room for a robot on a map: how far a point is from what is not free, and where nearby there is room."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Callable, Optional, Sequence, Tuple

from pursue_gen.drawing.ground import Ground

Point = Tuple[float, float]

_MOST = 250
"""Cells around a point in which room is looked for, on fine maps."""
_TOUCH = 1e-9
"""Cells by which a distance counts as equal; numbers are as exact."""


class Clearance:
    """Distances on a map from obstacles: from all that is not free, unknown ground and the edge of the map included.

    As in the costmaps of move_base they are distances between the centres of cells.
    """

    def __init__(self, ground: Ground) -> None:
        self._ground, self._width, self._height = ground, ground.width, ground.height
        self._free = ground.free_pixels() or b"\1" * (ground.width * ground.height)  # what is not known is free

    def metres(self, x: float, y: float, most: float) -> float:
        """How far a point of the map (metres) is from the nearest obstacle, counted up to `most`."""
        scale = self._ground.settings.resolution
        column, row = self._ground.pixel(x, y)
        if not self._is_free(column, row):
            return 0.0
        best = most / scale
        up = 0
        while up < best:
            for line in {row - up, row + up}:
                best = min(best, math.hypot(up, self._aside(column, line, math.ceil(best))))
            up += 1
        return min(most, best * scale)

    def nearest(
        self, x: float, y: float, radius: float, reach: float, is_wanted: Callable[[Point], bool] = lambda point: True
    ) -> Optional[Point]:
        """The point nearest to a point of the map (metres) that is farther than `radius` from every obstacle and is
        wanted; None: there is none within `reach` metres."""
        scale = self._ground.settings.resolution
        column, row = self._ground.pixel(x, y)
        for across, down in _around(min(_MOST, math.ceil(reach / scale))):
            if self._is_clear(column + across, row + down, radius / scale + _TOUCH):
                point = self._ground.middle(column + across, row + down)
                if is_wanted(point):
                    return point
        return None

    def _is_free(self, column: int, row: int) -> bool:
        inside = 0 <= column < self._width and 0 <= row < self._height
        return inside and bool(self._free[row * self._width + column])

    def _aside(self, column: int, row: int, most: int) -> int:
        """How many columns the nearest obstacle in a row is away from one, counted up to `most`."""
        if not self._is_free(column, row):
            return 0
        start, here = row * self._width, row * self._width + column
        right = self._free.find(0, here, min(here + most, start + self._width))
        left = self._free.rfind(0, max(start, here - most), here)
        found = [right - here if right >= 0 else self._width - column, here - left if left >= 0 else column + 1]
        return min(most, *found)

    def _is_clear(self, column: int, row: int, radius: float) -> bool:
        """Return True if no obstacle is within the radius (cells)."""
        if not self._is_free(column, row):
            return False
        high = math.floor(radius)
        if not (high <= row < self._height - high and high <= column < self._width - high):
            return False
        for up in range(high + 1):  # the rows of a disc, from its middle to its ends
            wide = math.floor(math.sqrt(radius * radius - up * up))
            for line in {row - up, row + up}:
                here = line * self._width + column
                if self._free.find(0, here - wide, here + wide + 1) >= 0:
                    return False
        return True


def to_line(line: Sequence[Point], point: Point) -> Tuple[float, float]:
    """How near a line with bends comes to a point, and how far along the line that is."""
    best, along = (math.inf, 0.0), 0.0
    for a, b in zip(line, line[1:]):
        size = math.dist(a, b)
        share = 0.0
        if size > 0:
            share = ((point[0] - a[0]) * (b[0] - a[0]) + (point[1] - a[1]) * (b[1] - a[1])) / size**2
            share = min(1.0, max(0.0, share))
        at = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
        best = min(best, (math.dist(at, point), along + share * size))
        along += size
    return best


@lru_cache(maxsize=2)
def _around(reach: int) -> Tuple[Tuple[int, int], ...]:
    """The cells of a disc, the nearest to its middle first."""
    cells = ((i * i + j * j, j, i) for i in range(-reach, reach + 1) for j in range(-reach, reach + 1))
    return tuple((i, j) for square, j, i in sorted(cells) if square <= reach * reach)
