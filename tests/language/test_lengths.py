"""Lengths: how they are read and given back, and that the game is that of the same numbers without units."""

from __future__ import annotations

import copy
import pickle
from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.explanation.explain import explain, render
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language import parse
from pursue_gen.language.checks import check, check_reading
from pursue_gen.language.document import edited
from pursue_gen.language.formatter import format_text
from pursue_gen.language.measures import LENGTHS, Length, length_text
from pursue_gen.language.numbers import exact
from pursue_gen.language.parser import read
from pursue_gen.language.rewriting import Rewriting
from pursue_gen.language.sentences import speed_words
from pursue_gen.language.writer import scenario_text
from pursue_gen.solving.rules import Rules
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.uppaal import write_network

TEXT = """\
unit second

poi "desk"
poi "shelf"
poi "door"

connect desk and shelf distance 12 m
connect shelf and door distance 80 cm

event "fetch" location shelf duration 30 s

agent "bot" controllable mobile 2 radius 20 cm tolerance 0.1 m location desk can_do fetch

reach_objective: do fetch within 2 min
"""


@given(st.integers(1, 10**9))
def test_a_length_that_is_shown_can_be_read(millimetres: int) -> None:
    number = exact(Fraction(millimetres, 1000))
    assert LENGTHS.read(length_text(number)).value == number


def test_a_scenario_says_its_lengths_as_they_were_written() -> None:
    scenario = parse(TEXT, "story.pur")
    assert not check(scenario)
    assert format_text(TEXT.replace("12 m", "12   m"), "story.pur") == TEXT == scenario_text(scenario)
    assert [way.distance for way in scenario.connections] == [12, Fraction(4, 5)]
    assert scenario.in_metres and not parse(TEXT.replace("12 m", "12").replace("80 cm", "0.8"), "x.pur").in_metres
    (agent,) = scenario.agents
    assert agent.size_words == "radius 20 cm, goal tolerance 0.1 m"
    assert agent.radius == Fraction(1, 5)
    assert speed_words(agent, scenario) == "2 s per metre"


def test_units_of_length_change_nothing_in_the_game() -> None:
    plain = TEXT.replace("12 m", "12").replace("80 cm", "0.8").replace("20 cm", "0.2").replace("0.1 m", "0.1")
    games = [(translate(story), scenario_objective(story)) for story in (parse(plain, "a.pur"), parse(TEXT, "a.pur"))]
    assert write_network(*games[0]) == write_network(*games[1]) and repr(games[0]) == repr(games[1])


def wrong(text: str) -> Tuple[Tuple[str, int, str], ...]:
    found = check_reading(read(text, "x.pur"))
    return tuple((each.code, each.span.line if each.span else 0, each.hint) for each in found)


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "hint"),
    [
        ("unit second\n", "\n", "PML420", 7, "unit second (then distances are metres)"),
        ("12 m", "12m", "PML014", 7, "write 12 m, with a blank"),
        ("12 m", "12 metres", "PML014", 7, "write 12 m"),
        ("12 m", "80 cm 1 m", "PML014", 7, "write 1.8 m"),
        ("12 m", "12 min", "PML014", 7, "12 m, 80 cm"),
        ("12 m", "0 m", "PML140", 7, "above 0"),
        ("80 cm", "0.25 cm", "PML280", 8, "fewer digits"),
        ("20 cm", "20000 cm", "PML148", 12, "radius in metres"),
        ("mobile 2", "mobile 2 m", "PML014", 12, "write 2: a unit stands behind times and lengths only"),
        ("30 s", "30 m", "PML014", 10, "write 30 min where these are minutes"),
        ("30 s", "30 cm", "PML014", 10, "30 s, 2 min"),
        ("mobile 2", "speed 0.5 m", "PML014", 12, "write 0.5"),
    ],
)
def test_what_is_wrong_with_a_length_is_said(old: str, new: str, code: str, line: int, hint: str) -> None:
    assert old in TEXT
    found = wrong(TEXT.replace(old, new))
    assert found and (code, line) in [each[:2] for each in found] and any(hint in each[2] for each in found), found


def test_a_robot_has_a_size_in_metres_in_a_scenario_without_a_unit() -> None:
    text = TEXT.replace("unit second", "").replace("30 s", "30").replace("2 min", "120")
    assert not wrong(text.replace("12 m", "12").replace("80 cm", "0.8"))


def test_names_may_be_words_of_lengths() -> None:
    text = TEXT.replace("shelf", "m").replace('"door"', '"cm"').replace("door", "cm").replace("fetch", "metre")
    assert not check(parse(text, "story.pur"))


def test_what_is_computed_from_a_length_is_a_plain_number() -> None:
    length = Length(12, 1, "12 m")
    assert type(exact(length)) is int and type(length * 2) is Fraction and str(length) == "12"
    for same in (copy.deepcopy(length), pickle.loads(pickle.dumps(length))):
        assert (same, same.written, type(same)) == (12, "12 m", Length)


def test_changes_and_surveys_write_lengths_where_the_text_has_them() -> None:
    scenario = parse(TEXT, "story.pur")
    said = [each.say(each.values[0]) for each in repairs(scenario, Rules()) if each.what == "distance"]
    assert said == ["desk and shelf at distance 11 m instead of 12 m"]
    text = render(explain(parse(TEXT.replace("within 2 min", "within 40 s"), "story.pur"), Rules()), 200)
    assert "desk and shelf at distance 2 m instead of 12 m (3 m is not enough" in text
    edits = Rewriting(scenario).distance(scenario.connections[1], exact(Fraction(5, 2)), "survey: 2.5 m")
    assert "connect shelf and door distance 2.5 m // survey: 2.5 m" in edited(TEXT, edits)
    assert str(scenario.as_distance(3)) == "3" and length_text(3) == "3 m"
