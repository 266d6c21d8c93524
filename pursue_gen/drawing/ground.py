"""The ground of a map of map_server: which points are free, in an obstacle, unknown, or outside the map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple

from pursue_gen.drawing.floor import MapSettings, read_greys, read_settings, unusable

FREE, OCCUPIED, UNKNOWN, OUTSIDE = "free", "occupied", "unknown", "outside"
_FULL, _UNKNOWN = 100, 255
"""Greys of mode raw: from 100 on an obstacle, 255 unknown."""


@dataclass(frozen=True)
class Ground:
    """What a map says about each pixel: `width` and `height` in pixels, `greys` row by row from the top.

    `greys` is None where those of the image are not known: an unusual kind of PNG.
    """

    settings: MapSettings
    width: int
    height: int
    greys: Optional[bytes]

    def at(self, x: float, y: float) -> str:
        """What is at a point of the map (metres); free where the greys are not known."""
        column, row = self.pixel(x, y)
        if not (0 <= column < self.width and 0 <= row < self.height):
            return OUTSIDE
        return FREE if self.greys is None else kind_of(self.settings, self.greys[row * self.width + column])

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
        """1 for each pixel that is free, else 0, row by row from the top; None where the greys are not known."""
        table = bytes(kind_of(self.settings, grey) == FREE for grey in range(256))
        return None if self.greys is None else self.greys.translate(table)


def read_ground(file: Path, whole: bool = False) -> Ground:
    """The ground of a yaml file of map_server; `whole`: its greys must be known. Raises PursueError (exit status 2)."""
    settings = read_settings(file)
    greys, width, height = read_greys(settings.image)
    if whole and greys is None:
        expected = "a PGM, or a PNG of 8 bits per channel without palette and interlacing"
        raise unusable(settings.image, "its pixels cannot be read", expected)
    return Ground(settings, width, height, greys)


def kind_of(settings: MapSettings, grey: int) -> str:
    """What map_server makes of a grey: free, occupied or unknown.

    What is neither free nor occupied is unknown here in all modes; in mode scale map_server grades it.
    """
    if settings.mode == "raw":
        if grey == _UNKNOWN:
            return UNKNOWN
        darkness = grey / _FULL
    else:
        darkness = (grey if settings.negate else 255 - grey) / 255
    if darkness > settings.occupied:
        return OCCUPIED
    return FREE if darkness < settings.free else UNKNOWN
