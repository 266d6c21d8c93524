"""The picture of a floor plan: without what the map does not know, and so small that thin walls are seen."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from pathlib import Path
from typing import List, Sequence, Tuple

from pursue_gen.drawing.floor import Floor, Image, MapSettings, read_image, read_settings, unusable
from pursue_gen.drawing.ground import cells_of
from pursue_runtime.png import SIGNATURE

CLOSE = 2400
"""The most pixels across, or up, of a picture that is looked at closely."""
_USUAL = 1200
_AROUND = 0.5
"""Metres of unknown ground that stay around what is known."""
_MOST = 8_000_000
"""Bytes of the picture in the page: what it is embedded in has to stay below 10 MB."""
_COLOUR_TYPES = {1: 0, 2: 4, 3: 2, 4: 6}  # of a PNG, by channels

_Box = Tuple[int, int, int, int]
"""Left, top, right, bottom in pixels, the last two exclusive."""


def read_floor(file: Path, most: int = _USUAL) -> Floor:
    """The floor plan of a yaml file of map_server, without the unknown ground around it.

    Where it has more than `most` pixels across or up, squares of pixels become one: the one that is most an obstacle.
    Pictures with opacity keep their size, those whose pixels cannot be read are taken as they are. Raises PursueError
    (exit status 2).
    """
    settings = read_settings(file)
    image = read_image(settings.image)
    content, step = image.content, 1
    left, top, right, bottom = 0, 0, image.width, image.height
    if image.rows is not None:
        left, top, right, bottom = _known(settings, image)
        channels = image.channels
        rows = [row[left * channels : right * channels] for row in image.rows[top:bottom]]
        step = math.ceil(max(right - left, bottom - top) / most) if channels in (1, 3) else 1
        bright = settings.negate != (settings.mode == "raw")
        content = _png(_smaller(rows, channels, step, bright) if step > 1 else rows, channels)
    if len(content) > _MOST:
        message = f"{settings.image.name} takes {len(content) / 1e6:.1f} MB as PNG"
        raise unusable(file, message, f"an image below {_MOST / 1e6:g} MB: cut it, or make it smaller")
    width, height = math.ceil((right - left) / step), math.ceil((bottom - top) / step)
    up = image.height - top - height * step  # squares begin at the top: the lowest ones may reach beyond the image
    cos, sin = math.cos(settings.yaw), math.sin(settings.yaw)
    x = settings.x + settings.resolution * (cos * left - sin * up)
    y = settings.y + settings.resolution * (sin * left + cos * up)
    uri = "data:image/png;base64," + base64.b64encode(content).decode("ascii")
    return Floor(uri, width, height, settings.resolution * step, x, y, settings.yaw)


def _known(settings: MapSettings, image: Image) -> _Box:
    """The part of an image that the map knows, and a little around it; all of it where nothing is known."""
    assert image.rows is not None
    cells = cells_of(settings, image.channels, image.rows)
    rows = [cells[k : k + image.width] for k in range(0, len(cells), image.width)]
    known = [number for number, row in enumerate(rows) if row.strip(b"\0")]
    if not known:
        return 0, 0, image.width, image.height
    around = math.ceil(_AROUND / settings.resolution)
    left = min(len(rows[k]) - len(rows[k].lstrip(b"\0")) for k in known)
    right = max(len(rows[k].rstrip(b"\0")) for k in known)
    return (
        max(0, left - around),
        max(0, known[0] - around),
        min(image.width, right + around),
        min(image.height, known[-1] + 1 + around),
    )


def _smaller(rows: Sequence[bytes], channels: int, step: int, bright: bool) -> List[bytes]:
    """The rows of a picture in which squares of so many pixels are one: the darkest of them, or the brightest."""
    chosen = max if bright else min
    found = []
    for k in range(0, len(rows), step):
        row = bytes(map(chosen, *rows[k : k + step])) if len(rows) > k + 1 else rows[k]
        pixel = [row[channel::channels] for channel in range(channels)]
        small = [bytes(chosen(one[j : j + step]) for j in range(0, len(one), step)) for one in pixel]
        found.append(bytes(value for values in zip(*small) for value in values))
    return found


def _png(rows: Sequence[bytes], channels: int) -> bytes:
    """Eight bits for each channel of each pixel as PNG."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    data = b"".join(b"\x00" + row for row in rows)
    head = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), 8, _COLOUR_TYPES[channels], 0, 0, 0)
    return SIGNATURE + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")
