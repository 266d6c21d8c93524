"""The ground of a map of map_server: which points are free, in an obstacle, unknown, or outside the map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Iterable, Optional, Sequence, Tuple

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
        place = self.settings
        cos, sin = math.cos(place.yaw), math.sin(place.yaw)
        column = math.floor((cos * (x - place.x) + sin * (y - place.y)) / place.resolution)
        return column, self.height - 1 - math.floor((cos * (y - place.y) - sin * (x - place.x)) / place.resolution)

    def middle(self, column: float, row: float) -> Tuple[float, float]:
        """The middle of a pixel (column, row from the top) as a point of the map (metres)."""
        place = self.settings
        cos, sin = math.cos(place.yaw), math.sin(place.yaw)
        across, up = (column + 0.5) * place.resolution, (self.height - row - 0.5) * place.resolution
        return place.x + cos * across - sin * up, place.y + sin * across + cos * up

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
