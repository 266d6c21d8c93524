"""Promises shared out again, so that robots that could stand where they are needed do not go to and fro."""

from __future__ import annotations

from dataclasses import replace
from itertools import accumulate
from math import inf
from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.lab_scenarios import lab_scenario
from pursue_gen.language import parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.calm import calm
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.shared_again import share_on_ways
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.solving.still_play import driven_while_still
from pursue_gen.tga.watchers import with_watchers, without_watchers

CORRIDOR = """
poi "hall"
poi "east"
poi "west"
connect hall and east distance 3
connect hall and west distance 5
agent "guard" controllable mobile 2 location hall
"""


def solved(*objectives: str) -> Solution:
    text = CORRIDOR + "".join(f"objective: {each}\n" for each in objectives)
    return solve_scenario(parse(text, "x.pur", "x"), DEFAULT)


def test_who_could_stand_at_one_of_two_places_does_not_go_to_and_fro() -> None:
    scenario = parse(lab_scenario(6), "lab_6.pur", "lab_6")
    first = solve_scenario(scenario, DEFAULT)
    found = calm(first, SolveOptions())
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok
    # One robot goes to and fro between two rooms at first, each seen to every 20. Three of the four places that are
    # visited can have a robot that stands there, and the fourth is next to one of them.
    before, after = (driven_while_still(each.network, each.strategy, 950) for each in (first, found))
    assert before is not None and after is not None
    assert 5 * after < before


def test_what_is_driven_in_a_play_in_which_all_takes_as_long_as_it_may() -> None:
    won = calm(solved("patrol east, west every 200 by guard"), SolveOptions())
    # From one end to the other it takes two ways, of 6 and 10 time units and at most one more each.
    there = 7 + 11
    driven = driven_while_still(won.network, won.strategy, 1000)
    assert driven is not None
    assert driven % 1 == 0 and 5 * there <= driven <= 8 * there
    assert driven_while_still(won.network, won.strategy, 50) == 0


def test_nobody_knows_how_to_go_on() -> None:
    won = solved("patrol east, west every 200 by guard")
    idle = replace(won.strategy, blocks=tuple(replace(block, commands=()) for block in won.strategy.blocks))
    assert driven_while_still(won.network, idle, 1e6) is None


def test_a_network_without_its_watchers_is_what_it_was() -> None:
    won = solve_scenario(parse(lab_scenario(6), "lab_6.pur", "lab_6"), DEFAULT)
    assert won.strategy.watchers
    base = without_watchers(won.network, won.strategy.watchers)
    assert with_watchers(base, won.strategy.watchers) == won.network
    assert not {watcher.name for watcher in won.strategy.watchers} & base.names


def line(*legs: float) -> List[List[float]]:
    """The times between places on a line."""
    at = [0.0, *accumulate(legs)]
    return [[abs(a - b) for b in at] for a in at]


@given(st.integers(1, 9), st.integers(18, 60), st.integers(18, 60))
def test_a_round_of_two_places_lasts_as_long_as_both_may_wait(leg: int, one: int, other: int) -> None:
    # While one place waits its robot is on both ways or at the other place.
    share = share_on_ways(line(leg), line(leg), [one, other])
    assert share == pytest.approx(2 * leg / (one + other - 2 * leg))


def test_places_are_passed_several_times_or_come_too_late() -> None:
    assert share_on_ways(line(5), line(5), [9, 90]) == inf
    assert share_on_ways(line(5), line(5), [90]) == 0
    # The one in the middle is seen twice in each round, so that of the others alone matters.
    assert share_on_ways(line(4, 6), line(3, 5), [50, 50, 50]) == pytest.approx(16 / (100 - 20))


ORDERS = """
poi "hall"
poi "shelf"
poi "desk"
connect hall and shelf distance 2
connect hall and desk distance 2
event "order"
event "pick" location shelf duration 3
event "drop" location desk duration 3
rule "first": pick before drop
agent "bot" controllable mobile 1 location hall can_do pick, drop
agent "guest" location desk can_do order
objective: if order then drop within 58
objective: patrol desk, shelf every 28 by bot
"""


def test_who_is_called_while_it_waits_for_a_patrol_may_see_to_that_first() -> None:
    won = calm(solve_scenario(parse(ORDERS, "x.pur", "x"), DEFAULT), SolveOptions())
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok
    # From one place to the other it takes two ways, 8 with rests. Then each visit could be put off by more than 10, but
    # for an order that comes just before it is due: picking and dropping would have to fit in between.
    driven = driven_while_still(won.network, won.strategy, 1000)
    assert driven is not None and driven < 350
