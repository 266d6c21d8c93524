"""A floor plan of map_server: what its yaml file and its image say."""

from __future__ import annotations

import base64
import math
import re
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing.png_pixels import pixels
from pursue_gen.files import read_text, reason_of
from pursue_runtime.bounded import SETTINGS, BadText, read_yaml
from pursue_runtime.named_files import read_all
from pursue_runtime.png import LARGEST, SIGNATURE, find_damage

_LARGEST_FILE = 160 << 20
"""Bytes: so many pixels of 16 bits, and more."""

_MODES = ("trinary", "scale", "raw")

@dataclass(frozen=True)
class Floor:
    """A floor plan. `uri`: the picture as data; `width`, `height` in pixels; `resolution` in metres per pixel.

    `x`, `y` (metres) and `yaw` (radians) say where its lower left corner is on the map, and how it is turned. `paths`
    are those of ways, as far as they are known: the two places → the bends, from the first to the second (metres).
    """

    uri: str
    width: int
    height: int
    resolution: float
    x: float
    y: float
    yaw: float
    paths: Mapping[Tuple[str, str], Sequence[Tuple[float, float]]] = field(default_factory=dict)

    @property
    def picture(self) -> bytes:
        """The picture as PNG."""
        return base64.b64decode(self.uri.partition(",")[2])

    def corners(self) -> Tuple[Tuple[float, float], ...]:
        """The four corners in metres."""
        across, up = self.width * self.resolution, self.height * self.resolution
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        ends = ((0.0, 0.0), (across, 0.0), (across, up), (0.0, up))
        return tuple((self.x + cos * a - sin * b, self.y + sin * a + cos * b) for a, b in ends)


@dataclass(frozen=True)
class MapSettings:
    """What the yaml file of a map says: the file of its image, and what `Floor` has of it; `mode` is map_server's.

    `negate`: bright pixels are occupied; a darkness above `occupied` (0 to 1) is an obstacle, one below `free` is free.
    """

    image: Path
    resolution: float
    x: float
    y: float
    yaw: float
    negate: bool
    occupied: float
    free: float
    mode: str


def read_settings(file: Path) -> MapSettings:
    """What a yaml file of map_server says. Raises PursueError (exit status 2)."""
    data = _yaml(file)
    resolution = _number(file, data, "resolution")
    if not 0 < resolution < 1000:
        raise unusable(file, f"resolution is {resolution:g}", "metres per pixel, such as 0.05")
    origin = data.get("origin")
    if not isinstance(origin, list) or len(origin) != 3 or not all(_is_number(one) for one in origin):
        raise unusable(file, "origin is not a list of three numbers", "[x, y, yaw] of the lower left corner, in metres")
    image = data.get("image")
    if not isinstance(image, str) or not image:
        raise unusable(file, "image is missing", "image: and the name of a PGM or PNG file")
    mode = data.get("mode", "trinary")
    if mode not in _MODES:
        raise unusable(file, "its mode is none of map_server's", f"mode: {', '.join(_MODES[:-1])} or {_MODES[-1]}")
    x, y, yaw = (float(one) for one in origin)
    negate = _number(file, data, "negate", 0) != 0
    occupied, free = _number(file, data, "occupied_thresh", 0.65), _number(file, data, "free_thresh", 0.196)
    return MapSettings(file.parent / image, resolution, x, y, yaw, negate, occupied, free, str(mode))


@dataclass(frozen=True)
class Image:
    """An image of a map: its file's `content`, its size in pixels; of each pixel so many `channels` (1: grey, 2: grey
    and opacity, 3: RGB, 4: RGB and opacity); `rows`, from the top, with a byte for each channel of each pixel.

    `rows` is None for a PNG of an unusual kind.
    """

    content: bytes
    width: int
    height: int
    channels: int
    rows: Optional[Tuple[bytes, ...]]


def read_image(file: Path) -> Image:
    """The image of a map. Raises PursueError (exit status 2)."""
    content = _content(file)
    if content.startswith(SIGNATURE):
        width, height = _png_size(file, content)
        channels, rows = pixels(content) or (1, None)
        return Image(content, width, height, channels, rows)
    greys, width, height = _pgm_greys(file, content)
    return Image(content, width, height, 1, tuple(greys[k : k + width] for k in range(0, len(greys), width)))


