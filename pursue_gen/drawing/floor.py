"""A floor plan under the map: the image and the yaml that map_server reads."""

from __future__ import annotations

import base64
import math
import re
import struct
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.files import read_text
from pursue_runtime.bounded import SETTINGS, BadText, read_yaml

_PNG = b"\x89PNG\r\n\x1a\n"
_LARGEST = 64_000_000
"""Pixels; more than any map that map_server was made for."""

_MOST = 8_000_000
"""Bytes of the picture in the page: what it is embedded in has to stay below 10 MB."""


@dataclass(frozen=True)
class Floor:
    """A floor plan. `uri`: the picture as data; `width`, `height` in pixels; `resolution` in metres per pixel.

    `x`, `y` (metres) and `yaw` (radians) say where its lower left corner is on the map, and how it is turned.
    `negate`: bright pixels are occupied; a darkness above `occupied` (0 to 1) is an obstacle, one below `free` is free.
    """

    uri: str
    width: int
    height: int
    resolution: float
    x: float
    y: float
    yaw: float
    negate: bool = False
    occupied: float = 0.65
    free: float = 0.196

    def corners(self) -> Tuple[Tuple[float, float], ...]:
        """The four corners in metres."""
        across, up = self.width * self.resolution, self.height * self.resolution
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        ends = ((0.0, 0.0), (across, 0.0), (across, up), (0.0, up))
        return tuple((self.x + cos * a - sin * b, self.y + sin * a + cos * b) for a, b in ends)


def read_floor(file: Path) -> Floor:
    """The floor plan of a yaml file of map_server. Raises PursueError (exit status 2)."""
    data = _yaml(file)
    resolution = _number(file, data, "resolution")
    if not 0 < resolution < 1000:
        raise _bad(file, f"resolution is {resolution:g}", "metres per pixel, such as 0.05")
    origin = data.get("origin")
    if not isinstance(origin, list) or len(origin) != 3 or not all(_is_number(one) for one in origin):
        raise _bad(file, "origin is not a list of three numbers", "[x, y, yaw] of the lower left corner, in metres")
    image = data.get("image")
    if not isinstance(image, str) or not image:
        raise _bad(file, "image is missing", "image: and the name of a PGM or PNG file")
    content, width, height = _image(file.parent / image)
    if len(content) > _MOST:
        message = f"{image} takes {len(content) / 1e6:.1f} MB as PNG"
        raise _bad(file, message, f"an image below {_MOST / 1e6:g} MB: cut it, or make it smaller")
    uri = "data:image/png;base64," + base64.b64encode(content).decode("ascii")
    x, y, yaw = (float(one) for one in origin)
    negate = _number(file, data, "negate", 0) != 0
    occupied, free = _number(file, data, "occupied_thresh", 0.65), _number(file, data, "free_thresh", 0.196)
    return Floor(uri, width, height, resolution, x, y, yaw, negate, occupied, free)


def _yaml(file: Path) -> Dict[str, Any]:
    text = read_text(file, "a map of map_server, such as map.yaml")
    try:
        data = read_yaml(text, SETTINGS)
    except BadText as problem:
        raise _bad(file, str(problem), "lines such as resolution: 0.05") from None
    if not isinstance(data, dict):
        raise _bad(file, "it holds no settings", "the lines image:, resolution: and origin:")
    return data


def _image(file: Path) -> Tuple[bytes, int, int]:
    """The image as PNG, its width and height."""
    try:
        content = file.read_bytes()
    except (OSError, ValueError) as problem:
        reason = getattr(problem, "strerror", None) or str(problem)
        raise _bad(file, f"it cannot be read: {reason}", "in the yaml file, image: and the name of a file") from None
    if content.startswith(_PNG):
        if len(content) < 24 or content[12:16] != b"IHDR":
            raise _bad(file, "it is a damaged PNG", "save it again")
        width, height = struct.unpack(">II", content[16:24])
        return content, *_sized(file, width, height)
    if content[:2] in (b"P2", b"P5"):
        return _pgm(file, content)
    raise _bad(file, "it is neither PGM nor PNG", "save it as one of these")


def _pgm(file: Path, content: bytes) -> Tuple[bytes, int, int]:
    """A grey map, written as PNG."""
    head = re.match(rb"P([25])" + rb"(?:\s|#[^\n]*\n)+(\d{1,9})" * 3 + rb"\s", content)
    if head is None:
        raise _bad(file, "its head is damaged", "P5, width, height, largest grey, as map_saver writes them")
    width, height = _sized(file, int(head.group(2)), int(head.group(3)))
    largest, count = int(head.group(4)), width * height
    if not 0 < largest < 65536:
        raise _bad(file, f"its largest grey is {largest}", "1 to 65535, usually 255")
    body = content[head.end() :]
    if head.group(1) == b"2":
        words = re.sub(rb"#[^\n]*", b"", body).split()[:count]
        if not all(word.isdigit() and len(word) < 6 for word in words):
            raise _bad(file, "there is something that is no grey", f"numbers from 0 to {largest}")
        values: List[int] = [int(word) for word in words]
    elif largest < 256:
        values = list(body[:count])
    else:
        values = [256 * high + low for high, low in zip(body[0 : 2 * count : 2], body[1 : 2 * count : 2])]
    if len(values) < count:
        raise _bad(file, f"it ends after {len(values)} of {count} pixels", "copy it again")
    greys = bytes(min(value, largest) * 255 // largest for value in values)
    return _png(greys, width, height), width, height


def _sized(file: Path, width: int, height: int) -> Tuple[int, int]:
    if not width or not height or width * height > _LARGEST:
        raise _bad(file, f"it has {width} times {height} pixels", f"1 to {_LARGEST // 1_000_000} million pixels")
    return width, height


def _png(greys: bytes, width: int, height: int) -> bytes:
    """Eight bits of grey per pixel as PNG."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\x00" + greys[k * width : (k + 1) * width] for k in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return _PNG + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def _number(file: Path, data: Dict[str, Any], key: str, default: Optional[float] = None) -> float:
    value = data.get(key, default)
    if not _is_number(value):
        raise _bad(file, f"{key} is {'missing' if value is None else 'not a number'}", f"{key}: and a number")
    assert isinstance(value, (int, float))
    return float(value)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) and abs(value) < 1e6


def _bad(file: Path, what: str, expected: str) -> PursueError:
    return PursueError([error("REP001", f"the map {file} cannot be used: {what}", hint=f"expected: {expected}")], 2)
