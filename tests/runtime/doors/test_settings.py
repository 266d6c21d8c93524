"""How doors are connected."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.doors.settings import (
    command_word,
    floor_called,
    floor_number,
    floor_word,
    read_door_settings,
    read_lift_settings,
    state_of_word,
)


def test_a_door_is_simulated_unless_something_else_is_said() -> None:
    assert read_door_settings("d1", {}).adapter == "simulated"
    assert read_door_settings("d1", {"adapter": "string"}).adapter == "string"


def test_its_own_settings_win() -> None:
    own = {"d1": {"adapter": "rmf", "name": "main_door"}, "d2": {"state": "/is"}}
    given: Dict[str, Any] = {"adapter": "std_msgs", **own}
    assert read_door_settings("d1", given)[:4] == ("rmf", "door_requests", "door_states", "main_door")
    assert read_door_settings("d2", given)[:4] == ("std_msgs", "pursue/doors/d2/command", "/is", "d2")


@pytest.mark.parametrize("given", [{"adapter": "ros2"}, {"d1": {"adapter": 3}}, {"d1": {"topic": "x"}}, {"d1": "rmf"}])
def test_what_cannot_be_meant_is_refused(given: Dict[str, Any]) -> None:
    with pytest.raises(DataError, match="expected"):
        read_door_settings("d1", given)


@pytest.mark.parametrize(
    ("word", "meaning"), [("open", True), (" OPEN ", True), ("closed", False), ("opening", False), ("?", None)]
)
def test_words_of_doors(word: str, meaning: object) -> None:
    assert state_of_word(word) is meaning


def test_words_to_doors() -> None:
    assert [command_word(True), command_word(False)] == ["open", "close"]


FLOORS = ("hall0", "hall1")


def test_floors_of_lifts_have_numbers_or_names_from_the_lowest_one_up() -> None:
    numbers = read_lift_settings("l1", FLOORS, {"adapter": "std_msgs"})
    assert numbers.command == "pursue/lifts/l1/command"
    assert [floor_number(numbers, floor) for floor in (*FLOORS, "")] == [0, 1, -1]
    assert [floor_called(numbers, said) for said in (1, 0, -1, 7)] == ["hall1", "hall0", "", ""]
    words = read_lift_settings("l1", FLOORS, {"adapter": "string"})
    assert [floor_word(words, floor) for floor in (*FLOORS, "")] == ["hall0", "hall1", "free"]
    assert [floor_called(words, said) for said in (" hall1 ", "moving")] == ["hall1", ""]


def test_they_may_be_called_otherwise() -> None:
    given: Dict[str, Any] = {"l1": {"adapter": "rmf", "name": "Lift1", "floors": {"hall0": "L1", "hall1": "L2"}}}
    settings = read_lift_settings("l1", FLOORS, given)
    assert settings[:4] == ("rmf", "lift_requests", "lift_states", "Lift1")
    assert dict(settings.floors) == {"hall0": "L1", "hall1": "L2"} and floor_called(settings, "L2") == "hall1"
    numbered = read_lift_settings("l1", FLOORS, {"adapter": "std_msgs", "l1": {"floors": {"hall0": 3}}})
    assert floor_number(numbered, "hall0") == 3


@pytest.mark.parametrize(
    "own",
    [{"floors": ["L1"]}, {"floors": {"roof": "L3"}}, {"floors": {"hall0": 1}}, {"floors": {"hall1": "L1"}}, {"x": 1}],
)
def test_floors_that_cannot_be_meant_are_refused(own: Any) -> None:
    with pytest.raises(DataError, match="expected"):
        read_lift_settings("l1", FLOORS, {"adapter": "std_msgs", "l1": own})
