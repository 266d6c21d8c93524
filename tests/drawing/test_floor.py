"""Floor plans of map_server: what can be used is used as it is, what cannot is said, with what to do."""

from __future__ import annotations

import base64
import struct
import zlib
from fractions import Fraction
from pathlib import Path
from typing import List, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.floor_picture import read_floor
from pursue_gen.drawing.ground import read_ground

GOOD = "image: floor.pgm\nresolution: 0.05\norigin: [-1.0, 2.0, 0.0]\nnegate: 0\n"


def plan(folder: Path, image: bytes, text: str = GOOD, name: str = "floor.pgm") -> Floor:
    (folder / name).write_bytes(image)
    (folder / "map.yaml").write_text(text)
    return read_floor(folder / "map.yaml")


def greys(floor: Floor) -> Tuple[int, int, List[int]]:
    """What is in the PNG that we write: one grey byte per pixel, rows without a filter."""
    content = base64.b64decode(floor.uri.split(",")[1])
    width, height = struct.unpack(">II", content[16:24])
    place = content.index(b"IDAT")
    (length,) = struct.unpack(">I", content[place - 4 : place])
    rows = zlib.decompress(content[place + 4 : place + 4 + length])
    return width, height, [b for k in range(height) for b in rows[k * (width + 1) + 1 : (k + 1) * (width + 1)]]


def test_a_map_of_map_saver_is_taken_pixel_by_pixel(tmp_path: Path) -> None:
    floor = plan(tmp_path, b"P5\n# CREATOR: map_saver 0.050 m/pix\n3 2\n255\n" + bytes([0, 205, 254, 10, 35, 13]))
    assert greys(floor) == (3, 2, [0, 205, 254, 10, 35, 13])
    assert (floor.resolution, floor.x, floor.y, floor.yaw) == (0.05, -1.0, 2.0, 0.0)
    corners = [number for corner in floor.corners() for number in corner]
    assert corners == pytest.approx([-1, 2, -0.85, 2, -0.85, 2.1, -1, 2.1])


@pytest.mark.parametrize(
    "image",
    [
        b"P2\n3 2 # plain\n4\n0 1 2\n# and\n2 3 4\n",
        b"P5 3 2 65535 " + struct.pack(">6H", 0, 16384, 32768, 32768, 49152, 65535),
    ],
)
def test_other_depths_become_eight_bits(tmp_path: Path, image: bytes) -> None:
    assert greys(plan(tmp_path, image))[2] == [0, 63, 127, 127, 191, 255]


def test_a_png_is_embedded_as_it_is(tmp_path: Path) -> None:
    made = plan(tmp_path, b"P5 1 1 255 \x07")
    content = base64.b64decode(made.uri.split(",")[1])
    again = plan(tmp_path, content, GOOD.replace("floor.pgm", "floor.png"), "floor.png")
    assert again == made


