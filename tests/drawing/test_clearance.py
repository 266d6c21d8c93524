"""Room for a robot on a map: distances from obstacles, and the nearest point at which there is room."""

from __future__ import annotations

import math
from pathlib import Path
from typing import List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.drawing.floor import MapSettings
from pursue_gen.drawing.ground import Clearance, Ground, cells_of

ROWS = st.integers(1, 9).flatmap(
    lambda width: st.lists(st.lists(st.sampled_from("....#?"), min_size=width, max_size=width), min_size=1, max_size=9)
)
POINTS = st.tuples(st.integers(-2, 10), st.integers(-2, 10))


def ground(rows: List[List[str]], yaw: float = 0.0) -> Ground:
    """The first row is the lowest one; cells of 0.5 m."""
    greys = {".": 254, "#": 0, "?": 205}
    place = MapSettings(Path("map.pgm"), 0.5, 3.0, -1.0, yaw, False, 0.65, 0.196, "trinary")
    cells = cells_of(place, 1, [bytes(greys[one] for one in row) for row in rows[::-1]])
    return Ground(place, len(rows[0]), len(rows), cells)


def apart(rows: List[List[str]], cell: Tuple[int, int]) -> float:
    """Metres between the centres of a cell and of the nearest one that is not free; around the map none is."""
    height, width = len(rows), len(rows[0])
    around = [(i, j) for i in range(-1, width + 1) for j in range(-1, height + 1)]
    blocked = [(i, j) for i, j in around if not (0 <= i < width and 0 <= j < height and rows[j][i] == ".")]
    inside = 0 <= cell[0] < width and 0 <= cell[1] < height
    return min(0.5 * math.dist(cell, one) for one in blocked) if inside else 0.0


@settings(deadline=None)
@given(ROWS, POINTS, st.sampled_from([0.4, 1.0, 1.7, 9.0]), st.sampled_from([0.0, 0.7]))
def test_the_distance_is_that_to_the_nearest_cell_that_is_not_free(
    rows: List[List[str]], cell: Tuple[int, int], most: float, yaw: float
) -> None:
    floor = ground(rows, yaw)
    x, y = floor.middle(cell[0], len(rows) - 1 - cell[1])
    assert Clearance(floor).metres(x, y, most) == pytest.approx(min(most, apart(rows, cell)))


@settings(deadline=None)
@given(ROWS, POINTS, st.sampled_from([0.0, 0.5, 0.8, 1.5]), st.integers(0, 3))
def test_the_nearest_point_with_room_is_found(
    rows: List[List[str]], cell: Tuple[int, int], radius: float, column: int
) -> None:
    floor = ground(rows)
    x, y = floor.middle(cell[0], len(rows) - 1 - cell[1])
    cells = [(i, j) for i in range(column, len(rows[0])) for j in range(len(rows)) if apart(rows, (i, j)) > radius]
    found = Clearance(floor).nearest(x, y, radius, 5.0, lambda point: point[0] > 3.0 + 0.5 * column)
    near = [0.5 * math.dist(cell, one) for one in cells if 0.5 * math.dist(cell, one) <= 5]
    assert (found is None) == (not near)
    if found is not None:
        assert math.dist(found, (x, y)) == pytest.approx(min(near))
        assert floor.pixel(*found) in [(i, len(rows) - 1 - j) for i, j in cells]


def test_a_point_far_off_the_map_has_no_room_near_it() -> None:
    rows = [["."] * 9] * 9
    there = Clearance(ground(rows))
    assert there.nearest(1e6, -1e6, 0.3, 5.0) is None and there.metres(1e6, 0, 1) == 0
