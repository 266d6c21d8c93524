"""Paths on maps: they can be driven, are no longer than those of a plain search, and doors do not vanish."""

from __future__ import annotations

import heapq
import itertools
import math
from typing import Dict, List, Optional, Tuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.survey.graph import graph_of
from pursue_gen.survey.grid import Grid, grid_of
from pursue_gen.survey.routes import Route, Routes
from tests.survey.maps import FREE, WALL, drawn, ground_of, three_rooms

NEXT = (0.0, -1e-6, 1e-6)  # cells: a path may touch a corner
OCTILE = 1.0824  # by how much paths in eight directions are longer than straight ones at most


def plain(grid: Grid, start: Tuple[int, int], strict: bool) -> Dict[Tuple[int, int], float]:
    """Dijkstra's lengths in eight directions. Diagonals need both cells beside them to be free, or one of them."""
    best, queue = {start: 0.0}, [(0.0, start)]
    while queue:
        done, (x, y) = heapq.heappop(queue)
        for i, j in itertools.product((-1, 0, 1), repeat=2):
            beside = [grid.is_free((x + i, y)), grid.is_free((x, y + j))]
            far = done + math.hypot(i, j)
            may = grid.is_free((x + i, y + j)) and (all if strict else any)(beside)
            if may and far < best.get((x + i, y + j), math.inf):
                best[x + i, y + j] = far
                heapq.heappush(queue, (far, (x + i, y + j)))
    return best


def check(grid: Grid, route: Route) -> None:
    """The path can be driven, and is as long as it says."""
    points = [grid.cell(*bend) for bend in route.bends]
    for a, b in zip(points, points[1:]):
        for share in np.linspace(0, 1, 2 + math.ceil(math.dist(a, b) / 0.1)):
            x, y = a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
            assert any(grid.is_free((x + i, y + j)) for i in NEXT for j in NEXT), (a, b)
    assert route.length == pytest.approx(sum(math.dist(a, b) for a, b in zip(route.bends, route.bends[1:])))
    assert route.length >= math.dist(route.bends[0], route.bends[-1]) - 1e-9


MAPS = st.integers(3, 10).flatmap(
    lambda width: st.lists(
        st.lists(st.sampled_from([FREE, FREE, FREE, WALL]), min_size=width, max_size=width), min_size=3, max_size=10
    )
)


@settings(deadline=None, max_examples=40)
@given(MAPS, st.data())
def test_paths_are_bounded_by_those_of_a_plain_search(rows: List[List[int]], data: st.DataObject) -> None:
    grid = grid_of(ground_of(np.array(rows, dtype=np.uint8), 1.0), 0.0)
    free = [(int(x), int(y)) for y, x in np.argwhere(grid.free)]
    if not free:
        return
    a, b, c = (data.draw(st.sampled_from(free)) for _ in range(3))
    points = [grid.metres((x + 0.5, y + 0.5)) for x, y in (a, b, c)]
    fine, coarse = (Routes(graph_of(grid, nodes), points) for nodes in (10**6, max(1, len(free) // 9)))
    upper, lower = plain(grid, a, True).get(b), plain(grid, a, False).get(b)
    found: Dict[Tuple[int, int], Optional[Route]] = {}
    for i, j in itertools.permutations(range(3), 2):
        found[i, j] = fine.route(points[i], points[j])
        large = coarse.route(points[i], points[j])
        assert (large is None) == (found[i, j] is None)
        for route in (large, found[i, j]):
            if route is not None:
                check(grid, route)
    there = found[0, 1]
    assert (there is None) == (upper is None)
    if there is not None and upper is not None and lower is not None:
        assert there.length <= upper + 1e-6
        assert there.length * OCTILE + 1.5 * len(there.bends) >= lower
    legs = [found[pair] for pair in ((0, 2), (0, 1), (1, 2))]
    if all(leg is not None for leg in legs):
        ac, ab, bc = (leg.length for leg in legs if leg is not None)
        assert ac <= math.sqrt(2) * (ab + bc) + 1e-6


def test_a_path_bends_at_the_edges_of_doors_and_nowhere_else() -> None:
    grid = grid_of(ground_of(three_rooms()), 0.3)
    start, end = (1.0, 1.0), (11.0, 5.0)
    for nodes in (10**6, 60_000, 500):
        route = Routes(graph_of(grid, nodes), [start]).route(start, end)
        assert route is not None
        check(grid, route)
        corners = [(3.9, 4.3), (4.1, 4.3), (7.9, 1.7), (8.1, 1.7)]  # 0.3 m from those of the walls
        taut = [start, *corners, end]
        shortest = sum(math.dist(a, b) for a, b in zip(taut, taut[1:]))
        assert shortest * 0.99 < route.length < shortest * 1.03


def test_legs_of_a_building_add_up() -> None:
    grid = grid_of(ground_of(three_rooms()), 0.3)
    points = [(1.0, 1.0), (6.0, 3.0), (11.0, 5.0), (2.0, 5.0)]
    routes = Routes(graph_of(grid, 2000), points)
    length = {}
    for a, b in itertools.permutations(points, 2):
        route, back = routes.both(a, b), routes.both(b, a)
        assert route is not None and back is not None
        assert (route.bends, route.length) == (back.bends[::-1], back.length)
        length[a, b] = route.length
    for a, b, c in itertools.permutations(points, 3):
        assert length[a, c] <= 1.02 * (length[a, b] + length[b, c])


def test_a_path_that_is_longer_than_was_expected_is_found_all_the_same() -> None:
    graph = graph_of(grid_of(ground_of(three_rooms()), 0.3), 2000)
    far, near = (1.0, 1.0), (11.0, 5.0)
    assert Routes(graph, [far], 1.0).route(far, near) == Routes(graph, [far]).route(far, near) is not None


@pytest.mark.parametrize("nodes", [10**6, 3000, 300, 30])
def test_a_door_that_is_just_wide_enough_stays_open_however_coarse_the_search(nodes: int) -> None:
    start, end = (1.0, 1.0), (11.0, 5.0)
    for door, there in ((0.7, True), (0.5, False)):
        grid = grid_of(ground_of(three_rooms(door)), 0.3)
        assert (Routes(graph_of(grid, nodes), [start]).route(start, end) is not None) == there


def test_a_winding_corridor_within_a_block_is_followed() -> None:
    walls = [(0.5 * k, 0.0 if k % 2 else 0.5, 0.5 * k + 0.1, 2.5 if k % 2 else 3.0) for k in range(1, 12)]
    grid = grid_of(ground_of(drawn((6.0, 3.0), walls)), 0.1)
    start, end = (0.25, 0.3), (5.8, 0.3)
    lengths = []
    for nodes in (10**6, 4):
        route = Routes(graph_of(grid, nodes), [start]).route(start, end)
        assert route is not None
        check(grid, route)
        lengths.append(route.length)
    assert lengths[1] == pytest.approx(lengths[0], rel=0.05) and lengths[0] > 20
