"""Whether a PNG is whole: what was cut off or damaged on its way is no picture."""

from __future__ import annotations

import struct
import zlib
from typing import Optional

SIGNATURE = b"\x89PNG\r\n\x1a\n"

LARGEST = 64_000_000
"""Pixels; more than any map that map_server was made for."""

_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # by type of colour: grey, RGB, palette, the first two with opacity
_DEPTHS = {0: (1, 2, 4, 8, 16), 2: (8, 16), 3: (1, 2, 4, 8), 4: (8, 16), 6: (8, 16)}
_PASSES = ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2))
"""First column and row, and steps, of the passes of an interlaced picture (PNG specification, section 8.2)."""
_PIECE = 1 << 20


def find_damage(content: bytes) -> str:
    """Why the bytes are no whole PNG of at most LARGEST pixels, "" where they are one.

    All chunks up to the last are there, with right checksums, and they hold all rows of pixels.
    """
    if not content.startswith(SIGNATURE):
        return "it does not begin as a PNG does"
    at, size, found, unpacker = len(SIGNATURE), None, 0, zlib.decompressobj()
    while True:
        length, kind = struct.unpack(">I4s", content[at : at + 8]) if at + 8 <= len(content) else (0, b"")
        end = at + 12 + length
        if not kind or end > len(content):
            return f"it is cut off: it ends at byte {len(content)}, before its end"
        if zlib.crc32(content[at + 4 : end - 4]) != int.from_bytes(content[end - 4 : end], "big"):
            return f"it is damaged between bytes {at + 1} and {end}"
        if size is None:
            size = _size(content[at + 8 : end - 4]) if kind == b"IHDR" else None
            if size is None:
                return "its head says of no picture how large it is, in which colours"
        elif kind == b"IDAT":
            try:
                found += _unpacked(unpacker, content[at + 8 : end - 4], size - found)
            except zlib.error:
                return f"its pixels between bytes {at + 1} and {end} cannot be unpacked"
        elif kind == b"IEND":
            return "" if found >= size else f"it has {found} of {size} bytes of pixels"
        at = end


def _size(head: bytes) -> Optional[int]:
    """The bytes of all rows; None for what is no head of a picture, or of one that is too large."""
    if len(head) != 13:
        return None
    width, height, depth, kind, packing, filtering, interlaced = struct.unpack(">IIBBBBB", head)
    if depth not in _DEPTHS.get(kind, ()) or packing or filtering or interlaced > 1:
        return None
    if not 0 < width * height <= LARGEST:
        return None
    bits = _CHANNELS[kind] * depth
    total = 0
    for column, row, across, down in _PASSES if interlaced else ((0, 0, 1, 1),):
        columns, rows = -((column - width) // across), -((row - height) // down)
        total += max(0, rows) * ((columns * bits + 7) // 8 + 1) if columns > 0 else 0
    return total


def _unpacked(unpacker: "zlib._Decompress", data: bytes, most: int) -> int:
    """How many bytes the data unpack to, counted up to `most`. Raises zlib.error."""
    count = 0
    while data and count < most:
        piece = unpacker.decompress(data, min(_PIECE, most - count))
        count += len(piece)
        data = unpacker.unconsumed_tail
        if not piece and unpacker.eof:
            break
    return count
