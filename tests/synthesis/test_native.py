"""The native engine against brute force on regions, and against the Python reference, on small random games."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import HealthCheck, given, settings

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load, parse
from pursue_gen.synthesis.game import Game, State, compile_game, joint_moves
from pursue_gen.synthesis.native import engine as native
from pursue_gen.synthesis.reference.engine import solve_reference
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import Kind
from pursue_gen.zones.dbm import INF, Dbm
from pursue_gen.zones.federation import Federation
from tests.conftest import thesis_scenario
from tests.synthesis.random_games import games
from tests.synthesis.region_game import RegionGame

pytestmark = pytest.mark.skipif(not native.available(), reason="the native engine is not built here (no compiler)")

EVERY_KIND = (Kind.REACH, Kind.REACH_WHILE_SAFE, Kind.SAFETY)


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 0, 1)))
def test_it_agrees_with_brute_force(game: Game) -> None:
    is_right(game, native.solve_native(game))


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(games((Kind.SAFETY,), (0, 0, 1)))
def test_searches_with_few_moves_agree_with_brute_force(game: Game) -> None:
    is_right(game, native.solve_native(game, moment=0))


def is_right(game: Game, outcome: native.Outcome) -> None:
    """The verdict is that of regions, what is called won is, and commands are usable where they are given."""
    regions = RegionGame(game)
    winning = regions.winning()
    assert outcome.won == regions.won(winning)
    for locations, values, pieces in outcome.blocks:
        state = State(locations, values)
        zones = [(Dbm(game.dim, matrix), action) for matrix, action in pieces]
        whole = Federation(tuple(zone for zone, _ in zones))
        moves = {move.edges: move for move in joint_moves(game, state)}
        for position in (p for p in regions.positions if p[0] == state):
            if whole.contains(position[1]):
                assert position in winning, "nothing that is lost is called won"
            for zone, action in zones:
                if action is not None and zone.contains(position[1]):
                    assert regions.usable(position, moves[action], winning)


@settings(max_examples=100, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)))
def test_nothing_is_said_twice_of_a_position(game: Game) -> None:
    nothing_twice(game)


@pytest.mark.parametrize("reaction", [Fraction(0), Fraction(1, 10)])
def test_nothing_is_said_twice_after_states_were_opened(reaction: Fraction) -> None:
    scenario = load(thesis_scenario("catch_the_thief"))
    nothing_twice(compile_game(ends_reported(translate(scenario), {}), scenario_objective(scenario), reaction))


def nothing_twice(game: Game) -> None:
    """The pieces of each block are disjoint."""
    for _, _, pieces in native.solve_native(game).blocks:
        zones = [Dbm(game.dim, matrix) for matrix, _ in pieces]
        for k, zone in enumerate(zones):
            assert all(zone.intersect(other) is None for other in zones[:k])


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)))
def test_it_agrees_with_the_python_reference(game: Game) -> None:
    assert native.solve_native(game).won == solve_reference(game).won



@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(games(EVERY_KIND, (0, 1)))
def test_times_too_long_for_short_bounds_change_nothing(game: Game) -> None:
    assert native.solve_native(slower(game, 100_000)).won == native.solve_native(game).won


def slower(game: Game, factor: int) -> Game:
    """The game with every time multiplied."""

    def longer(bound: int) -> int:
        return bound if bound >= INF else (bound >> 1) * factor * 2 + (bound & 1)

    return replace(
        game,
        delta=game.delta * factor,
        max_constants=tuple(max(constant, constant * factor) for constant in game.max_constants),
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
    outcome = native.solve_native(game)
    assert outcome.won
    lowest = {
        State(locations, values): min(ranks)
        for (locations, values, _), ranks in zip(outcome.blocks, outcome.ranks)
    }
    for (locations, values, pieces), ranks in zip(outcome.blocks, outcome.ranks):
        moves = {move.edges: move for move in joint_moves(game, State(locations, values))}
        for (_, action), rank in zip(pieces, ranks):
            if action is not None and moves[action].target in lowest:
                assert lowest[moves[action].target] < rank


def test_a_limit_ends_with_a_message_and_status_five() -> None:
    scenario = load(thesis_scenario("catch_the_thief"))
    game = compile_game(translate(scenario), scenario_objective(scenario))
    with pytest.raises(PursueError) as failure:
        native.solve_native(game, states=300)
    assert failure.value.exit_status == 5
    assert "300 discrete states" in str(failure.value)


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
    assert not native.solve_native(game).won, "on a ring of four a thief outruns two officers"
