"""Measured numbers are written into a scenario's text, and nothing else of it changes."""

from __future__ import annotations

from fractions import Fraction

import pytest

from pursue_gen.language import parse
from pursue_gen.lsp.new_numbers import Distance, Duration, TravelTime, with_numbers

TEXT = """\
poi "a" //[1, 2, 3, 0, 0, 0, 1]
poi "b" // the shelf
connect a and b distance 4 // paced; by hand
event "fetch" location b duration 3 only_if bot at b /* why */
event "pack" location b duration 3 to 5 event "call" location b
agent "bot" controllable mobile 1 location a can_do fetch, pack, call
travel "bot" from a to b takes 5
reach_objective: do fetch and pack and call
"""


def written(*numbers: object, text: str = TEXT) -> str:
    found = with_numbers(text, "floor.pur", numbers, "calibrate")  # type: ignore[arg-type] # all of them are numbers
    parse(found, "floor.pur", "floor")
    return found


def test_a_travel_time_replaces_the_one_that_is_there() -> None:
    found = written(TravelTime("bot", "a", "b", Fraction(41, 10), 6, "18 drives, 4.1 to 6.3"))
    assert found == TEXT.replace("takes 5\n", "takes 4.1 to 6 // calibrate: 18 drives, 4.1 to 6.3\n")


def test_travel_times_that_are_new_stand_behind_the_others_in_order() -> None:
    more = [TravelTime("bot", "b", "a", 4, 7, "3 drives"), TravelTime("bot", "b", "c", 1, 2, "1 drive")]
    lines = written(*more).splitlines()
    assert lines[7:9] == [
        "travel bot from b to a takes 4 to 7 // calibrate: 3 drives",
        "travel bot from b to c takes 1 to 2 // calibrate: 1 drive",
    ]
    assert [line for line in lines if line not in lines[7:9]] == TEXT.splitlines()


def test_durations_and_distances_are_replaced_and_comments_stay() -> None:
    way = Distance("b", "a", Fraction(7, 2), "map.yaml")
    numbers = [Duration("fetch", 1, 2, "x"), Duration("pack", 1, 2, "y"), way]
    found = written(*numbers)
    assert "connect a and b distance 3.5 // paced; by hand; calibrate: map.yaml\n" in found
    assert "duration 1 to 2 only_if bot at b /* calibrate: x */ /* why */\n" in found
    assert 'duration 1 to 2 /* calibrate: y */ event "call" location b\n' in found
    assert written(*numbers, text=found) == found


def test_a_note_takes_the_place_of_the_one_before_it() -> None:
    old = TEXT.replace("takes 5", "takes 5 // calibrate: 3 drives; checked on Monday")
    found = written(TravelTime("bot", "a", "b", 4, 6, "18 drives"), text=old)
    assert "takes 4 to 6 // checked on Monday; calibrate: 18 drives\n" in found


def test_of_two_ways_in_one_direction_each_the_wanted_one_is_meant() -> None:
    text = TEXT.replace(
        "connect a and b distance 4 // paced; by hand",
        "connect a and b distance 4 one_way\nconnect b and a distance 9 one_way",
    )
    found = written(Distance("b", "a", 8, "map"), text=text)
    assert "connect b and a distance 8 one_way // calibrate: map\n" in found and "connect a and b distance 4 o" in found


def test_line_ends_of_another_system_are_read() -> None:
    found = written(Distance("a", "b", 2, "map"), text=TEXT.replace("\n", "\r\n"))
    assert "distance 2 // paced; by hand; calibrate: map\n" in found and "\r" not in found


@pytest.mark.parametrize("number", [Duration("call", 1, 2, "x"), Duration("x", 1, 2, "x"), Distance("a", "c", 1, "x")])
def test_what_has_no_number_cannot_get_one(number: object) -> None:
    with pytest.raises(ValueError, match=r"nothing in floor\.pur"):
        written(number)
