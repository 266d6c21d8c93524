"""Doors that open by themselves: how much longer ways through them take, for whom they are opened, what is wrong."""

from __future__ import annotations

from typing import List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.lifts import doors_of
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import Lost
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario


def lab(doors: str = 'door "d1" opens within 8', through: str = " through d1", more: str = "", within: int = 30) -> str:
    return f"""\
poi "hall"
poi "lab"
{doors}
connect hall and lab distance 4{through}
event "fetch" location lab
agent "bot" controllable mobile 1 location hall can_do fetch
agent "guest" mobile 2 location lab
{more}
reach_objective: do fetch within {within}
"""


def scenario(text: str) -> Scenario:
    return parse(text, "lab.pur", "lab")


def found(text: str) -> List[Tuple[str, str]]:
    return [(finding.code, finding.message) for finding in check_reading(read(text, "lab.pur"))]


def test_a_way_through_a_door_may_take_so_much_longer_and_no_less() -> None:
    made = scenario(lab())
    assert made.movements(made.agents[0]) == {("hall", "lab"): (4, 13), ("lab", "hall"): (4, 13)}
    assert made.movements(made.agents[1])["hall", "lab"] == (8, 17), "who is not controlled may have to wait, too"


@given(st.integers(1, 50), st.integers(1, 50))
def test_of_several_doors_the_slowest_counts(first: int, second: int) -> None:
    doors = f'door "d1" opens within {first}\ndoor "d2" opens within {second}'
    made = scenario(lab(doors, " through d1, d2"))
    assert made.movements(made.agents[0])["hall", "lab"] == (4, 5 + max(first, second))


def test_a_time_of_its_own_is_that_without_the_door() -> None:
    made = scenario(lab(more="travel bot from hall to lab takes 2 to 3"))
    assert made.movements(made.agents[0]) == {("hall", "lab"): (2, 11), ("lab", "hall"): (4, 13)}


def test_doors_are_opened_for_who_is_controlled() -> None:
    made = scenario(lab())
    assert doors_of(made, made.agents[0]) == {("hall", "lab"): ("d1",), ("lab", "hall"): ("d1",)}
    assert doors_of(made, made.agents[1]) == {}
    assert doors_of(scenario(lab("", "")), made.agents[0]) == {}


@pytest.mark.parametrize(("within", "wins"), [(16, True), (15, False)])
def test_what_is_promised_counts_with_a_door_that_takes_its_time(within: int, wins: bool) -> None:
    made = scenario(lab(within=within))
    if wins:
        assert solve_scenario(made, DEFAULT).strategy is not None
    else:
        with pytest.raises(Lost):
            solve_scenario(made, DEFAULT)


def test_a_quicker_door_is_a_change_that_explanations_try() -> None:
    tried = next(each for each in repairs(scenario(lab()), DEFAULT) if each.what == "door")
    changed = tried.make(5)
    assert isinstance(changed, Scenario) and changed.doors[0].opens_within == 5
    assert tried.say(5) == "d1 opening within 5 instead of 8"


@pytest.mark.parametrize(
    ("text", "finding"),
    [
        (lab('door "d1" opens within 0'), ("PML460", "d1 would be open at once, always")),
        (lab(through=" through d1, d1"), ("PML460", "d1 stands twice behind through")),
        (lab(through=" through hall"), ("PML110", "hall is a POI, but a door is needed here")),
        (lab(through=""), ("PML461", "no way leads through d1")),
        (
            lab('door "d1" opens within 8 //[2, 0, 0, 0, 0, 0, 1] bot [1, 0, 0, 0, 0, 0, 1]'),
            ("PML460", "a door has one pose, and bot has another one here"),
        ),
        (
            lab().replace('poi "lab"', 'poi "lab" //[4, 0, 0, 0, 0, 0, 1]'),
            ("PML462", "d1 has no pose, but places do: robots would wait for it where they set off"),
        ),
    ],
)
def test_what_is_wrong_is_said(text: str, finding: Tuple[str, str]) -> None:
    assert finding in found(text)


def test_a_sound_door_is_no_finding() -> None:
    assert found(lab()) == []
    posed = lab('door "d1" label "glass door" opens within 8 //[2, 0, 0, 0, 0, 0, 1]')
    assert scenario(posed).doors[0].pose is not None and scenario(posed).shown("d1") == "glass door"


def test_its_words_may_be_names() -> None:
    text = lab().replace("hall", "door").replace("bot", "through").replace("fetch", "opens")
    assert found(text) == []


def test_each_of_a_group_may_have_a_door() -> None:
    doors = 'poi "store"\ngroup "rooms": lab, store\nfor each r in rooms: door "door" of r opens within 5'
    text = lab(doors, " through door_lab")
    assert [door.name for door in scenario(text).doors] == ["door_lab", "door_store"]
