"""Maps of buildings, drawn cell by cell."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable, List, Tuple

import numpy as np

from pursue_gen.drawing.floor import MapSettings
from pursue_gen.drawing.ground import Ground, cells_of
from pursue_gen.survey.grid import Grid, grid_of

WALL, UNKNOWN, FREE = 0, 205, 254
Box = Tuple[float, float, float, float]
"""Left, bottom, right, top in metres."""

THREE_ROOMS = 12.0, 6.0
"""Metres: the rooms are side by side, with walls of 0.2 m between them."""
DOORS = (4.0, 4.5), (8.0, 1.5)
"""The middles of the doors of the three rooms."""


def drawn(size: Tuple[float, float], walls: Iterable[Box], free: Iterable[Box] = (), resolution: float = 0.05) -> Any:
    """The greys of a free floor with walls around it and in it, and what is free again in these; the first row is the
    lowest one."""
    cells = np.full((round(size[1] / resolution), round(size[0] / resolution)), FREE, dtype=np.uint8)
    cells[[0, -1]], cells[:, [0, -1]] = WALL, WALL
    for boxes, grey in ((walls, WALL), (free, FREE)):
        for box in boxes:
            left, bottom, right, top = (round(one / resolution) for one in box)
            cells[bottom:top, left:right] = grey
    return cells


def three_rooms(door: float = 1.0, resolution: float = 0.05) -> Any:
    """Three rooms in a row with a door of this width between two of them each."""
    walls = [(3.9, 0.0, 4.1, 6.0), (7.9, 0.0, 8.1, 6.0)]
    doors = [(x - 0.1, y - door / 2, x + 0.1, y + door / 2) for x, y in DOORS]
    return drawn(THREE_ROOMS, walls, doors, resolution)


def ground_of(greys: Any, resolution: float = 0.05, origin: Tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Ground:
    """The ground of greys whose first row is the lowest one."""
    settings = MapSettings(Path("map.pgm"), resolution, *origin, False, 0.65, 0.196, "trinary")
    return Ground(settings, greys.shape[1], greys.shape[0], cells_of(settings, 1, [greys[::-1].tobytes()]))


def cells(rows: List[str]) -> Grid:
    """The grid of a drawing of 1 m per cell: `#` is a wall, the first row is the highest one. Radius 0."""
    greys = np.array([[WALL if sign == "#" else FREE for sign in row] for row in reversed(rows)], dtype=np.uint8)
    return grid_of(ground_of(greys, 1.0), 0.0)


def write(folder: Path, greys: Any, resolution: float = 0.05, origin: str = "[0, 0, 0]") -> Path:
    """The map as map_saver writes it."""
    image = b"P5\n# CREATOR: map_saver\n%d %d\n255\n" % greys.shape[::-1] + greys[::-1].tobytes()
    (folder / "rooms.pgm").write_bytes(image)
    lines = f"image: rooms.pgm\nresolution: {resolution}\norigin: {origin}\nnegate: 0\n"
    (folder / "map.yaml").write_text(lines + "occupied_thresh: 0.65\nfree_thresh: 0.196\n")
    return folder / "map.yaml"
