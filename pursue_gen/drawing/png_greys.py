"""The greys of a PNG: what map_server makes of an image, for the usual kinds."""

from __future__ import annotations

import struct
import zlib
from typing import Optional

_SIGNATURE = 8  # bytes
_CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # channels by type of colour: grey, RGB, both with opacity


def greys(png: bytes) -> Optional[bytes]:
    """A grey (0 to 255) for each pixel, row by row from the top; colours give their mean.

    None where the PNG is damaged, interlaced, has a palette, or other than eight bits per channel.
    """
    width, height, depth, kind, _, _, interlaced = struct.unpack(">IIBBBBB", png[16:29])
    if depth != 8 or interlaced or kind not in _CHANNELS:
        return None
    channels = _CHANNELS[kind]
    try:
        unpacker = zlib.decompressobj()
        size = height * (width * channels + 1)
        data = unpacker.decompress(_chunks(png, b"IDAT"), size)  # no more, whatever the file unpacks to
    except zlib.error:
        return None
    if len(data) < size or any(data[start] > 4 for start in range(0, size, width * channels + 1)):
        return None
    rows = []
    before = bytes(width * channels)
    for start in range(0, size, width * channels + 1):
        before = _unfiltered(data[start], data[start + 1 : start + 1 + width * channels], before, channels)
        rows.append(before if channels == 1 else _mean(before, channels))
    return b"".join(rows)


def _chunks(png: bytes, name: bytes) -> bytes:
    """The data of all chunks of this name."""
    at, found = _SIGNATURE, []
    while at + 8 <= len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        if png[at + 4 : at + 8] == name:
            found.append(png[at + 8 : at + 8 + length])
        at += length + 12
    return b"".join(found)


def _mean(row: bytes, channels: int) -> bytes:
    """The greys of a row of colours; opacity does not count."""
    colours = [row[channel::channels] for channel in range(1 if channels == 2 else 3)]
    return bytes(sum(one) // len(one) for one in zip(*colours))


def _unfiltered(kind: int, row: bytes, above: bytes, step: int) -> bytes:
    """A row as it was before it was filtered (PNG specification, section 9)."""
    if kind == 0:
        return row
    if kind == 2:
        return bytes((one + up) & 255 for one, up in zip(row, above))
    found = bytearray(row)
    for k, up in enumerate(above):
        left = found[k - step] if k >= step else 0
        corner = above[k - step] if k >= step else 0
        guess = {1: left, 3: (left + up) // 2}.get(kind)
        found[k] = (found[k] + (_paeth(left, up, corner) if guess is None else guess)) & 255
    return bytes(found)


def _paeth(left: int, up: int, corner: int) -> int:
    """The neighbour that is nearest to left + up - corner; the first of those that are equally near."""
    target = left + up - corner
    return min((left, up, corner), key=lambda one: abs(target - one))
