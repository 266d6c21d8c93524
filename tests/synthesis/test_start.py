"""Games that start in the middle of a play: a zone of clocks is won where each of its points is."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import List, Tuple

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.proof.checker import verify
from pursue_gen.proof.worst_case import worst_case
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import initial_state, start_zone
from pursue_gen.synthesis.native.engine import NativeEngine
from pursue_gen.synthesis.relaxed import least_time
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Block, DiscreteState, Strategy
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Constraint,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
)
from pursue_gen.tga.uppaal import write_network
from tests.oracle import ENGINES
from tests.oracle.engine import ReferenceEngine
from tests.synthesis.random_games import started
from tests.synthesis.region_game import RegionGame
from tests.synthesis.test_engines import ALL

EVERY_KIND = (Kind.REACH, Kind.REACH_WHILE_SAFE, Kind.SAFETY)
DELAYS = st.sampled_from((Fraction(0), Fraction(1)))
QUICK = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


Drawn = Tuple[Network, Objective]


@QUICK
@given(drawn=started(EVERY_KIND), delay=DELAYS)
def test_engines_agree_with_brute_force(drawn: Drawn, delay: Fraction) -> None:
    game = compile_game(*drawn, delay)
    regions = RegionGame(game)
    won = regions.won(regions.winning())
    assert [engine.solve(game).won for engine in ALL] == [won] * len(ALL)


@QUICK
@given(started(EVERY_KIND), st.sampled_from((Fraction(0), Fraction(1, 2))))
def test_both_engines_agree_on_finer_grids(drawn: Drawn, delay: Fraction) -> None:
    network, objective = drawn
    finer = replace(network, start=tuple(replace(c, bound=c.bound + Fraction(1, 3)) for c in network.start))
    game = compile_game(finer, objective, delay)
    assert game.scale == (6 if delay else 3)
    assert NativeEngine().solve(game).won == ReferenceEngine().solve(game).won


@QUICK
@given(started(EVERY_KIND), DELAYS)
def test_the_checker_agrees_with_the_engines(drawn: Drawn, delay: Fraction) -> None:
    network, objective = drawn
    verdict = solve(network, objective, delay)
    if verdict.strategy is not None:
        report = verify(network, objective, verdict.strategy, delay)
        assert report.ok, report.reason


@QUICK
@given(started(EVERY_KIND), DELAYS)
def test_the_checker_never_accepts_a_strategy_where_the_game_is_lost(drawn: Drawn, delay: Fraction) -> None:
    network, objective = drawn
    if solve(network, objective, delay).won:
        return
    for strategy in (_waiting(network), *_strategies_for_one_point(network, objective, delay)):
        assert not verify(network, objective, strategy, delay).ok


def _waiting(network: Network) -> Strategy:
    places = tuple((automaton.name, automaton.initial) for automaton in network.automata)
    return Strategy((Block(DiscreteState(places, network.variables), ((),), ()),))


def _strategies_for_one_point(network: Network, objective: Objective, delay: Fraction) -> List[Strategy]:
    """What wins when all clocks are 0 need not win from the whole zone."""
    verdict = solve(replace(network, start=()), objective, delay)
    return [] if verdict.strategy is None else [verdict.strategy]


# By hand.


def _wait_for(bound: int, deadline: int) -> Network:
    """`go` may be taken once y is above the bound; x stops everything at the deadline."""
    location = Location("here", (ClockBound("x", "<=", deadline),))
    go = Edge("here", "there", Guard((ClockBound("y", ">", bound),)))
    return Network(("x", "y"), (), (), (Automaton("A", (location, Location("there")), "here", (go,)),))


GOAL = Objective(Kind.REACH, goal=(("A", "there"),))


def _between(clock: str, low: Fraction, high: Fraction) -> Tuple[Constraint, ...]:
    return Constraint(None, clock, -low, False), Constraint(clock, None, high, False)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_start_is_won_as_far_as_all_its_points_are(engine: str) -> None:
    network = _wait_for(3, 4)

    def won(*start: Constraint) -> bool:
        return solve(replace(network, start=start), GOAL, engine=ENGINES[engine]).won

    half = Fraction(1, 2)
    exact = _between("y", half, half)
    assert won(*_between("x", Fraction(0), Fraction(1)), *exact)
    assert not won(*_between("x", Fraction(0), 3 * half), *exact), "x = 3/2 is at the deadline when y is 3"
    assert won(*_between("x", Fraction(0), Fraction(1)), *exact, Constraint("x", None, 3 * half, True))
    assert not won(*_between("x", Fraction(4), Fraction(5)), *_between("y", Fraction(9), Fraction(9)))
    assert won(*_between("x", Fraction(4), Fraction(4)), Constraint(None, "y", Fraction(-900), False))


def test_a_start_that_cannot_be_is_reported_by_engine_and_checker() -> None:
    network = replace(_wait_for(3, 4), start=(*_between("x", Fraction(2), Fraction(1)),))
    with pytest.raises(PursueError, match="at the start"):
        compile_game(network, GOAL)
    with pytest.raises(PursueError, match="at the start"):
        verify(network, GOAL, Strategy(()))
    unknown = replace(network, start=_between("z", Fraction(0), Fraction(1)))
    with pytest.raises(PursueError, match="unknown clock"):
        compile_game(unknown, GOAL)


def test_the_start_of_a_network_is_zero_unless_it_says_otherwise() -> None:
    game = compile_game(_wait_for(3, 4), GOAL)
    assert start_zone(game).contains((0, 0)) and not start_zone(game).contains((0, Fraction(1, 2)))
    assert initial_state(game).locations == (0,)


def test_times_to_the_goal_count_from_the_start() -> None:
    begun = replace(
        _wait_for(3, 9), start=(*_between("x", Fraction(2), Fraction(2)), *_between("y", Fraction(1), Fraction(2)))
    )
    verdict = solve(begun, GOAL, engine=ENGINES["python"])
    assert verdict.strategy is not None
    assert worst_case(begun, GOAL, verdict.strategy) == pytest.approx(2, abs=0.01)
    assert least_time(compile_game(begun, GOAL)) == 1


def test_uppaal_cannot_be_reported_where_clocks_start() -> None:
    begun = replace(_wait_for(3, 9), start=_between("x", Fraction(2), Fraction(2)))
    with pytest.raises(PursueError, match="do not start at 0"):
        write_network(begun, GOAL)
