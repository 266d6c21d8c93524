"""Places on a map: what is too near, what ways lead through, and which ways are missing."""

from __future__ import annotations

import math
from typing import Dict

from pursue_gen.survey.graph import graph_of
from pursue_gen.survey.grid import Point, grid_of
from pursue_gen.survey.plan import Plan
from tests.survey.maps import drawn, ground_of, three_rooms

ROOMS: Dict[str, Point] = {"left": (1.0, 1.0), "middle": (6.0, 3.0), "right": (11.0, 5.0)}


def plan(places: Dict[str, Point], greys: object = None, room: float = 0.8) -> Plan:
    return Plan(graph_of(grid_of(ground_of(three_rooms() if greys is None else greys), 0.3)), places, room)


def test_a_way_that_leads_through_a_third_place_is_not_one_of_its_own() -> None:
    made = plan(ROOMS)
    assert made.crossed("left", "right") == ["middle"] and made.crossed("left", "middle") == []
    assert sorted(made.own_ways([])) == [("left", "middle"), ("middle", "right")]
    assert made.own_ways([("left", "middle"), ("right", "middle")]) == []
    assert made.own_ways([("left", "right")]) == [("left", "middle"), ("middle", "right")]


def test_places_are_crossed_in_the_order_of_the_path() -> None:
    made = plan({"b": (2.0, 3.0), "d": (3.0, 3.0), "a": (1.0, 3.0), "c": (2.5, 3.0)}, drawn((4, 6), []), 0.4)
    assert made.crossed("a", "d") == ["b", "c"] and made.crossed("d", "a") == ["c", "b"]
    assert sorted(made.own_ways([])) == [("b", "a"), ("b", "c"), ("d", "c")]


def test_a_place_beside_the_path_does_not_replace_a_way_that_is_much_shorter() -> None:
    made = plan({"a": (1.0, 1.0), "b": (9.0, 1.0), "aside": (5.0, 5.0)}, drawn((10, 6), []))
    assert sorted(made.own_ways([])) == [("a", "aside"), ("a", "b"), ("b", "aside")]


def test_whatever_can_be_reached_is_connected_by_the_ways() -> None:
    grid = grid_of(ground_of(three_rooms()), 0.3)
    places = {f"p{k}": (0.8 + 10.4 * (k * 7 % 20) / 20, 1.0 + 4.0 * (k * 3 % 7) / 7) for k in range(20)}
    made = plan({name: at for name, at in places.items() if grid.is_free(grid.cell(*at))})
    assert len(made.places) > 12
    ways = made.own_ways([])
    for part in made.parts():
        reached = {part[0]}
        for _ in ways:
            reached |= {end for way in ways if reached & set(way) for end in way}
        assert reached >= set(part)


def test_parts_that_cannot_be_reached_from_each_other() -> None:
    made = plan(ROOMS, three_rooms(door=0.4))
    assert made.parts() == [["left"], ["middle"], ["right"]]
    assert made.route("left", "right") is None and made.crossed("left", "right") == []
    assert made.own_ways([("left", "right")]) == []


def test_a_path_is_the_same_in_both_directions() -> None:
    made = plan(ROOMS)
    there, back = made.route("left", "right"), made.route("right", "left")
    assert there is not None and back is not None
    assert there.bends == back.bends[::-1] and there.length == back.length > math.dist((1, 1), (11, 5))