def _yaml(file: Path) -> Dict[str, Any]:
    text = read_text(file, "a map of map_server, such as map.yaml")
    try:
        data = read_yaml(text, SETTINGS)
    except BadText as problem:
        raise unusable(file, str(problem), "lines such as resolution: 0.05") from None
    if not isinstance(data, dict):
        raise unusable(file, "it holds no settings", "the lines image:, resolution: and origin:")
    return data


def _content(file: Path) -> bytes:
    """What is in a file that begins like an image of a map."""
    try:
        content = read_all(file, _LARGEST_FILE)
    except (OSError, ValueError) as problem:
        hint = "in the yaml file, image: and the name of a file"
        raise unusable(file, f"it cannot be read: {reason_of(problem)}", hint) from None
    if not content.startswith((SIGNATURE, b"P2", b"P5")):
        raise unusable(file, "it is neither PGM nor PNG", "save it as one of these")
    return content


def _png_size(file: Path, content: bytes) -> Tuple[int, int]:
    if len(content) < 29 or content[12:16] != b"IHDR":
        raise unusable(file, "it is a damaged PNG", "save it again")
    width, height = _sized(file, *struct.unpack(">II", content[16:24]))
    damage = find_damage(content)
    if damage:
        raise unusable(file, f"it is a damaged PNG: {damage}", "a whole picture: copy or save it again")
    return width, height


def _pgm_greys(file: Path, content: bytes) -> Tuple[bytes, int, int]:
    """The greys of a PGM, its width and height."""
    head = re.match(rb"P([25])" + rb"(?:\s|#[^\n]*\n)+(\d{1,9})" * 3 + rb"\s", content)
    if head is None:
        raise unusable(file, "its head is damaged", "P5, width, height, largest grey, as map_saver writes them")
    width, height = _sized(file, int(head.group(2)), int(head.group(3)))
    largest, count = int(head.group(4)), width * height
    if not 0 < largest < 65536:
        raise unusable(file, f"its largest grey is {largest}", "1 to 65535, usually 255")
    body = content[head.end() :]
    if head.group(1) == b"2":
        found = _plain_greys(file, body, count, largest)
    elif largest < 256:
        found = body[:count].translate(bytes(min(value, largest) * 255 // largest for value in range(256)))
    else:
        values = (256 * high + low for high, low in zip(body[0 : 2 * count : 2], body[1 : 2 * count : 2]))
        found = bytes(min(value, largest) * 255 // largest for value in values)
    if len(found) < count:
        raise unusable(file, f"it ends after {len(found)} of {count} pixels", "copy it again")
    return found, width, height


def _plain_greys(file: Path, body: bytes, count: int, largest: int) -> bytes:
    """The greys that stand in words, so many or as many as there are."""
    found = bytearray()
    for token in re.finditer(rb"#[^\n]*|[^\s#]+", body):  # one by one: there may be millions
        word = token.group()
        if word[:1] == b"#":
            continue
        if len(found) == count:
            break
        if not word.isdigit() or len(word) > 5:
            raise unusable(file, "there is something that is no grey", f"numbers from 0 to {largest}")
        found.append(min(int(word), largest) * 255 // largest)
    return bytes(found)


def _sized(file: Path, width: int, height: int) -> Tuple[int, int]:
    if not width or not height or width * height > LARGEST:
        raise unusable(file, f"it has {width} times {height} pixels", f"1 to {LARGEST // 1_000_000} million pixels")
    return width, height


def _number(file: Path, data: Dict[str, Any], key: str, default: Optional[float] = None) -> float:
    value = data.get(key, default)
    if not _is_number(value):
        raise unusable(file, f"{key} is {'missing' if value is None else 'not a number'}", f"{key}: and a number")
    assert isinstance(value, (int, float))
    return float(value)


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value) and abs(value) < 1e6


def unusable(file: Path, what: str, expected: str) -> PursueError:
    """The error for a map that cannot be used (exit status 2)."""
    return PursueError([error("REP001", f"the map {file} cannot be used: {what}", hint=f"expected: {expected}")])
