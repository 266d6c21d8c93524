"""Only a whole PNG is a picture: of any kind, but not one that was cut off, damaged, or has too few pixels."""

from __future__ import annotations

import struct
import zlib
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime import png
from pursue_runtime.png import SIGNATURE, find_damage

BITS = {(0, 1): 1, (0, 2): 2, (0, 4): 4, (0, 8): 8, (0, 16): 16, (2, 8): 24, (2, 16): 48, (3, 1): 1, (3, 2): 2,
        (3, 4): 4, (3, 8): 8, (4, 8): 16, (4, 16): 32, (6, 8): 32, (6, 16): 64}
"""Bits of a pixel by type of colour and depth: table 11.1 of the PNG specification."""

ADAM7 = "1646264677777777565656567777777736463646777777775656565677777777"
"""The pass in which each pixel of eight by eight is sent: the figure of section 8.2."""


def chunk(kind: bytes, data: bytes = b"") -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def rows(width: int, height: int, bits: int, interlaced: bool) -> int:
    """The bytes of all rows: one for the filter, then the pixels, in whole bytes."""
    total = 0
    for number in "1234567" if interlaced else "1":
        for y in range(height):
            pixels = sum(not interlaced or ADAM7[y % 8 * 8 + x % 8] == number for x in range(width))
            total += 1 + (pixels * bits + 7) // 8 if pixels else 0
    return total


def picture(width: int, height: int, kind: Tuple[int, int] = (0, 8), interlaced: bool = False, less: int = 0) -> bytes:
    """A PNG, whose pixels are in two chunks, with another chunk between head and pixels."""
    pixels = zlib.compress(bytes(rows(width, height, BITS[kind], interlaced) - less))
    head = struct.pack(">IIBBBBB", width, height, kind[1], kind[0], 0, 0, interlaced)
    data = chunk(b"IDAT", pixels[:5]) + chunk(b"IDAT", pixels[5:])
    return SIGNATURE + chunk(b"IHDR", head) + chunk(b"tEXt", b"Title\0map") + data + chunk(b"IEND")


@given(st.integers(1, 20), st.integers(1, 20), st.sampled_from(sorted(BITS)), st.booleans())
def test_a_whole_picture_of_any_kind_has_no_damage_and_one_byte_less_is_too_little(
    width: int, height: int, kind: Tuple[int, int], interlaced: bool
) -> None:
    assert find_damage(picture(width, height, kind, interlaced)) == ""
    size = rows(width, height, BITS[kind], interlaced)
    assert find_damage(picture(width, height, kind, interlaced, 1)) == f"it has {size - 1} of {size} bytes of pixels"


def test_the_passes_of_an_interlaced_picture_have_the_pixels_of_each_size() -> None:
    for width in range(1, 18):
        for height in range(1, 18):
            size = rows(width, height, 8, interlaced=True)
            assert find_damage(picture(width, height, interlaced=True)) == "", (width, height)
            told = find_damage(picture(width, height, interlaced=True, less=1))
            assert told == f"it has {size - 1} of {size} bytes of pixels", (width, height)


def test_wherever_it_is_cut_off_it_is_no_picture() -> None:
    whole = picture(3, 2)
    for end in range(len(SIGNATURE), len(whole)):
        assert find_damage(whole[:end]) == f"it is cut off: it ends at byte {end}, before its end"
    assert find_damage(whole[:7]) == "it does not begin as a PNG does"


@given(st.data())
def test_a_bit_that_is_wrong_is_found(data: st.DataObject) -> None:
    damaged = bytearray(picture(5, 4, (2, 8)))
    damaged[data.draw(st.integers(0, len(damaged) - 1))] ^= 1 << data.draw(st.integers(0, 7))
    assert find_damage(bytes(damaged))


@pytest.mark.parametrize("head", [
    struct.pack(">IIBBBBB", 0, 3, 8, 0, 0, 0, 0), struct.pack(">IIBBBBB", 3, 0, 8, 0, 0, 0, 0),
    struct.pack(">IIBBBBB", 3, 3, 3, 0, 0, 0, 0), struct.pack(">IIBBBBB", 3, 3, 4, 2, 0, 0, 0),
    struct.pack(">IIBBBBB", 3, 3, 8, 1, 0, 0, 0), struct.pack(">IIBBBBB", 3, 3, 8, 0, 1, 0, 0),
    struct.pack(">IIBBBBB", 3, 3, 8, 0, 0, 1, 0), struct.pack(">IIBBBBB", 3, 3, 8, 0, 0, 0, 2),
    struct.pack(">IIBBBBBB", 3, 3, 8, 0, 0, 0, 0, 0), struct.pack(">IIBBBB", 3, 3, 8, 0, 0, 0), b"",
])  # fmt: skip
def test_a_head_that_says_of_no_picture_what_it_is(head: bytes) -> None:
    assert find_damage(SIGNATURE + chunk(b"IHDR", head) + chunk(b"IEND")).startswith("its head says of no picture")
    assert find_damage(SIGNATURE + chunk(b"IDAT", head) + chunk(b"IEND")).startswith("its head says of no picture")


def test_a_picture_may_be_as_large_as_the_largest(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(png, "LARGEST", 30)
    assert find_damage(picture(6, 5)) == ""
    assert find_damage(picture(31, 1)).startswith("its head says of no picture")


def test_pixels_that_cannot_be_unpacked_are_none() -> None:
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", 3, 3, 8, 0, 0, 0, 0))
    assert find_damage(SIGNATURE + head + chunk(b"IDAT", b"no") + chunk(b"IEND")).endswith("cannot be unpacked")
    assert find_damage(SIGNATURE + head + chunk(b"IEND")) == "it has 0 of 12 bytes of pixels"
