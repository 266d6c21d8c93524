"""Numbers with decimals: read, shown and computed exactly."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.checks import check
from pursue_gen.language.numbers import (
    at_least,
    at_most,
    decimal_text,
    exact,
    is_fine,
    read_number,
    whole_above,
    whole_below,
)

NUMBERS = st.builds(lambda thousandths: Fraction(thousandths, 1000), st.integers(0, 10**9))

TEXT = """\
poi "desk"
poi "shelf"
poi "window"
connect desk and shelf distance 2.5
connect desk and window distance 1.25
event "fetch" location shelf duration 0.75
event "boil" location shelf duration 0.5 to 2.25
event "ring" at_most 2 times
agent "bot" controllable mobile 0.5 location desk can_do fetch, boil
agent "guest" mobile 2 location desk can_do ring
travel bot from desk to window takes 1.5 to 3.125
assume: guest waits 2.5 between ring
assume: guest leaves window within 7.5
objective: if ring then fetch within 12.5
objective: patrol desk every 20.5 by bot
reach_objective: do boil after 1.5 within 60.0
"""


@given(NUMBERS)
def test_a_number_is_read_as_it_is_written(number: Fraction) -> None:
    assert read_number(decimal_text(number)) == number
    assert read_number(f"0{decimal_text(number)}{'.' if number.denominator == 1 else ''}000") == number
    assert is_fine(number)


def test_bounds_are_shown_in_tenths_that_hold() -> None:
    assert (at_most(Fraction("21.004")), at_most(Fraction(21)), at_most(Fraction("21.1"))) == ("21.1", "21", "21.1")
    assert (at_least(Fraction("20.99")), at_least(Fraction(20)), at_least(Fraction("20.9"))) == ("20.9", "20", "20.9")


@given(NUMBERS, NUMBERS)
def test_what_is_computed_is_shown_as_a_decimal(first: Fraction, second: Fraction) -> None:
    assert read_number(str(exact(first * second))) == first * second
    assert isinstance(exact(first), int) == (first.denominator == 1)


NONE = ["", "-1", "+1", "1.", ".5", "1e3", "1,5", "1_000", "1/2", "0x10", "\N{ARABIC-INDIC DIGIT ONE}", "9" * 101]


@pytest.mark.parametrize("text", NONE)
def test_what_is_no_number_is_not_read(text: str) -> None:
    assert read_number(text) is None


@given(st.fractions(0, 30, max_denominator=8), st.integers(0, 5))
def test_whole_numbers_beside_a_number(number: Fraction, least: int) -> None:
    assert list(whole_below(number, least)) == [k for k in range(40, -1, -1) if least <= k < number]
    assert list(whole_above(number, number + 3)) == [k for k in range(40) if number < k <= number + 3]


def test_every_time_and_distance_may_have_decimals() -> None:
    scenario = parse(TEXT, "text.pur")
    assert not [finding for finding in check(scenario) if finding.severity.value == "error"]
    bot, guest = scenario.agents
    assert scenario.connections[0].distance == Fraction(5, 2)
    assert [event.window for event in scenario.events[:2]] == [(Fraction(3, 4), Fraction(7, 4)), (0.5, 2.25)]
    assert scenario.movements(bot)["desk", "shelf"] == (1.25, 2.25)
    assert scenario.movements(bot)["desk", "window"] == (1.5, 3.125)
    assert scenario.movements(guest)["desk", "shelf"] == (5, 6)
    assert type(scenario.movements(guest)["desk", "shelf"][0]) is int
    assert scenario.reach[0].within == 60
    assert type(scenario.reach[0].within) is int


def test_a_distance_times_a_pace_is_exact() -> None:
    text = TEXT.replace("distance 2.5", "distance 0.1").replace("mobile 0.5", "mobile 0.3")
    scenario = parse(text, "text.pur")
    assert str(scenario.movements(scenario.agents[0])["shelf", "desk"][0]) == "0.03"
