"""Against a strategy whose first stage does not name the visitor."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Tuple

from hypothesis import given, settings
from hypothesis import strategies as st
from players import do, whims

from pursue_gen.synthesis.strategy import Block, Command, Constraint, DiscreteState, Strategy, Zone
from pursue_gen.tools.play.state import GRAIN, ROBOTS, WON, PlannedMove, setup_of
from pursue_gen.tools.play.world import Advisor, StrategyPlay
from tests.two_stages import solved_in_stages


def played(seed: int) -> StrategyPlay:
    scenario, won = solved_in_stages()
    setup = setup_of(scenario, won.rules)
    return StrategyPlay(setup, Advisor(setup, won.strategy), seed)


def test_what_was_decided_stands_when_the_visitor_leaves_meanwhile() -> None:
    met = 0
    for seed in range(20):
        game = played(seed)
        table = game.advance(game.setup.beginning())  # the objective counts
        decided = game.advisor.decision(table)
        event = game.strategy_event(table)
        assert decided is not None and event is not None
        leaves = Fraction(107, 100)  # the robot's zone ends at 1.05
        if not decided.at < leaves < event.at:
            continue
        met += 1
        table = game.advance(game.planned(table, PlannedMove("visitor", "visitor_gate2hub", leaves)))
        assert table.deeds[-1].word == "visitor_gate2hub"
        stands = game.advisor.decision(table)
        assert stands is not None and (stands.at, stands.command) == (decided.at, decided.command)
        assert [holding.command for holding in game.advisor.holdings(table)] == [decided.command]
        table = game.advance(table)
        assert (table.deeds[-1].word, table.deeds[-1].by) == ("bot_hub2depot", ROBOTS)
        assert leaves <= table.deeds[-1].at <= decided.at + game.setup.rules.reaction
    assert met


def test_parts_that_are_played_at_the_same_time_do_not_wait_for_each_other() -> None:
    scenario, won = solved_in_stages()
    setup = setup_of(scenario, won.rules)
    moves = {c.moves[0].automaton: c.moves for b in won.strategy.blocks[:2] for c in b.commands}
    zones = {"bot": interval("Cbot", 1, Fraction(105, 100)), "reachObj": interval("Creach", 1, Fraction(102, 100))}
    places = {"bot": "hub", "reachObj": "initial_location"}
    parts = Strategy(tuple(
        Block(DiscreteState(((name, place),), ()), (), (Command((zones[name],), moves[name]),))
        for name, place in places.items()
    ))  # fmt: skip
    for seed in range(20):
        game = StrategyPlay(setup, Advisor(setup, parts), seed)
        table = game.advance(game.advance(setup.beginning()))
        assert {deed.agent for deed in table.deeds} == set(places)
        assert all(1 < deed.at <= 1 + GRAIN + setup.rules.reaction for deed in table.deeds)
        assert game.advisor.decision(table) is None


def interval(clock: str, low: int, high: Fraction) -> Zone:
    return Constraint(None, clock, Fraction(-low), True), Constraint(clock, None, high, False)


@settings(max_examples=40)
@given(st.integers(0, 999), whims(most=25))
def test_a_won_game_is_won_whatever_a_person_does(seed: int, wishes: List[Tuple[int, int]]) -> None:
    game = played(seed)
    table = game.setup.beginning()
    for whim in wishes:
        if not table.over:
            table = do(game, table, whim)
    for _ in range(300):
        if table.over:
            break
        table = game.advance(table)
    assert table.status == WON
