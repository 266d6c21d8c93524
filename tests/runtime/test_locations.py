"""Names of locations are read as the generator writes them; words without an answer are published ever more rarely."""

from __future__ import annotations

import pytest

from pursue_gen.language import network_names as names
from pursue_runtime.locations import action, action_of, is_action, is_end, is_movement, is_under_way, movement, place_of


def test_locations_of_the_generator_are_known() -> None:
    assert movement("a", "b") == names.going("a", "b")
    assert is_movement(names.going("a", "b")) and not is_action(names.going("a", "b"))
    assert is_action(names.doing("lift", "a")) and not is_movement(names.doing("lift", "a"))
    assert not is_under_way("a")


@pytest.mark.parametrize(("event", "poi"), [("lift", "a"), ("hand_in_hand", "room_1")])
def test_the_event_of_an_action_is_found(event: str, poi: str) -> None:
    assert action_of(names.doing(event, poi)) == event


def test_an_edge_that_leaves_a_movement_or_an_action_is_its_end() -> None:
    going = names.going("a", "b")
    assert is_end(going, "b")
    assert not is_end(going, going) and not is_end("a", going)


PLACES = ("b", "room_in_b", "hall")


@pytest.mark.parametrize("event", ["wipe", "wipe_in", "put_in_box"])
@pytest.mark.parametrize("place", PLACES)
def test_an_action_is_at_its_place_whatever_that_is_called(event: str, place: str) -> None:
    assert place_of(action(event, place), PLACES) == place


def test_who_stands_is_at_a_place_and_who_moves_is_at_none() -> None:
    assert place_of("hall", PLACES) == "hall"
    assert place_of(movement("b", "hall"), PLACES) not in PLACES
    assert place_of(action("wipe", "cellar"), PLACES) not in PLACES
