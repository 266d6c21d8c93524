"""Measured numbers are written into a scenario's text, and nothing else of it changes."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import List

import pytest

from pursue_gen.language import parse
from pursue_gen.language.formatter import format_text
from pursue_gen.language.numbers import exact
from pursue_gen.lsp.document import Document
from pursue_gen.lsp.new_numbers import Distance, Duration, NewNumber, TravelTime, with_numbers

SCENARIOS = sorted((Path(__file__).resolve().parents[2] / "scenarios").rglob("*.pur"))

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


def test_a_new_travel_time_does_not_take_the_note_of_the_one_before_it() -> None:
    both = [TravelTime("bot", "a", "b", 4, 6, "18 drives"), TravelTime("bot", "b", "a", 4, 7, "3 drives")]
    assert written(*both).splitlines()[6:8] == [
        'travel "bot" from a to b takes 4 to 6 // calibrate: 18 drives',
        "travel bot from b to a takes 4 to 7 // calibrate: 3 drives",
    ]


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


@pytest.mark.parametrize("file", SCENARIOS, ids=lambda file: file.stem)
def test_in_the_scenarios_that_come_with_it_windows_are_all_that_changes(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    scenario = parse(text, str(file))
    numbers: List[NewNumber] = [
        TravelTime(agent.name, *way, low, exact(high + 1), "a test")
        for agent in scenario.agents
        for way, (low, high) in scenario.movements(agent).items()
    ]
    numbers += [Duration(each.name, each.window[0], exact(each.window[1] + 1), "a test")
                for each in scenario.events if each.window is not None]  # fmt: skip
    found = with_numbers(text, str(file), numbers, "calibrate")
    changed = parse(found, str(file))
    for agent in scenario.agents:
        wider = {way: (low, high + 1) for way, (low, high) in scenario.movements(agent).items()}
        assert changed.movements(agent) == wider
    assert [each.window for each in changed.events] == [
        None if each.window is None else (each.window[0], each.window[1] + 1) for each in scenario.events
    ]
    assert found.count("calibrate: a test") == len(numbers)
    comments = [str(token) for token in Document.of(text, str(file)).comments]
    assert [each for each in comments if each not in found] == []
    assert with_numbers(found, str(file), numbers, "calibrate") == found
    assert format_text(found, str(file)).count("calibrate: a test") == len(numbers)
