"""Spots: on free ground, apart from each other and from other places, beside the ways; what is given comes first."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Dict, List, Optional, Sequence, Tuple

from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.language.parser import parse
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.survey.grid import Point, grid_of
from pursue_gen.survey.spots import Spots, Standing, proposed_spots, shut_in
from tests.survey.maps import drawn, ground_of

GRID = grid_of(ground_of(drawn((8, 6), [(3.9, 0, 4.1, 6)], [(3.9, 2.5, 4.1, 3.5)])), 0.3)
ROOM = 0.8
Ways = Dict[Tuple[str, str], Sequence[Point]]


def scenario(places: Dict[str, str], robots: int) -> Scenario:
    names = list(places)
    text = "".join(f'poi "{name}" //{behind}\n' for name, behind in places.items()) + 'event "work"\n'
    text += "".join(f"connect {names[0]} and {name} distance 3\n" for name in names[1:])
    start = f"mobile 1 location {names[0]} can_do work"
    text += "".join(f'agent "bot{number}" controllable {start}\n' for number in range(1, robots + 1))
    return parse(text + "reach_objective: do work\n", "test.pur")


def pose(x: float, y: float, yaw: float = 0.0) -> str:
    return f"[{x}, {y}, 0, 0, 0, {math.sin(yaw / 2)}, {math.cos(yaw / 2)}]"


def spots(places: Dict[str, str], robots: int = 2, ways: Optional[Ways] = None) -> Spots:
    return proposed_spots(scenario(places, robots), GRID, places, ROOM, ways or {})


def points(found: Sequence[Tuple[str, Optional[Pose]]]) -> List[Point]:
    return [(one.x, one.y) for _, one in found if one is not None]


def test_the_first_robot_has_the_pose_and_the_next_one_stands_beside_it() -> None:
    ((robot, spot),) = spots({"a": pose(2.0, 2.0)})["a"]
    assert robot == "bot2" and spot is not None
    assert abs(spot.x - 2.0) <= 0.1 and ROOM - 0.01 <= abs(spot.y - 2.0) <= ROOM + 0.25
    ((_, turned),) = spots({"a": pose(2.0, 2.0, math.pi / 2)})["a"]
    assert turned is not None and abs(turned.y - 2.0) <= 0.1 and (turned.qz, turned.qw) != (spot.qz, spot.qw)


def test_a_robot_with_a_pose_of_its_own_keeps_it_and_the_others_keep_away() -> None:
    found = spots({"a": f"{pose(2.0, 2.0)} bot1 {pose(2.0, 2.8)} bot3 {pose(2.0, 1.2)}"}, 4)["a"]
    assert [robot for robot, _ in found] == ["bot4"]  # bot2 has the pose of the place
    ((x, y),) = points(found)
    assert all(math.dist((x, y), (2.0, other)) >= ROOM for other in (1.2, 2.0, 2.8))


def test_nobody_is_placed_beyond_a_wall_or_too_near_to_one() -> None:
    found = spots({"a": pose(3.5, 0.5)}, 5)["a"]
    assert len(points(found)) == 4
    assert all(x < 3.6 and GRID.is_free(GRID.cell(x, y)) for x, y in points(found))


def test_no_robot_stands_in_another_room_because_planners_would_like_it() -> None:
    ground = ground_of(drawn((8, 6), [(0, 2.0, 8, 2.1)], [(3.5, 2.0, 4.5, 2.1)]))
    places = {"a": pose(4.0, 1.0)}
    likes = Standing(grid_of(ground, 0.3), grid_of(ground, 1.2))
    found = proposed_spots(scenario(places, 2), grid_of(ground, 0.2), places, ROOM, {}, standing=lambda robot: likes)
    ((x, y),) = points(found["a"])
    assert y < 2.0 and math.dist((x, y), (4.0, 1.0)) < 1.1


def test_a_spot_is_out_of_the_way_of_robots_that_pass() -> None:
    passing = {("b", "c"): [(0.5, 3.0), (7.5, 3.0)]}
    (found,) = points(spots({"a": pose(2.0, 2.2, math.pi / 2)}, 2, passing)["a"])
    assert abs(found[1] - 3.0) >= ROOM
    own = {("a", "c"): [(2.0, 2.2), (2.0, 5.5)]}
    (found,) = points(spots({"a": pose(2.0, 2.2)}, 2, own)["a"])
    assert found[1] < 2.2 + 0.1


def test_where_there_is_no_room_it_is_said() -> None:
    tiny = grid_of(ground_of(drawn((1.2, 1.2), [])), 0.3)
    made = scenario({"a": pose(0.6, 0.6)}, 3)
    assert proposed_spots(made, tiny, ["a"], ROOM, {}) == {"a": [("bot2", None), ("bot3", None)]}


def test_poses_of_robots_that_are_not_on_the_map_are_no_hindrance() -> None:
    for far in (-500.0, 500.0):
        found = proposed_spots(
            scenario({"a": f"{pose(2.0, 2.0)} bot1 {pose(far, far)}"}, 3),
            GRID,
            ["a"],
            ROOM,
            {("a", "b"): [(2, 2), (2, 5)]},
            0.6,
        )
        assert [robot for robot, spot in found["a"] if spot is not None] == ["bot3"]


def test_places_in_obstacles_and_robots_that_are_alone_get_none() -> None:
    assert spots({"a": pose(2.0, 2.0)}, 1) == {}
    assert proposed_spots(scenario({"a": pose(4.0, 1.0)}, 2), GRID, [], ROOM, {}) == {}


FREE = st.tuples(st.floats(0.5, 3.4), st.floats(0.5, 5.4), st.floats(-3, 3))


@settings(deadline=None, max_examples=30)
@given(st.lists(FREE, min_size=1, max_size=3), st.integers(2, 4))
def test_all_spots_are_free_and_apart(places: List[Tuple[float, float, float]], robots: int) -> None:
    given_at = {f"p{k}": pose(*place) for k, place in enumerate(places)}
    found = spots(given_at, robots)
    assert found == spots(given_at, robots) and set(found) == set(given_at)
    new = [point for name in found for point in points(found[name])]
    assert all(GRID.is_free(GRID.cell(*point)) for point in new)
    assert all(math.dist(a, b) >= ROOM for a, b in combinations(new, 2))
    assert all(math.dist(point, (x, y)) >= ROOM for point in new for x, y, _ in places)


CORRIDOR = grid_of(ground_of(drawn((8, 6), [(0, 2.0, 5, 6), (0, 0, 5, 1.0)])), 0.3)  # of 1 m, with a room at its end


def test_a_robot_in_a_dead_end_is_shut_in_by_the_one_before_it() -> None:
    exits = [(4.5, 1.5)]
    assert shut_in(CORRIDOR, [(1.0, 1.5), (2.0, 1.5)], exits, 0.6) == [0]
    assert shut_in(CORRIDOR, [(1.0, 1.5), (7.0, 1.5)], exits, 0.6) == []
    assert shut_in(CORRIDOR, [(1.0, 1.5), (2.0, 1.5), (3.0, 1.5)], exits, 0.6) == [0, 1]
    assert shut_in(CORRIDOR, [(1.0, 1.5), (2.0, 1.5)], [], 0.6) == []
    assert shut_in(GRID, [(2.0, 2.0), (2.0, 2.8)], [(3.5, 3.0)], 0.6) == []


def test_a_spot_is_chosen_from_which_everybody_can_leave() -> None:
    made = scenario({"a": pose(4.8, 1.5, math.pi)}, 2)  # at the mouth of the corridor
    ways = {("a", "b"): [(4.8, 1.5), (7.5, 4.5)], ("b", "c"): [(5.7, 0.5), (5.7, 5.5)]}
    for body, inside in ((0.0, True), (0.6, False)):
        ((x, _),) = points(proposed_spots(made, CORRIDOR, ["a"], 0.8, ways, body)["a"])
        assert (x < 4.8) == inside
