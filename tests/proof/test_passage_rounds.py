"""Orders of passage that go round and round: what the checker takes as one course of alike rounds wins as a whole."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import floor
from typing import Dict, Optional, Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.proof.checker import verify
from pursue_gen.proof.passage_times import deadlines
from pursue_gen.proof.passages import Fault, played
from pursue_gen.solving.passage_rounds import patrolling
from pursue_gen.solving.passages import crowd_of
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from tests.proof.passing_games import Game, damaged, game_of, of_the_whole, patrolling_texts

DELAY = Fraction(1, 10)
LONG = 500
"""A period that all of these games keep."""

RANDOM = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))

CORRIDOR = """
poi "room1"
poi "room2"
poi "hall"
poi "nook"
connect room1 and hall distance 4
connect room2 and hall distance 4
connect nook and hall distance 2
agent "bot1" controllable mobile 1 location room1
agent "bot2" controllable mobile 1 location room2
objective: every place holds 1 robot
objective: every way holds 1 robot
objective: patrol room1, room2 every EVERY by bot1
objective: patrol nook every EVERY by bot2
"""


@pytest.fixture(scope="module", autouse=True)
def twin() -> None:
    """The course of events is followed in Python alone."""


def with_period(text: str, every: int) -> Game:
    return game_of(text.replace("EVERY", str(every)))


def strategy_for(game: Game) -> Optional[Strategy]:
    crowd = crowd_of(*game)
    return None if crowd is None else patrolling(*game, *crowd, DELAY)


def times_of(game: Game, strategy: Strategy) -> Optional[Dict[str, Fraction]]:
    """How long the patrols take at worst; None where the strategy is refused."""
    try:
        course = played(with_automata_of(game[0], strategy), game[1], strategy, LimitMonitor())
        return deadlines(course, strategy, DELAY)
    except Fault as fault:
        event(str(fault).split(" ")[1])
        return None


def wins_as_a_whole(game: Game, strategy: Strategy) -> None:
    whole = of_the_whole(game, strategy)
    if whole is not None:
        report = verify(whole[0], game[1], whole[1], DELAY, prompt=True)
        assert report.ok, (report.reason, report.play)


def corridor() -> Tuple[Strategy, int]:
    game = with_period(CORRIDOR, LONG)
    strategy = strategy_for(game)
    assert strategy is not None
    times = times_of(game, strategy)
    assert times is not None
    return strategy, floor(max(times.values())) + 1


@RANDOM
@given(text=patrolling_texts())
def test_what_is_found_wins_as_a_whole_with_the_period_that_it_keeps(text: str) -> None:
    game = with_period(text, LONG)
    strategy = strategy_for(game)
    times = None if strategy is None else times_of(game, strategy)
    event("found" if times else "not found")
    if strategy is not None and times:
        shorter = with_period(text, floor(max(times.values())) + 1)
        assert verify(*shorter, strategy, DELAY).ok
        wins_as_a_whole(shorter, strategy)


@RANDOM
@given(data=st.data(), text=patrolling_texts())
def test_what_is_damaged_and_passes_still_wins_as_a_whole(data: st.DataObject, text: str) -> None:
    game = with_period(text, LONG)
    strategy = strategy_for(game)
    for _ in range(data.draw(st.integers(1, 2)) if strategy else 0):
        assert strategy is not None
        strategy = data.draw(damaged(strategy))
    times = None if strategy is None else times_of(game, strategy)
    event("none" if times is None else "passes")
    if strategy is not None and times:
        wins_as_a_whole(with_period(text, floor(max(times.values())) + 1), strategy)


def test_robots_make_way_for_each_other_for_ever() -> None:
    strategy, every = corridor()
    assert all(passage.again for passage in strategy.passages)
    game = with_period(CORRIDOR, every)
    assert verify(*game, strategy, DELAY).ok
    wins_as_a_whole(game, strategy)


def test_a_shorter_period_is_refused() -> None:
    strategy, every = corridor()
    report = verify(*with_period(CORRIDOR, every - 1), strategy, DELAY)
    assert not report.ok
    assert "may be missed" in report.reason


def test_later_commands_need_a_longer_period() -> None:
    strategy, every = corridor()
    assert not verify(*with_period(CORRIDOR, every), strategy, 5 * DELAY).ok
    assert verify(*with_period(CORRIDOR, 2 * every), strategy, 5 * DELAY).ok


def test_an_order_that_ends_keeps_no_patrol() -> None:
    strategy, every = corridor()
    once = tuple(replace(passage, again=False) for passage in strategy.passages)
    report = verify(*with_period(CORRIDOR, every), replace(strategy, passages=once), DELAY)
    assert not report.ok
    assert "go round" in report.reason


def test_who_does_not_come_back_does_not_go_round() -> None:
    strategy, every = corridor()
    blocks = tuple(
        block
        for block in strategy.blocks
        if not any(c.moves[0].edge.target == "going_hall_to_room2" for c in block.commands)
    )
    report = verify(*with_period(CORRIDOR, every), replace(strategy, blocks=blocks), DELAY)
    assert not report.ok
