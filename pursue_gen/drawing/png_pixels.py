"""The pixels of a PNG, of the usual kinds."""

from __future__ import annotations

import re
import struct
import zlib
from functools import lru_cache
from typing import Iterator, Optional, Tuple

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
