"""Where the centre of a robot may be: as far from obstacles as its radius, whatever the map's origin."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import List, Tuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.survey.grid import grid_of
from tests.survey.maps import FREE, UNKNOWN, WALL, cells, drawn, ground_of

GREYS = st.integers(2, 9).flatmap(
    lambda width: st.lists(
        st.lists(st.sampled_from([FREE] * 5 + [WALL, UNKNOWN]), min_size=width, max_size=width), min_size=2, max_size=9
    )
)


@settings(deadline=None)
@given(GREYS, st.sampled_from([0.0, 0.5, 1.0, 1.5, 2.3, 7.0]))
def test_a_cell_is_free_where_no_obstacle_is_within_the_radius(rows: List[List[int]], radius: float) -> None:
    greys = np.array(rows, dtype=np.uint8)
    grid = grid_of(ground_of(greys, 1.0), radius)
    height, width = greys.shape
    reach = range(-8, 9)
    for row in range(height):
        for column in range(width):
            around = [(row + i, column + j) for i in reach for j in reach if math.hypot(i, j) <= radius or i == j == 0]
            expected = all(0 <= y < height and 0 <= x < width and greys[y, x] == FREE for y, x in around)
            assert grid.is_free((column + 0.5 - grid.column, row + 0.5 - grid.row)) == expected, (row, column)


def test_a_radius_of_whole_cells_is_one_whatever_their_size() -> None:
    for resolution in (0.05, 0.1, 0.3, 1.0):
        free = grid_of(ground_of(drawn((20 * resolution,) * 2, [], resolution=resolution), resolution), 3 * resolution)
        assert int(free.free.sum()) == 12 * 12


def test_a_map_without_free_ground_has_no_free_cell() -> None:
    grid = grid_of(ground_of(np.full((3, 3), UNKNOWN, dtype=np.uint8)), 0.1)
    assert not grid.free.any() and not grid.is_free((0.5, 0.5))
    assert not grid_of(ground_of(drawn((2, 2), [])), 5.0).free.any()


@pytest.mark.parametrize("yaw", [0.0, 0.3, math.pi / 2, -2.5])
def test_points_of_the_map_are_found_again_whatever_its_origin(yaw: float) -> None:
    greys = drawn((4, 3), [(1, 1, 2, 2)])
    grid = grid_of(ground_of(greys, 0.05, (10.0, -20.0, yaw)), 0.2)
    for x, y, is_free in ((0.5, 0.5, True), (1.5, 1.5, False), (0.9, 1.5, False), (2.5, 2.5, True), (3.95, 1, False)):
        turned = 10 + math.cos(yaw) * x - math.sin(yaw) * y, -20 + math.sin(yaw) * x + math.cos(yaw) * y
        assert grid.is_free(grid.cell(*turned)) == is_free
        assert grid.metres(grid.cell(*turned)) == pytest.approx(turned)
    assert not grid.is_free(grid.cell(1000, 1000))


ROWS = ["########", "#......#", "#..#...#", "#.##...#", "#......#", "#....#.#", "########"]
FREE_CELLS = [(column, len(ROWS) - 1 - k) for k, row in enumerate(ROWS) for column in range(8) if row[column] == "."]
INSIDE = st.tuples(st.sampled_from(FREE_CELLS), st.sampled_from([1, 5, 8, 11, 15]), st.sampled_from([1, 5, 8, 11, 15]))


def touches(a: Tuple[Fraction, Fraction], b: Tuple[Fraction, Fraction], cell: Tuple[int, int]) -> bool:
    """Does the line touch the square, corners included? (Liang and Barsky)"""
    low, high = Fraction(0), Fraction(1)
    for axis in (0, 1):
        step, side = b[axis] - a[axis], cell[axis]
        if step == 0:
            if not side <= a[axis] <= side + 1:
                return False
            continue
        ends = sorted(((side - a[axis]) / step, (side + 1 - a[axis]) / step))
        low, high = max(low, ends[0]), min(high, ends[1])
    return low <= high


@given(INSIDE, INSIDE)
def test_points_see_each_other_where_every_cell_that_the_line_touches_is_free(
    one: Tuple[Tuple[int, int], int, int], other: Tuple[Tuple[int, int], int, int]
) -> None:
    grid = cells(ROWS)
    a, b = (tuple(Fraction(side * 16 + part, 16) for side, part in zip(c, parts)) for c, *parts in (one, other))
    walls = [(column, row) for row in range(7) for column in range(8) if (column, row) not in FREE_CELLS]
    expected = not any(touches((a[0], a[1]), (b[0], b[1]), cell) for cell in walls)
    shifted = [(float(x) - grid.column, float(y) - grid.row) for x, y in (a, b)]
    assert grid.sees(*shifted) == grid.sees(*shifted[::-1]) == expected