def png(width: int, height: int, depth: int, kind: int, rows: bytes, interlaced: int = 0) -> bytes:
    """A PNG of these rows, each with its filter before it."""

    def chunk(name: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    head = struct.pack(">IIBBBBB", width, height, depth, kind, 0, 0, interlaced)
    palette = chunk(b"PLTE", bytes(6)) if kind == 3 else b""
    packed = zlib.compress(rows)
    halves = (packed[: len(packed) // 2], packed[len(packed) // 2 :])
    pixels = b"".join(chunk(b"IDAT", half) for half in halves)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + palette + pixels + chunk(b"IEND", b"")


PICTURES = {
    "grey": png(3, 2, 8, 0, bytes(8)),
    "grey of 16 bits": png(3, 2, 16, 0, bytes(14)),
    "colours": png(3, 2, 8, 2, bytes(20)),
    "colours with opacity": png(3, 2, 8, 6, bytes(26)),
    "a palette": png(3, 2, 1, 3, bytes(4)),
    "interlaced": png(3, 2, 8, 0, bytes(11), 1),  # passes of 1, 1, 1 and 3 pixels: 2 + 2 + 3 + 4 bytes
}


@pytest.mark.parametrize("name", PICTURES)
def test_a_png_is_used_whole_or_not_at_all(tmp_path: Path, name: str) -> None:
    content = PICTURES[name]
    assert plan(tmp_path, content).width == 3
    for end in range(8, len(content)):
        with pytest.raises(PursueError, match="damaged PNG") as problem:
            plan(tmp_path, content[:end])
        assert problem.value.diagnostics[0].hint
    for place in range(8, len(content)):
        with pytest.raises(PursueError, match="cannot be used"):
            plan(tmp_path, content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :])


@pytest.mark.parametrize("name", PICTURES)
def test_a_png_without_some_of_its_pixels_is_damaged(tmp_path: Path, name: str) -> None:
    content = PICTURES[name]
    second = content.rindex(b"IDAT") - 4
    with pytest.raises(PursueError, match="bytes of pixels"):
        plan(tmp_path, content[:second] + content[content.rindex(b"IEND") - 4 :])


@pytest.mark.parametrize(
    ("text", "image", "told"),
    [
        (GOOD.replace("0.05", "fast"), b"P5 1 1 255 \x07", "resolution is not a number"),
        (GOOD.replace("0.05", "-1"), b"P5 1 1 255 \x07", "resolution is -1"),
        (GOOD.replace("resolution: 0.05\n", ""), b"P5 1 1 255 \x07", "resolution is missing"),
        (GOOD.replace("[-1.0, 2.0, 0.0]", "[1, 2]"), b"P5 1 1 255 \x07", "origin is not a list"),
        (GOOD.replace("[-1.0, 2.0, 0.0]", "[.inf, 2, 0]"), b"P5 1 1 255 \x07", "origin is not a list"),
        (GOOD.replace("image: floor.pgm", "image: 3"), b"", "image is missing"),
        (GOOD.replace("floor.pgm", "none.pgm"), b"", "cannot be read"),
        ("- a\n- b\n", b"", "no settings"),
        ("image: [\n", b"", "not YAML"),
        (GOOD, b"GIF89a", "neither PGM nor PNG"),
        (GOOD, b"P5 2 2 255 \x07", "ends after 1 of 4 pixels"),
        (GOOD, b"P5 2 0 255 \x07", "2 times 0 pixels"),
        (GOOD, b"P5 99999 99999 255 \x07", "million pixels"),
        (GOOD, b"P5 2 2 0 \x07\x07\x07\x07", "largest grey is 0"),
        (GOOD, b"P2 1 1 255 x", "no grey"),
        (GOOD, b"P5\n2", "head is damaged"),
        (GOOD, b"\x89PNG\r\n\x1a\nshort", "damaged PNG"),
    ],
)
def test_bad_maps_are_reported_with_the_file_and_what_was_expected(
    tmp_path: Path, text: str, image: bytes, told: str
) -> None:
    with pytest.raises(PursueError) as problem:
        plan(tmp_path, image, text)
    finding = problem.value.diagnostics[0]
    assert told in f"{finding.message}; {finding.hint}"
    assert str(tmp_path) in finding.message and problem.value.exit_status == 2


@settings(suppress_health_check=list(HealthCheck), deadline=None)
@given(
    st.binary(max_size=60),
    st.sampled_from([b"", b"P5 ", b"P2 3 1 9 ", b"P5 2 2 255 ", b"\x89PNG\r\n\x1a\n"]),
    st.text(max_size=30),
)
def test_whatever_the_files_hold_there_is_a_plan_or_a_message(
    tmp_path: Path, rest: bytes, head: bytes, more: str
) -> None:
    for text in (GOOD, GOOD + more):
        try:
            floor = plan(tmp_path, head + rest, "".join(c for c in text if not "\ud800" <= c <= "\udfff"))
        except PursueError as problem:
            assert problem.diagnostics[0].hint
        else:
            assert floor.width * floor.height > 0


def shown(folder: Path, rows: List[str], text: str = GOOD, most: int = 1200) -> Tuple[Floor, List[str]]:
    """The floor plan of a drawing (`#` a wall, `.` free, `?` unknown; cells of 0.5 m), and its picture as one."""
    shades = {"#": 0, ".": 254, "?": 205}
    image = b"P5 %d %d 255\n" % (len(rows[0]), len(rows)) + bytes(shades[one] for row in rows for one in row)
    (folder / "floor.pgm").write_bytes(image)
    (folder / "map.yaml").write_text(text.replace("0.05", "0.5"))
    floor = read_floor(folder / "map.yaml", most)
    width, height, found = greys(floor)
    assert (width, height) == (floor.width, floor.height)
    signs = "".join({0: "#", 254: ".", 205: "?"}[one] for one in found)
    return floor, [signs[k : k + width] for k in range(0, len(signs), width)]


def test_unknown_ground_around_what_is_known_is_left_out(tmp_path: Path) -> None:
    rows = ["?" * 9, "?" * 9, "????#.???", "????..???", "?" * 9, "?" * 9, "?" * 9]
    floor, found = shown(tmp_path, rows)
    assert found == ["????", "?#.?", "?..?", "????"], "half a metre of it stays"
    assert (floor.x, floor.y, floor.resolution) == (-1 + 3 * 0.5, 2 + 2 * 0.5, 0.5)
    turned, _ = shown(tmp_path, rows, GOOD.replace("2.0, 0.0", "2.0, 1.5707963267948966"))
    assert (turned.x, turned.y) == pytest.approx((-1 - 2 * 0.5, 2 + 3 * 0.5))
    floor, found = shown(tmp_path, ["??", "??"])
    assert found == ["??", "??"], "all of it where nothing is known"


def test_walls_of_one_pixel_are_seen_on_a_picture_that_is_smaller_than_the_map(tmp_path: Path) -> None:
    rows = ["....#..", "....#..", "....#..", ".......", "##?...."]
    floor, found = shown(tmp_path, rows, most=4)
    assert found == ["..#.", "..#.", "#?.."]
    assert (floor.x, floor.y, floor.resolution) == (-1, 2 - 0.5, 1.0), "what is missing below is empty"
    rows = [row.translate(str.maketrans("#.", ".#")) for row in rows]
    _, found = shown(tmp_path, rows[:4], GOOD.replace("negate: 0", "negate: 1"), 4)
    assert found == ["##.#", "##.#"], "bright is a wall there"


def test_colours_stay_and_squares_of_them_become_the_darkest(tmp_path: Path) -> None:
    pixels = bytes([9, 200, 30, 8, 210, 40, 254, 254, 254, 254, 254, 254])
    floor = plan(tmp_path, png(4, 1, 8, 2, b"\0" + pixels))
    assert floor.picture == png_of(4, 1, 2, b"\0" + pixels) and (floor.width, floor.height) == (4, 1)
    small = read_floor(tmp_path / "map.yaml", 2)
    assert small.picture == png_of(2, 1, 2, b"\0" + bytes([8, 200, 30, 254, 254, 254])) and small.resolution == 0.1


def png_of(width: int, height: int, kind: int, rows: bytes) -> bytes:
    """A PNG as this program writes it: all pixels in one chunk."""
    content = png(width, height, 8, kind, rows)
    first = content.index(b"IDAT") - 4
    packed = zlib.compress(rows, 9)
    chunk = struct.pack(">I", len(packed)) + b"IDAT" + packed + struct.pack(">I", zlib.crc32(b"IDAT" + packed))
    return content[:first] + chunk + content[content.index(b"IEND") - 4 :]


# The ground -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mode", "kinds"),
    [
        ("mode: trinary\n", "ouuf"),
        ("mode: scale\n", "ouuf"),
        ("mode: raw\n", "fouu"),
        ("", "ouuf"),
    ],
)
def test_what_a_grey_means_depends_on_the_mode(tmp_path: Path, mode: str, kinds: str) -> None:
    (tmp_path / "floor.pgm").write_bytes(b"P5 4 1 255 " + bytes([0, 100, 40 if "raw" in mode else 205, 255]))
    (tmp_path / "map.yaml").write_text(GOOD + mode)
    ground = read_ground(tmp_path / "map.yaml", whole=True)
    found = [ground.at(-1 + 0.05 * (column + 0.5), 2.01) for column in range(4)]
    assert "".join(kind[0] for kind in found) == kinds
    assert ground.free_pixels() == bytes(kind == "f" for kind in kinds)


def as_map_server(pixel: Tuple[int, ...], mode: str, negate: bool, occupied: float, free: float) -> str:
    """What map_server 1.17 makes of a pixel, written down from its documentation and its source; `u` for all between.

    A picture of grey and opacity comes to it as RGB with opacity.
    """
    channels = (pixel[0],) * 3 + pixel[1:] if len(pixel) == 2 else pixel
    if len(channels) == 4 and mode != "trinary":
        channels = channels[:3]
    mean = Fraction(sum(channels), len(channels))
    level = 255 - mean if negate else mean
    if mode == "raw":
        value = int(level)
        return "u" if value == 255 else "o" if value > 100 * occupied else "f" if value < 100 * free else "u"
    darkness = (255 - level) / 255
    return "o" if darkness > Fraction(occupied) else "f" if darkness < Fraction(free) else "u"


SHADES = (0, 13, 63, 64, 89, 90, 100, 128, 190, 204, 205, 206, 254, 255)
KINDS = {0: 1, 4: 2, 2: 3, 6: 4}
"""Types of PNG → channels."""


@pytest.mark.parametrize("negate", [0, 1])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
@pytest.mark.parametrize("kind", KINDS)
def test_pictures_are_read_as_map_server_reads_them(tmp_path: Path, kind: int, mode: str, negate: int) -> None:
    channels = KINDS[kind]
    several = {1: [(a,) for a in range(256)], 2: [(a, b) for a in SHADES for b in SHADES]}
    colours = [(a, a, a) for a in range(256)] + [(a, b, c) for a in SHADES for b in SHADES for c in (0, 205, 255)]
    several.update({3: colours, 4: [(*one, opacity) for one in colours for opacity in (255, 0, 127)]})
    pixels = several[channels]
    rows = b"".join(b"\0" + bytes(pixel) for pixel in pixels)  # a pixel in each row
    wide = b"\0" + bytes(value for pixel in pixels for value in pixel)  # and all in one
    for width, height, data in ((1, len(pixels), rows), (len(pixels), 1, wide)):
        (tmp_path / "floor.pgm").write_bytes(png(width, height, 8, kind, data))
        (tmp_path / "map.yaml").write_text(GOOD.replace("negate: 0", f"negate: {negate}") + f"mode: {mode}\n")
        ground = read_ground(tmp_path / "map.yaml", whole=True)
        cells = [(k, 0) if height == 1 else (0, k) for k in range(len(pixels))]
        found = "".join(ground.at(*ground.middle(*cell))[0] for cell in cells)
        assert found == "".join(as_map_server(pixel, mode, bool(negate), 0.65, 0.196) for pixel in pixels)
        assert ground.free_pixels() == bytes(kind == "f" for kind in found)


def test_what_is_opaque_is_free_nowhere_where_opacity_counts_and_bright_is_occupied(tmp_path: Path) -> None:
    (tmp_path / "floor.pgm").write_bytes(png(2, 1, 8, 6, b"\0" + bytes([0, 0, 0, 255, 0, 0, 0, 0])))
    (tmp_path / "map.yaml").write_text(GOOD.replace("negate: 0", "negate: 1"))
    assert read_ground(tmp_path / "map.yaml").free_pixels() == b"\0\1"


def test_a_mode_that_map_server_does_not_know_is_reported(tmp_path: Path) -> None:
    with pytest.raises(PursueError) as problem:
        plan(tmp_path, b"P5 1 1 255 \x07", GOOD + "mode: colour\n")
    assert "mode" in problem.value.diagnostics[0].message and "scale" in problem.value.diagnostics[0].hint


def test_pixels_that_are_not_known_are_free_unless_they_are_needed(tmp_path: Path) -> None:
    (tmp_path / "floor.pgm").write_bytes(png(1, 1, 8, 3, bytes(2)))
    (tmp_path / "map.yaml").write_text(GOOD)
    ground = read_ground(tmp_path / "map.yaml")
    assert ground.free_pixels() is None and ground.at(-0.99, 2.01) == "free"
    with pytest.raises(PursueError, match="pixels cannot be read"):
        read_ground(tmp_path / "map.yaml", whole=True)
