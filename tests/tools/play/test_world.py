"""Against the strategy: a game that is won is won, whatever a person does."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from players import do, game, moments, whims, world

from pursue_gen.tools.play.situation import situation
from pursue_gen.tools.play.state import CHANCE, LOST, OTHERS, ROBOTS, RUNNING, WON, PlannedMove
from pursue_gen.tools.play.world import StrategyPlay
from pursue_gen.vocabulary.words import words_of

REACH = ("thesis/scenario_1", "thesis/scenario_2", "thesis/scenario_3", "thesis/scenario_4", "thesis/catch_the_thief",
         "catch_the_thief/one_officer", "museum/film")
SAFE = ("work_cell/work_cell", "ecobot/ecobot")


@given(st.sampled_from(REACH), st.booleans(), st.integers(0, 999), whims(most=25))
def test_a_won_game_is_won_whatever_a_person_does(
    name: str, ideal: bool, seed: int, wishes: List[Tuple[int, int]]
) -> None:
    played = world(name, seed, ideal)
    table = played.setup.beginning()
    for whim in wishes:
        if not table.over:
            table = do(played, table, whim)
    for _ in range(300):
        if table.over:
            break
        table = played.advance(table)
    assert table.status == WON
    assert table.now < 200


@given(st.sampled_from(SAFE), st.integers(0, 999), whims(most=80))
def test_a_safe_game_stays_safe_whatever_a_person_does(name: str, seed: int, wishes: List[Tuple[int, int]]) -> None:
    played = world(name, seed)
    table = played.setup.beginning()
    for whim in wishes:
        table = do(played, table, whim)
        assert table.status == RUNNING


@settings(max_examples=40)
@given(st.sampled_from(REACH + SAFE), st.integers(0, 999), whims(most=30))
def test_every_step_is_in_its_window_and_in_order(name: str, seed: int, wishes: List[Tuple[int, int]]) -> None:
    played = world(name, seed)
    table = played.setup.beginning()
    for whim in wishes:
        if table.over:
            break
        last = played.setup.last_moment(table)
        after = do(played, table, whim)
        assert table.now <= after.now
        assert last is None or after.now <= last
        assert after.deeds[: len(table.deeds)] == table.deeds
        for deed in after.deeds[len(table.deeds):]:
            assert table.now <= deed.at <= after.now
            assert all(clock >= 0 for clock in deed.after.clocks)
        table = after


def test_looking_again_and_again_changes_nothing() -> None:
    played = world("thesis/scenario_1", 7)
    through, slowly = played.setup.beginning(), played.setup.beginning()
    while not through.over:
        through = played.advance(through)
    while not slowly.over:
        slowly = played.advance(slowly, slowly.now + Fraction(1, 8))
    assert slowly.deeds == through.deeds


def test_the_seed_decides_what_nobody_says() -> None:
    plays = set()
    for seed in range(8):
        played = world("thesis/scenario_1", seed)
        table = played.setup.beginning()
        while not table.over:
            table = played.advance(table)
        plays.add(tuple(deed.at for deed in table.deeds))
        again = played.setup.beginning()
        while not again.over:
            again = played.advance(again)
        assert again == table
    assert len(plays) > 4


def test_a_person_may_say_when_a_movement_ends() -> None:
    played = world("thesis/scenario_1", 1)
    table = played.setup.beginning()
    while not (offers := [offer for offer in played.offers(table) if offer.drawn is not None]):
        table = played.advance(table)
    offer = offers[0]
    at = moments(offer, table.now, 7)
    assert at != offer.drawn
    table = played.planned(table, PlannedMove(offer.agent, offer.word, at))
    while (offer.agent, offer.word) not in {(deed.agent, deed.word) for deed in table.deeds}:
        table = played.advance(table)
    deed = next(deed for deed in table.deeds if deed.word == offer.word)
    assert (deed.at, deed.by) == (at, OTHERS)


def test_what_is_planned_for_later_happens_then_and_not_before() -> None:
    played = world("thesis/catch_the_thief", 1)
    table = played.setup.beginning()
    offer = played.offers(table)[0]
    table = played.planned(table, PlannedMove(offer.agent, offer.word, Fraction(7, 2)))
    while not any(deed.agent == "thief" for deed in table.deeds):
        assert table.plans and table.now < Fraction(7, 2)
        table = played.advance(table)
    assert table.deeds[-1].at == Fraction(7, 2)
    assert table.plans == ()


def test_who_did_what_is_reported() -> None:
    played = world("thesis/scenario_1", 1)
    table = played.setup.beginning()
    while not table.over:
        table = played.advance(table)
    assert {deed.by for deed in table.deeds} == {ROBOTS, CHANCE}


def test_a_strategy_that_does_nothing_would_lose() -> None:
    """The judge of these tests can tell: with an empty strategy the deadline passes."""
    played = game("work_cell/work_cell")
    assert isinstance(played, StrategyPlay)

    class Nobody:
        size = 0

        def decision(self, table: object) -> None:
            return None

    lazy = replace(played, advisor=Nobody())
    table = lazy.setup.beginning()
    offer = next(offer for offer in lazy.offers(table) if offer.word == "newBox")
    table = lazy.planned(table, PlannedMove(offer.agent, offer.word, Fraction(2)))
    while not table.over:
        table = lazy.advance(table)
    assert (table.status, table.now) == (LOST, 32)


@pytest.mark.parametrize("name", SAFE)
def test_where_nobody_does_anything_nothing_happens(name: str) -> None:
    played = world(name, 1)
    table = played.setup.beginning()
    for _ in range(20):
        after = played.advance(table)
        if after == table:
            break
        table = after
    assert played.advance(table) == table
    assert played.advance(table, table.now + 5).now == table.now + 5


def test_a_partner_is_busy_as_long_as_the_one_who_does_it() -> None:
    played = world("museum/film", 1)
    words = words_of(played.setup.scenario, played.setup.network)
    table = played.setup.beginning()
    while "doing showFilm at hall" not in "".join(situation(played.setup, words, table)):
        table = played.advance(table)
    lines = [line.split(None, 1) for line in situation(played.setup, words, table)]
    assert dict(lines)["visitor"] == dict(lines)["guide"] and "ends between" in dict(lines)["guide"], lines
    assert not any(offer.agent == "visitor" for offer in played.offers(table)), "it can do nothing else"
