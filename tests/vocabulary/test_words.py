"""Zones in words say what the zones say: read back by hand, and checked against random moments."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Dict, List, Optional

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.sentences import objective_words
from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.strategy import Constraint, Zone
from pursue_gen.tga import translate
from pursue_gen.vocabulary.words import words_of

TEXT = """
poi "hall" poi "shop"
connect hall and shop distance 3
event "meet" location hall duration 2
event "wave"
rule "order": meet before wave
agent "bot" controllable mobile 1 location hall can_do meet
agent "cat" mobile 1 location hall can_do wave
reach_objective: do meet after 5
"""
SCENARIO = parse(TEXT, "house.pur", "house")
NETWORK = translate(SCENARIO)
WORDS = words_of(SCENARIO, NETWORK)


def bound(left: Optional[str], right: Optional[str], value: int, strict: bool = False) -> Constraint:
    return Constraint(left, right, Fraction(value), strict)


@pytest.mark.parametrize(
    ("zone", "told"),
    [
        ((), "at any time"),
        ((bound(None, "Cbot", -1, True),), "more than 1 unit after bot's last step"),
        ((bound(None, "Cbot", 0, True),), "some time after bot's last step"),
        ((bound("Cbot", None, 0),), "right after bot's last step"),
        ((bound("Cbot", None, 4),), "at most 4 units after bot's last step"),
        (
            (bound(None, "Cbot", -1, True), bound("Cbot", None, 4)),
            "more than 1 and at most 4 units after bot's last step",
        ),
        ((bound(None, "Cbot", -3), bound("Cbot", None, 3)), "exactly 3 units after bot's last step"),
        ((bound(None, "Creach", -5, True),), "more than 5 units after the start"),
        ((bound("Cbot", "Ccat", 2),), "bot's last step was at most 2 units before cat's last step"),
        ((bound("Cbot", "Ccat", -2, True),), "cat's last step was more than 2 units before bot's last step"),
        ((bound("Cbot", "Ccat", 0),), "bot's last step was no earlier than cat's last step"),
        ((bound("Cbot", "Ccat", 0, True),), "bot's last step was later than cat's last step"),
        (
            (bound("Cbot", "Ccat", 2), bound("Ccat", "Cbot", -2)),
            "bot's last step was exactly 2 units before cat's last step",
        ),
        (
            (bound("Cbot", "Ccat", 0), bound("Ccat", "Cbot", 0)),
            "bot's last step and cat's last step were at the same moment",
        ),
    ],
)  # fmt: skip
def test_zones_are_reported_as_they_are(zone: Zone, told: str) -> None:
    assert WORDS.when(zone) == told


_NUMBER = r"(-?[\d.]+)"


def meant(words: str, ages: Dict[str, Fraction]) -> bool:
    """What a reader understands: ages are how long ago a moment was."""
    for part in words.split(", and ") if words != "at any time" else ():
        both = re.fullmatch(
            r"(.+) was (at most|less than|at least|more than|exactly) ([\d.]+) units? before (.+)", part
        )
        if both:
            gap, told = ages[both.group(1)] - ages[both.group(4)], Fraction(both.group(3))
            if not compare(gap, both.group(2), told):
                return False
            continue
        order = re.fullmatch(r"(.+) was (later than|no earlier than) (.+)", part)
        if order:
            a, b = ages[order.group(1)], ages[order.group(3)]
            if not (a < b if order.group(2) == "later than" else a <= b):
                return False
            continue
        same = re.fullmatch(r"(.+) and (.+) were at the same moment", part)
        if same:
            if ages[same.group(1)] != ages[same.group(2)]:
                return False
            continue
        span = re.fullmatch(r"(.+?) after (.+)", part)
        assert span is not None, part
        if not within(ages[span.group(2)], span.group(1)):
            return False
    return True


def within(age: Fraction, span: str) -> bool:
    if span == "some time":
        return age > 0
    if span == "right":
        return age == 0
    found = re.findall(r"(at most|less than|at least|more than|exactly) ([\d.]+)", span)
    assert found, span
    return all(compare(age, how, Fraction(number)) for how, number in found)


def compare(value: Fraction, how: str, told: Fraction) -> bool:
    return {
        "at most": value <= told,
        "less than": value < told,
        "at least": value >= told,
        "more than": value > told,
        "exactly": value == told,
    }[how]


CLOCKS = ("Cbot", "Ccat", "Creach")
SIDE = st.sampled_from((None, *CLOCKS))
CONSTRAINT = st.builds(
    lambda left, right, value, strict: Constraint(left, right, Fraction(value), strict),
    SIDE,
    SIDE,
    st.integers(-6, 6),
    st.booleans(),
)


def says(c: Constraint) -> bool:
    """False for what every clock is: 0 or more."""
    return c.left is not None or c.bound < 0 or (c.bound == 0 and c.strict)


@given(st.lists(CONSTRAINT, max_size=6), st.tuples(*[st.integers(0, 8)] * 3))
def test_words_mean_what_the_zone_means(some: List[Constraint], values: "tuple[int, int, int]") -> None:
    """For zones as the solver writes them: a bound for each pair of clocks at most, and none that is always true."""
    zone: Dict[object, Constraint] = {}
    for c in some:
        back = zone.get((c.right, c.left))
        room = c.bound + (back.bound if back else 0)
        empty = room < 0 or (room == 0 and (c.strict or (back is not None and back.strict)))
        if c.left != c.right and not (c.right is None and back is None and empty) and not (back and empty) and says(c):
            zone[c.left, c.right] = c
    clocks = {None: Fraction(0), **{name: Fraction(value) for name, value in zip(CLOCKS, values)}}
    holds = all(
        clocks[c.left] - clocks[c.right] < c.bound if c.strict else clocks[c.left] - clocks[c.right] <= c.bound
        for c in zone.values()
    )
    ages = {WORDS.clocks[name]: clocks[name] for name in CLOCKS}
    assert meant(WORDS.when(tuple(zone.values())), ages) == holds


def test_places_moves_and_turns_are_called_by_their_names() -> None:
    assert WORDS.place("bot", "going_hall_to_shop") == "on its way from hall to shop"
    assert WORDS.place("bot", "doing_meet_in_hall") == "doing meet at hall"
    assert WORDS.place("order", "order_initial_location") == "next: meet"
    assert {WORDS.place("order", location.name) for location in NETWORK.automaton("order").locations} == {
        "next: meet", "meet goes on", "next: wave",
    }  # fmt: skip
    moves = {WORDS.move("bot", edge) for edge in NETWORK.automaton("bot").edges}
    assert {"sets off from hall to shop", "arrives at shop", "begins meet", "finishes meet"} <= moves
    begins = next(edge for edge in NETWORK.automaton("bot").edges if edge.enters is Role.WORK)
    assert (WORDS.sentence("bot", begins), WORDS.command("bot", begins)) == ("bot begins meet", "bot: begin meet")


def test_the_objective_is_a_sentence() -> None:
    assert objective_words(SCENARIO) == ["meet happens later than 5 units after the start."]
