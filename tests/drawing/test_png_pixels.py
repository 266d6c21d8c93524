"""The pixels of PNGs."""

from __future__ import annotations

import struct
import zlib
from typing import Callable, List, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.drawing.floor import pixels


def png(rows: List[bytes], width: int, kind: int, depth: int = 8) -> bytes:
    """A PNG of rows that begin with their filter."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, len(rows), depth, kind, 0, 0, 0)
    packed = zlib.compress(b"".join(rows))
    middle = len(packed) // 2
    parts = chunk(b"IDAT", packed[:middle]) + chunk(b"IDAT", packed[middle:])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + parts + chunk(b"IEND", b"")


def predicted(kind: int) -> Callable[[int, int, int], int]:
    """What each filter subtracts from a byte, as the specification has it."""

    def paeth(a: int, b: int, c: int) -> int:
        p = a + b - c
        pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
        return a if pa <= pb and pa <= pc else b if pb <= pc else c

    plain = {0: lambda a, b, c: 0, 1: lambda a, b, c: a, 2: lambda a, b, c: b, 3: lambda a, b, c: (a + b) // 2}
    return plain.get(kind, paeth)


def filtered(kind: int, row: bytes, above: bytes, step: int) -> bytes:
    guess = predicted(kind)
    left = bytes(step) + row[:-step]
    corner = bytes(step) + above[:-step]
    return bytes([kind]) + bytes((x - guess(a, b, c)) % 256 for x, a, b, c in zip(row, left, above, corner))


@given(st.data(), st.integers(1, 9), st.integers(1, 5), st.sampled_from([(0, 1), (2, 3), (4, 2), (6, 4)]))
def test_every_filter_gives_back_the_rows(data: st.DataObject, width: int, height: int, form: Tuple[int, int]) -> None:
    kind, channels = form
    size = width * channels
    runs = st.lists(st.sampled_from([0, 0, 0, 254]), min_size=size, max_size=size).map(bytes)  # as floors have them
    rows = [data.draw(runs | st.binary(min_size=size, max_size=size)) for _ in range(height)]
    filters = [data.draw(st.integers(0, 4)) for _ in rows]
    above = [bytes(width * channels), *rows]
    coded = [filtered(f, row, up, channels) for f, row, up in zip(filters, rows, above)]
    found = pixels(png(coded, width, kind))
    assert found is not None and (found[0], list(found[1])) == (channels, rows)


def test_other_kinds_and_damaged_ones_have_no_pixels() -> None:
    row = b"\x00\x07\x07"
    found = pixels(png([row], 2, 0))
    assert found is not None and list(found[1]) == [b"\x07\x07"]
    assert pixels(png([row], 2, 3)) is None and pixels(png([row], 2, 0, depth=4)) is None
    assert pixels(png([b"\x00\x07"], 2, 0)) is None and pixels(png([b"\x05\x07\x07"], 2, 0)) is None
    assert pixels(png([row], 2, 0).replace(b"IDAT", b"none")) is None
    assert pixels(png([row], 2, 0)[:45]) is None
    transparent = png([row], 2, 0).replace(b"\0\0\0\0IEND", b"\0\0\0\2tRNS\0\7crc.\0\0\0\0IEND")
    assert pixels(transparent) is None, "map_server's library makes two channels of this"
