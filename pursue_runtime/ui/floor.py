"""The floor plan under the map, where the workspace has one: map/floor.yaml beside the data, and its picture."""

from __future__ import annotations

import math
import os
from typing import Any, Dict, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError, read_data
from pursue_runtime.png import find_damage

FOLDER, SETTINGS, PICTURE = "map", "floor.yaml", "floor.png"

LARGEST = 10_000_000
"""Bytes of a picture."""


class Floor(NamedTuple):
    """A floor plan: its picture as PNG, `width` and `height` in pixels, `resolution` in metres per pixel; `x`, `y`
    (metres) and `yaw` (radians) are the pose of its lower left corner on the map. `paths` are those of ways, as far as
    they are known: from, to, the bends (metres)."""

    picture: bytes
    width: int
    height: int
    resolution: float
    x: float
    y: float
    yaw: float
    paths: Tuple[Tuple[str, str, Tuple[Tuple[float, float], ...]], ...] = ()

    def scene(self) -> Dict[str, Any]:
        """Return it for the page, which asks for the picture."""
        return {name: value for name, value in self._asdict().items() if name != "picture"}


def read_floor(config: str) -> Optional[Floor]:
    """The floor plan beside the folder of a package's data; None where there is none. Raises DataError."""
    folder = os.path.normpath(os.path.join(config, "..", FOLDER))
    path = os.path.join(folder, SETTINGS)
    if not os.path.isfile(path):
        return None
    data = read_data(path)
    try:
        with open(os.path.join(folder, PICTURE), "rb") as file:
            picture = file.read(LARGEST + 1)
        width, height, resolution = int(data["width"]), int(data["height"]), float(data["resolution"])
        x, y, yaw = map(float, data["origin"])
        paths = tuple(
            (str(a), str(b), tuple((float(x), float(y)) for x, y in line)) for a, b, line in data.get("paths", ())
        )
    except (OSError, KeyError, TypeError, ValueError, OverflowError) as problem:
        raise DataError(f"{path} cannot be used: {problem!r}; generate the workspace again") from problem
    sizes = width > 0 and height > 0 and resolution > 0 and all(map(math.isfinite, (resolution, x, y, yaw)))
    bends = (number for _, _, line in paths for bend in line for number in bend)
    if not all(map(math.isfinite, bends)) or not all(len(line) > 1 for _, _, line in paths):
        raise DataError(f"{path} has a path that is no line in metres; generate the workspace again")
    if not sizes or len(picture) > LARGEST or find_damage(picture):
        raise DataError(f"{path} does not belong to a picture in {PICTURE}; generate the workspace again")
    return Floor(picture, width, height, resolution, x, y, yaw, paths)
