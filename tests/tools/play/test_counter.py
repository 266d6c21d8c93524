"""Against the counter-strategy: in a game that is lost the robots never win, whatever a person does."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Tuple

import pytest
from hypothesis import given, settings
from players import do, robots, whims

from pursue_gen.tools.play.state import LOST, RUNNING, WON, PlannedMove, PlayState

REACH = (
    ("cage", "", ""),
    ("catch_the_thief/one_officer", "thief\" mobile 2", "thief\" mobile 1"),
)
SAFE = (
    ("late", "", ""),
    ("work_cell/work_cell", "within 30", "within 12"),
)


@pytest.mark.parametrize("name, old, new", REACH)
@settings(max_examples=25)
@given(wishes=whims(most=25))
def test_in_a_lost_game_the_robots_never_reach_the_goal(
    name: str, old: str, new: str, wishes: List[Tuple[int, int]]
) -> None:
    played = robots(name, old, new)
    table = played.setup.beginning()
    for whim in wishes:
        if table.over:
            break
        table = do(played, table, whim)
        assert table.status != WON
        assert table.status == LOST or played.oracle.lost(table.position)


@pytest.mark.parametrize("name, old, new", SAFE)
@settings(max_examples=10)
@given(wishes=whims(most=12))
def test_in_a_lost_safety_game_the_robots_lose_in_time(
    name: str, old: str, new: str, wishes: List[Tuple[int, int]]
) -> None:
    played = robots(name, old, new)
    assert played.horizon is not None
    table = played.setup.beginning()
    for whim in wishes:
        table = table if table.over else do(played, table, whim)
    for _ in range(100):
        table = table if table.over else played.advance(table)
    assert table.status == LOST


@settings(max_examples=10)
@given(wishes=whims(most=15))
def test_where_losing_takes_long_it_stays_lost_all_the_same(wishes: List[Tuple[int, int]]) -> None:
    played = robots("ecobot/ecobot", "within 46", "within 45")
    assert played.horizon is None
    table = played.setup.beginning()
    for whim in wishes:
        if not table.over:
            table = do(played, table, whim)
            assert table.status == LOST or played.oracle.lost(table.position)


def order(table: PlayState, word: str, at: Fraction) -> PlayState:
    """The table with an order of the person for the keeper."""
    return robots("cage").planned(table, PlannedMove("keeper", word, at))


def test_an_order_is_carried_out_if_that_helps_nobody() -> None:
    played = robots("cage")
    table = played.advance(order(played.setup.beginning(), "keeper_yard2exit", Fraction(3)))
    while table.deeds[-1].agent != "keeper":
        table = played.advance(table)
    assert table.deeds[-1].word == "keeper_yard2exit"
    assert 3 <= table.deeds[-1].at <= 3 + played.setup.rules.reaction
    assert table.plans == ()


def test_the_lion_gets_away_when_the_keeper_comes() -> None:
    played = robots("cage")
    table = order(played.setup.beginning(), "keeper_yard2cage", Fraction(2))
    for _ in range(30):
        again = played.advance(table)
        if again == table:
            break
        table = again
        offers = {offer.word: offer for offer in played.offers(table)}
        if "catch" in offers:
            table = order(table, "catch", table.now + (offers["catch"].open_.earliest() or 0))
    assert table.status == RUNNING
    assert "catch" not in [deed.word for deed in table.deeds]


def test_going_round_in_circles_is_noticed() -> None:
    played = robots("cage")
    table = played.setup.beginning()
    assert played.repeats(table) is None
    for word in ("keeper_yard2exit", "keeper_exit2yard") * 3:
        while word not in {offer.word for offer in played.offers(table)}:
            table = played.advance(table)
        offer = next(offer for offer in played.offers(table) if offer.word == word)
        table = order(table, word, table.now + (offer.open_.earliest() or 0))
        while not table.deeds or table.deeds[-1].word != word:
            table = played.advance(table)
    while played.repeats(table) is None:
        before, table = table, played.advance(table)
        assert table != before
    assert played.repeats(table) is not None
