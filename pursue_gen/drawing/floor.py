"""A floor plan of map_server: what its yaml file and its image say."""

from __future__ import annotations

import base64
import math
import re
import struct
import zlib
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Dict, Iterator, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.files import read_text, reason_of
from pursue_runtime.bounded import SETTINGS, BadText, read_yaml
from pursue_runtime.named_files import read_all
from pursue_runtime.png import LARGEST, SIGNATURE, find_damage

_LARGEST_FILE = 160 << 20
"""Bytes: so many pixels of 16 bits, and more."""

_MODES = ("trinary", "scale", "raw")

class _OnMap:
    """An image on the map (in metres), turned by `yaw` (radians): `x`, `y` is its lower left corner."""

    resolution: float
    x: float
    y: float
    yaw: float

    def metres(self, across: float, up: float) -> Tuple[float, float]:
        """The point of the map so many pixels from the lower left corner; of arrays for arrays."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        across, up = across * self.resolution, up * self.resolution
        return self.x + cos * across - sin * up, self.y + sin * across + cos * up

    def pixels(self, x: float, y: float) -> Tuple[float, float]:
        """How many pixels from the lower left corner a point of the map is: across, and up."""
        cos, sin = math.cos(self.yaw), math.sin(self.yaw)
        x, y = x - self.x, y - self.y
        return (cos * x + sin * y) / self.resolution, (cos * y - sin * x) / self.resolution


@dataclass(frozen=True)
class Floor(_OnMap):
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
        ends = ((0, 0), (self.width, 0), (self.width, self.height), (0, self.height))
        return tuple(self.metres(*end) for end in ends)


@dataclass(frozen=True)
class MapSettings(_OnMap):
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


_SIGNATURE = 8  # bytes
_CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # channels by type of colour: grey, RGB, both with opacity

_NOT_ZERO = re.compile(rb"[^\0]")


def pixels(png: bytes) -> Optional[Tuple[int, Tuple[bytes, ...]]]:
    """The channels of a pixel (1: grey, 2: grey and opacity, 3: RGB, 4: RGB and opacity), and the rows from the top,
    with a byte for each channel of each pixel.

    None where the PNG is damaged, interlaced, has a palette or a transparent grey, or other than 8 bits per channel.
    """
    width, height, depth, kind, _, _, interlaced = struct.unpack(">IIBBBBB", png[16:29])
    if depth != 8 or interlaced or kind not in _CHANNELS or (kind == 0 and _chunks(png, b"tRNS")):
        return None
    channels = _CHANNELS[kind]
    size = width * channels + 1
    try:
        unpacker = zlib.decompressobj()
        data = unpacker.decompress(_chunks(png, b"IDAT"), height * size)  # no more, whatever the file unpacks to
    except zlib.error:
        return None
    if len(data) < height * size or any(data[start] > 4 for start in range(0, height * size, size)):
        return None
    return channels, tuple(_rows(data, size, channels))


def _rows(data: bytes, size: int, channels: int) -> Iterator[bytes]:
    before = bytes(size - 1)
    for start in range(0, len(data), size):
        before = _unfiltered(data[start], data[start + 1 : start + size], before, channels)
        yield before


def _chunks(png: bytes, name: bytes) -> bytes:
    """The data of all chunks of this name."""
    at, found = _SIGNATURE, []
    while at + 8 <= len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        if png[at + 4 : at + 8] == name:
            found.append(png[at + 8 : at + 8 + length])
        at += length + 12
    return b"".join(found)


def _unfiltered(kind: int, row: bytes, above: bytes, step: int) -> bytes:
    """A row as it was before it was filtered (PNG specification, section 9)."""
    if kind == 0:
        return row
    if kind == 1:
        return _running(row, step)
    if kind == 2:
        return _sum(int.from_bytes(row, "little"), int.from_bytes(above, "little"), len(row)).to_bytes(
            len(row), "little"
        )
    if kind == 4:
        return _unpredicted(row, above, step)
    found = bytearray(row)
    for k, up in enumerate(above):
        left = found[k - step] if k >= step else 0
        found[k] = (found[k] + (left + up) // 2) & 255
    return bytes(found)


def _unpredicted(row: bytes, above: bytes, step: int) -> bytes:
    """A row of which each byte was predicted from its neighbours (Paeth)."""
    found = bytearray(row)
    k = 0
    while k < len(row):
        if not row[k] and found[max(0, k - step) : k] == above[max(0, k - step) : k]:
            other = _NOT_ZERO.search(row, k)  # as the row above, up to there
            end = len(row) if other is None else other.start()
            found[k:end] = above[k:end]
            k = end
            continue
        left, corner = (found[k - step], above[k - step]) if k >= step else (0, 0)
        found[k] = (row[k] + _paeth(left, above[k], corner)) & 255
        k += 1
    return bytes(found)


def _running(row: bytes, step: int) -> bytes:
    """The sum of each byte with all bytes of its channel before it."""
    size = len(row)
    found, shift, whole = int.from_bytes(row, "little"), step, (1 << 8 * size) - 1
    while shift < size:
        found = _sum(found, found << 8 * shift & whole, size)
        shift *= 2
    return found.to_bytes(size, "little")


def _sum(a: int, b: int, size: int) -> int:
    """The sum of so many bytes each, without what is carried from one to the next."""
    low, high = _masks(size)
    return (a & low) + (b & low) ^ (a ^ b) & high


@lru_cache(maxsize=8)
def _masks(size: int) -> Tuple[int, int]:
    """Seven bits, and the eighth one, of so many bytes."""
    return int.from_bytes(b"\x7f" * size, "little"), int.from_bytes(b"\x80" * size, "little")


def _paeth(left: int, up: int, corner: int) -> int:
    """The neighbour that is nearest to left + up - corner; the first of those that are equally near."""
    by_left, by_up, by_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
    if by_left <= by_up and by_left <= by_corner:
        return left
    return up if by_up <= by_corner else corner
