"""Positions in the middle of a play: the solver's answers against brute force on regions, on small random games."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Tuple

from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from pursue_gen.explanation.play import Play, counter_plays
from pursue_gen.explanation.position import Position, PositionSolver, beginning_at
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.game import initial_state
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Kind, Location, Network, Objective
from tests.synthesis.random_games import _automaton, objectives
from tests.synthesis.region_game import RegionGame

KINDS = tuple(Kind)
PLENTY = 1200.0


@st.composite
def networks(draw: st.DrawFn, kinds: Tuple[Kind, ...] = KINDS) -> Tuple[Network, Objective]:
    """Two automata as in `random_games`, as a network."""
    clocks = ("x", "y")[: draw(st.integers(1, 2))]
    network = Network(clocks, (("v", 0),), ("a",), tuple(_automaton(draw, clocks, number) for number in range(2)))
    kind = draw(st.sampled_from(kinds))
    return network, draw(objectives(kind))


quick = settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))


def sampled(regions: RegionGame, count: int):
    """Some of the positions, in an order that does not depend on hashes."""
    ordered = sorted(regions.positions, key=lambda p: (p[0].locations, p[0].values, p[1]))
    return ordered[:: max(1, len(ordered) // count)]


@given(networks(), st.sampled_from((0, 1)))
@quick
def test_any_position_is_judged_as_brute_force_judges_it(drawn, delay):
    network, objective = drawn
    regions = RegionGame(compile_game(network, objective, Fraction(delay)))
    winning = regions.winning()
    oracle = PositionSolver(network, objective, Fraction(delay), Budget(Limits(PLENTY)))
    for state, clocks in sampled(regions, 12):
        assert oracle.lost(Position(state, clocks)) is ((state, clocks) not in winning)


@given(networks((Kind.SAFETY,)), st.sampled_from((0, 1)))
@quick
def test_what_is_lost_within_a_time_is_lost_within_more_and_without_a_limit(drawn, delay):
    network, objective = drawn
    game = compile_game(network, objective, Fraction(delay))
    start = Position(initial_state(game), (Fraction(0),) * len(game.clocks))
    oracle = PositionSolver(network, objective, Fraction(delay), Budget(Limits(PLENTY)))
    by_horizon = [oracle.lost(start, Fraction(0), horizon) for horizon in (1, 2, 4, 8, 64)]
    assert by_horizon == sorted(by_horizon)
    assert by_horizon[-1] is oracle.lost(start)


def test_what_comes_after_the_horizon_does_not_count_however_slow_the_controller_is() -> None:
    """The controller leaves A1.l0 within 1 of its entry, where commands take 1; what A0 could do takes longer."""
    reset = Edge("l0", "l1", resets=("x",))
    within = {name: (ClockBound("x", "<=", bound),) for name, bound in (("l0", 1), ("l1", 3))}
    obliged = Automaton("A1", (Location("l0", within["l0"]), Location("l1")), "l0", (reset,))
    other = Automaton(
        "A0", (Location("l0"), Location("l1", within["l1"]), Location("l2")), "l0",
        (Edge("l0", "l0", resets=("x",), controllable=False), Edge("l0", "l1", controllable=False), Edge("l1", "l0")),
    )
    network, objective = Network(("x",), (), (), (other, obliged)), Objective(Kind.SAFETY, bad=(("A0", "l2"),))
    oracle, zero = PositionSolver(network, objective, Fraction(1), Budget(Limits(PLENTY))), (Fraction(0),)
    begin = initial_state(compile_game(network, objective))
    assert oracle.lost(Position(begin, zero), Fraction(0), 1)
    left = Position(replace(begin, locations=(0, 1)), zero)
    assert [oracle.lost(left, Fraction(1), horizon) for horizon in (2, 3)] == [False, False]
    assert oracle.lost(left, Fraction(1), 4) and not oracle.lost(left, Fraction(5), 4)
    assert next(counter_plays(network, objective, Fraction(1), Budget(Limits(PLENTY)))).end == "overdue"


@given(networks(), st.sampled_from((0, 1)))
@quick
def test_a_game_that_begins_at_its_beginning_is_the_same_game(drawn, delay):
    network, objective = drawn
    game = compile_game(network, objective)
    begun = beginning_at(network, initial_state(game), [0] * len(game.clocks))
    assert solve(begun, objective, Fraction(delay)).won is solve(network, objective, Fraction(delay)).won


@given(networks(), st.sampled_from((0, 1)))
@quick
def test_a_counter_play_follows_the_rules_and_never_leaves_what_is_lost(drawn, delay):
    network, objective = drawn
    assume(not solve(network, objective, Fraction(delay)).won)
    play = next(counter_plays(network, objective, Fraction(delay), Budget(Limits(PLENTY))))
    regions = RegionGame(compile_game(network, objective, Fraction(delay)))
    winning = regions.winning()
    for state, clocks in replayed(play):
        region = regions._representative(clocks)
        assert (state, region) in regions.positions
        assert (state, region) not in winning
    if objective.kind is Kind.SAFETY:
        assert play.end in ("bad", "overdue")


def replayed(play: Play):
    """The positions after each step; fails where a step is against the rules (as brute force has them)."""
    regions = RegionGame(play.game)
    state, clocks, now = initial_state(play.game), (Fraction(0),) * len(play.game.clocks), Fraction(0)
    yield state, clocks
    for step in play.steps:
        assert step.at >= now
        clocks = tuple(value + step.at - now for value in clocks)
        now = step.at
        move = next(move for move in regions.moves(state) if move.edges == step.edges)
        assert (state, regions._representative(clocks)) in regions.positions  # the invariants hold
        assert regions._holds(clocks, move.bounds)
        state, clocks = move.target, tuple(Fraction(0) if k + 1 in move.resets else v for k, v in enumerate(clocks))
        yield state, clocks
