"""How doors are connected."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.doors.settings import command_word, read_door_settings, state_of_word


def test_a_door_is_simulated_unless_something_else_is_said() -> None:
    assert read_door_settings("d1", {}).adapter == "simulated"
    assert read_door_settings("d1", {"adapter": "string"}).adapter == "string"


def test_its_own_settings_win() -> None:
    own = {"d1": {"adapter": "rmf", "name": "main_door"}, "d2": {"state": "/is"}}
    given: Dict[str, Any] = {"adapter": "std_msgs", **own}
    assert read_door_settings("d1", given) == ("rmf", "door_requests", "door_states", "main_door")
    assert read_door_settings("d2", given) == ("std_msgs", "pursue/doors/d2/command", "/is", "d2")


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
