"""What only the native engine has: short and long bounds, ranks; and that it agrees with the reference."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, given, settings

from benchmarks.families import catch_by_places
from pursue_gen.language import load, parse
from pursue_gen.proof.checker import verify
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import Game, State, joint_moves
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.zones.dbm import INF
from tests.conftest import thesis_scenario
from tests.oracle.engine import ReferenceEngine
from tests.synthesis.random_games import games
from tests.synthesis.test_engines import EVERY_KIND, is_well_formed

NATIVE = NativeEngine()


@pytest.mark.parametrize("reaction", [Fraction(0), Fraction(1, 10)])
def test_an_outcome_is_well_formed_after_states_were_opened(reaction: Fraction) -> None:
    scenario = load(thesis_scenario("catch_the_thief"))
    game = compile_game(ends_reported(translate(scenario), {}), scenario_objective(scenario), reaction)
    is_well_formed(game, NATIVE.solve(game))


def test_a_search_that_mostly_explores_is_not_done_twice() -> None:
    """In a ring of rooms states are many, and each is decided in few zones."""
    scenario = parse(catch_by_places(12), "ring.pur", "ring")
    game = compile_game(ends_reported(translate(scenario), {}), scenario_objective(scenario), Fraction(1, 10))
    alone, at_first, in_turn = (NativeEngine(budget).solve(game) for budget in (1e9, 1, 0))
    assert alone.won and at_first.won and in_turn.won
    assert at_first.stats.work < 1.1 * alone.stats.work < 0.9 * in_turn.stats.work
    assert NativeEngine(5).giving_first(7).small_budget == 7 == NativeEngine(7).giving_first(5).small_budget


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)))
def test_it_agrees_with_the_python_reference(game: Game) -> None:
    assert NATIVE.solve(game).won == ReferenceEngine().solve(game).won


@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)))
def test_times_too_long_for_short_bounds_change_nothing(game: Game) -> None:
    assert NATIVE.solve(slower(game, 100_000)).won == NATIVE.solve(game).won


def slower(game: Game, factor: int) -> Game:
    """The game with every time multiplied."""

    def longer(bound: int) -> int:
        return bound if bound >= INF else (bound >> 1) * factor * 2 + (bound & 1)

    return replace(
        game,
        delta=game.delta * factor,
        automata=tuple(
            replace(
                automaton,
                invariants=tuple(tuple((x, longer(b)) for x, b in location) for location in automaton.invariants),
            )
            for automaton in game.automata
        ),
        edges=tuple(
            replace(edge, bounds=tuple((i, j, longer(b)) for i, j, b in edge.bounds), duration=edge.duration * factor)
            for edge in game.edges
        ),
    )


def test_ranks_fall_with_every_command() -> None:
    scenario = load(thesis_scenario("catch_the_thief"))
    game = compile_game(ends_reported(translate(scenario), {}), scenario_objective(scenario))
    outcome = NATIVE.solve(game)
    assert outcome.won and outcome.ranks is not None
    lowest = {
        State(locations, values): min(ranks)
        for (locations, values, _), ranks in zip(outcome.blocks, outcome.ranks)
    }
    for (locations, values, pieces), ranks in zip(outcome.blocks, outcome.ranks):
        moves = {move.edges: move for move in joint_moves(game, State(locations, values))}
        for (_, action), rank in zip(pieces, ranks):
            if action is not None and moves[action].target in lowest:
                assert lowest[moves[action].target] < rank


@pytest.mark.parametrize("reaction", [Fraction(0), Fraction(1, 10)])
def test_a_strategy_speaks_of_nothing_that_no_play_reaches(reaction: Fraction) -> None:
    scenario = load(str(thesis_scenario("1").parents[1] / "catch_the_thief" / "one_officer.pur"))
    network, objective = ends_reported(translate(scenario), {}), scenario_objective(scenario)
    verdict = solve(network, objective, reaction)
    assert verdict.strategy is not None
    report = verify(network, objective, verdict.strategy, reaction, ranks=verdict.ranks)
    assert report.ok
    assert {b for b, _, _ in report.used} == set(range(len(verdict.strategy.blocks)))


RING = """
poi "a" poi "b" poi "c" poi "d"
connect a and b distance 10 connect b and c distance 10 connect c and d distance 10 connect d and a distance 10
event "catch" collaborative
agent "first" controllable mobile 1 location a can_do catch
agent "second" controllable mobile 1 location a can_do catch
agent "thief" mobile 1 location c reacts_to catch
reach_objective: do catch after 0
"""


@pytest.mark.parametrize("reaction", [Fraction(0), Fraction(1, 10)])
def test_a_search_that_has_to_open_states_again_and_again_stays_right(reaction: Fraction) -> None:
    scenario = parse(RING, "ring.pur")
    game = compile_game(translate(scenario), scenario_objective(scenario), reaction)
    assert not NATIVE.solve(game).won, "on a ring of four a thief outruns two officers"


def test_what_few_moves_win_bit_by_bit_is_decided_with_all_of_them() -> None:
    """A robot that has to be at two places again and again wins a little more with each round, as long as it does not
    try what does not lead to the goal."""
    text = """
    poi "store"
    poi "desk"
    connect store and desk distance 5
    event "sign" location desk duration 9
    event "call" at_most 3 times
    event "meet" collaborative location store
    agent "bot" controllable mobile 1 location store can_do sign, meet
    agent "guest" mobile 2 location store can_do call reacts_to meet
    objective: patrol store, desk every 41 by bot
    reach_objective: do meet and sign after 6 within 60
    """
    scenario = parse(text, "x.pur", "x")
    game = played(translate(scenario), Rules()), scenario_objective(scenario), Fraction(1, 10)
    verdict = solve(*game, limits=Limits(seconds=60))
    assert not verdict.won and verdict.stats.work < 20_000_000
    assert not solve(*game, soonest=True).won
