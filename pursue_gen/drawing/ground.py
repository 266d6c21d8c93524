"""The ground of a map of map_server: which points are free, in an obstacle, unknown, or outside the map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Callable, Iterable, Optional, Sequence, Tuple

from pursue_gen.drawing.floor import MapSettings, read_image, read_settings, unusable

FREE, OCCUPIED, UNKNOWN, OUTSIDE = "free", "occupied", "unknown", "outside"
_KINDS = (UNKNOWN, FREE, OCCUPIED)
_IS_FREE = bytes(number == _KINDS.index(FREE) for number in range(256))
_FULL, _UNKNOWN = 100, 255
"""Values of mode raw: from 100 on an obstacle, 255 unknown."""


@dataclass(frozen=True)
class Ground:
    """What a map says about each pixel: `width` and `height` in pixels; `cells`, row by row from the top, has the
    number of each one's kind.

    `cells` is None where the pixels of the image are not known: an unusual kind of PNG.
    """

    settings: MapSettings
    width: int
    height: int
    cells: Optional[bytes]

    def at(self, x: float, y: float) -> str:
        """What is at a point of the map (metres); free where the greys are not known."""
        column, row = self.pixel(x, y)
        if not (0 <= column < self.width and 0 <= row < self.height):
            return OUTSIDE
        return FREE if self.cells is None else _KINDS[self.cells[row * self.width + column]]

    def pixel(self, x: float, y: float) -> Tuple[int, int]:
        """The column and the row, counted from the top, in which a point of the map (metres) is."""
        across, up = self.settings.pixels(x, y)
        return math.floor(across), self.height - 1 - math.floor(up)

    def middle(self, column: float, row: float) -> Tuple[float, float]:
        """The middle of a pixel (column, row from the top) as a point of the map (metres)."""
        return self.settings.metres(column + 0.5, self.height - row - 0.5)

    def free_pixels(self) -> Optional[bytes]:
        """1 for each pixel that is free, else 0, row by row from the top; None where the pixels are not known."""
        return None if self.cells is None else self.cells.translate(_IS_FREE)


def read_ground(file: Path, whole: bool = False) -> Ground:
    """The ground of a yaml file of map_server; `whole`: its pixels must be known. Raises PursueError (status 2)."""
    settings = read_settings(file)
    image = read_image(settings.image)
    if whole and image.rows is None:
        expected = "a PGM, or a PNG of 8 bits per channel without palette and interlacing"
        raise unusable(settings.image, "its pixels cannot be read", expected)
    cells = None if image.rows is None else cells_of(settings, image.channels, image.rows)
    return Ground(settings, image.width, image.height, cells)


def cells_of(settings: MapSettings, channels: int, rows: Iterable[bytes]) -> bytes:
    """The kinds of pixels (0: unknown), as map_server 1.17 has them (`image_loader.cpp`).

    It counts the mean of the colours, and in mode trinary of the colours and the opacity; grey with opacity is read as
    RGB with opacity.
    """
    counted = {1: (0,), 2: (0, 0, 0, 1), 3: (0, 1, 2), 4: (0, 1, 2, 3)}[channels]
    if channels in (2, 4) and settings.mode != "trinary":
        counted = counted[:3]
    by_sum = bytes(_kind(settings, total / len(counted)) for total in range(255 * len(counted) + 1))
    return b"".join(_kinds(by_sum, [row[channel::channels] for channel in counted]) for row in rows)


def _kinds(by_sum: bytes, parts: Sequence[bytes]) -> bytes:
    """The kinds of the pixels of a row by the sums of the parts: a byte of each pixel in each part."""
    constant = [part for part in parts if part.count(part[:1]) == len(part)]
    others = [part for part in parts if part.count(part[:1]) < len(part)]
    base = sum(part[0] for part in constant)
    if len(set(others)) < 2:  # as nearly all rows of maps are: one grey, perhaps with one opacity
        several = len(others)
        row = others[0] if others else bytes(len(constant[0]))
        return row.translate(bytes(by_sum[base + several * value] for value in range(256)))
    return bytes(by_sum[base + sum(values)] for values in zip(*others))


def _kind(settings: MapSettings, mean: float) -> int:
    """The number of what map_server makes of a mean (0 to 255); in the order of its operations, to the last bit.

    What is neither free nor occupied is unknown here in all modes; in mode scale map_server grades it. In mode raw a
    value, which map_server passes on as it is, is compared as a percentage with the thresholds.
    """
    if settings.negate:
        mean = 255 - mean
    if settings.mode == "raw":
        if int(mean) == _UNKNOWN:
            return _KINDS.index(UNKNOWN)
        darkness = int(mean) / _FULL
    else:
        darkness = (255 - mean) / 255.0
    if darkness > settings.occupied:
        return _KINDS.index(OCCUPIED)
    return _KINDS.index(FREE if darkness < settings.free else UNKNOWN)


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
