"""Where the centre of a robot may be on a map: its free cells, as far from obstacles as the robot's radius.

Points of this module are (column, row) in cells, from the lower left corner; a cell is the square that begins at its
whole numbers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Tuple

import numpy as np

from pursue_gen.drawing.floor import MapSettings
from pursue_gen.drawing.ground import Ground

Point = Tuple[float, float]
Array = Any
"""An array of numpy."""

_TOUCH = 1e-9
"""Cells by which a line that touches a corner counts as being on both sides of it; numbers are as exact."""

_SAMPLES = (0.5, 0.25, 0.75)

_SHORT = 24
"""Columns up to which a line is looked at cell by cell, which is then faster than with arrays."""


@dataclass(frozen=True)
class Grid:
    """`free[row, column]` is True where the centre of the robot may be; unknown cells are obstacles.

    It is the part of the map in which there are free cells, and its edge is not free: what is outside is unknown.
    `column`, `row`: where it begins on the map.
    """

    settings: MapSettings
    free: Array
    column: int
    row: int

    def cell(self, x: float, y: float) -> Point:
        """The point of the grid for a point of the map (metres)."""
        across, up = self.settings.pixels(x, y)
        return across - self.column, up - self.row

    def metres(self, point: Point) -> Point:
        """The point of the map (metres) for a point of the grid; of arrays for arrays."""
        return self.settings.metres(point[0] + self.column, point[1] + self.row)

    def is_free(self, point: Point) -> bool:
        """Return True if the centre of the robot may be at a point of the grid."""
        column, row = math.floor(point[0]), math.floor(point[1])
        rows, columns = self.free.shape
        return bool(0 <= column < columns and 0 <= row < rows and self.free[row, column])

    def sees(self, a: Point, b: Point) -> bool:
        """Return True if all cells that the line between two points touches are free; both are in free cells."""
        one_by_one, width = self._cells[0], self.free.shape[1]
        for share in _SAMPLES:  # most lines that are blocked are found out here
            if not one_by_one[int(a[1] + share * (b[1] - a[1])) * width + int(a[0] + share * (b[0] - a[0]))]:
                return False
        steep = abs(b[1] - a[1]) > abs(b[0] - a[0])
        free = self._turned if steep else self.free
        (u, v), (to_u, to_v) = sorted((a[::-1], b[::-1]) if steep else (a, b))
        slope = (to_v - v) / (to_u - u) if to_u > u else 0.0
        if to_u - u < _SHORT:
            return _is_free(self._cells[steep], free.shape[1], (u, v), (to_u, to_v), slope)
        columns = self._numbers[int(u) : int(to_u) + 2]
        heights = slope * (columns - u) + v  # where the line crosses from column to column
        heights[0], heights[-1] = v, to_v
        touch = _TOUCH if slope >= 0 else -_TOUCH
        enter, leave = (heights[:-1] - touch).astype(np.int64), (heights[1:] + touch).astype(np.int64)
        cells, width, columns = free.ravel(), free.shape[1], columns[:-1]
        if not (cells.take(enter * width + columns).all() and cells.take(leave * width + columns).all()):
            return False
        middle = (enter + leave) // 2  # of three rows that a diagonal may touch
        return bool(cells.take(middle * width + columns).all())

    @cached_property
    def _turned(self) -> Array:
        return np.ascontiguousarray(self.free.T)

    @cached_property
    def _cells(self) -> Tuple[Array, Array]:
        """The cells one after the other, row by row and column by column, for quick looks at single ones."""
        rows, columns = (np.ascontiguousarray(one).ravel().view(np.uint8) for one in (self.free, self._turned))
        return rows.data, columns.data

    @cached_property
    def _numbers(self) -> Array:
        return np.arange(max(self.free.shape) + 1)


def _is_free(cells: Array, width: int, a: Point, b: Point, slope: float) -> bool:
    """Whether all cells are free that a line touches, which goes on from column to column."""
    (u, v), (to_u, to_v) = a, b
    first, last = int(u), int(to_u)
    touch = _TOUCH if slope >= 0 else -_TOUCH
    leave = v
    for column in range(first, last + 1):
        enter, leave = leave, to_v if column == last else slope * (column + 1 - u) + v
        low, high = int(enter - touch), int(leave + touch)
        if not (cells[low * width + column] and cells[high * width + column]):
            return False
        if not cells[(low + high) // 2 * width + column]:
            return False
    return True


def touched(enter: Array, leave: Array) -> Tuple[Array, Array, Array]:
    """The rows that lines touch in a column which they enter and leave at these heights, at most three for each."""
    low = (np.minimum(enter, leave) - _TOUCH).astype(np.int64)
    high = (np.maximum(enter, leave) + _TOUCH).astype(np.int64)
    return low, (low + high) // 2, high


def grid_of(ground: Ground, radius: float) -> Grid:
    """The grid for robots of this radius (metres). Its greys are known.

    As for move_base's costmaps, a cell is free if no obstacle has its centre within the radius of the cell's centre.
    Where no cell of the map is free, the grid has none.
    """
    pixels = ground.free_pixels()
    assert pixels is not None
    free = np.frombuffer(pixels, dtype=np.bool_).reshape(ground.height, ground.width)[::-1]
    rows, columns = np.flatnonzero(free.any(axis=1)), np.flatnonzero(free.any(axis=0))
    if not len(rows):
        return Grid(ground.settings, np.zeros((0, 0), dtype=np.bool_), 0, 0)
    part = np.pad(free[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1], 1)
    blocked = _grown(~part, radius / ground.settings.resolution + _TOUCH)
    return Grid(ground.settings, ~blocked, int(columns[0]) - 1, int(rows[0]) - 1)


def _grown(obstacles: Array, radius: float) -> Array:
    """Whatever is within the radius (cells) of an obstacle; the edge is one."""
    rows, columns = obstacles.shape
    grown = obstacles.copy()
    wide, width = obstacles.copy(), 0
    for up in range(min(math.floor(radius), rows - 1), -1, -1):  # the rows of a disc, from its ends to its middle
        reach = math.floor(math.sqrt(radius * radius - up * up))
        while width < min(reach, columns - 1):
            width += 1
            wide[:, width:] |= obstacles[:, :-width]
            wide[:, :-width] |= obstacles[:, width:]
        grown[up:] |= wide[: rows - up]
        grown[: rows - up] |= wide[up:]
    return grown
