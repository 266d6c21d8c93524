"""The reference engine: known verdicts, and against brute force on regions for small random games."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import List, Tuple

import pytest
from hypothesis import HealthCheck, given, settings

from pursue_gen.language import load
from pursue_gen.proof.checker import verify
from pursue_gen.synthesis.game import Game, compile_game, joint_moves
from pursue_gen.synthesis.reference.engine import Outcome, solve_reference
from pursue_gen.synthesis.strategy_from import followed, to_strategy
from pursue_gen.tga import ends_reported, scenario_objective, translate
from pursue_gen.tga.network import (
    Automaton,
    ClockBound,
    Edge,
    Guard,
    Kind,
    Location,
    Network,
    Objective,
)
from pursue_gen.tga.uppaal import read_network, read_query
from pursue_gen.zones.federation import Federation
from tests.conftest import thesis_scenario
from tests.synthesis.random_games import games
from tests.synthesis.region_game import RegionGame

DEFAULT = Fraction(1, 10)


def _published(folder: Path, name: str, default: bool) -> Tuple[Network, Objective, Fraction]:
    network = read_network((folder / name / "TGA.xml").read_text(), "TGA.xml")
    objective = read_query((folder / name / "TCTL.q").read_text(), "TCTL.q")
    return (ends_reported(network, {}), objective, DEFAULT) if default else (network, objective, Fraction(0))


@pytest.mark.parametrize(
    ("name", "default", "won"),
    [
        ("CT1", False, True),
        ("CT2a", False, True),
        ("WC1", False, True),
        ("WC2a", False, False),
        ("EB1", False, True),
        ("CT1", True, True),
        ("CT2a", True, True),
        ("WC1", True, True),
        ("WC2a", True, False),
        ("EB1", True, False),
    ],
)
def test_verdicts_of_published_scenarios(reference_dir: Path, name: str, default: bool, won: bool) -> None:
    network, objective, reaction = _published(reference_dir, name, default)
    game = compile_game(network, objective, reaction)
    outcome = solve_reference(game)
    assert outcome.won == won
    assert bool(outcome.blocks) == won
    if won:
        report = verify(network, objective, to_strategy(game, outcome.raw_blocks()), reaction)
        assert report.ok, report.reason


@pytest.mark.parametrize("number", ["1", "2", "3", "4"])
@pytest.mark.parametrize("default", [False, True])
def test_the_thesis_scenarios_are_won_and_few_states_are_looked_at(number: str, default: bool) -> None:
    scenario = load(str(thesis_scenario(number)))
    network = translate(scenario)
    game = compile_game(
        ends_reported(network, {}) if default else network,
        scenario_objective(scenario),
        DEFAULT if default else Fraction(0),
    )
    outcome = solve_reference(game)
    assert outcome.won
    # Scenario 4 has 69,741 discrete states in the default game.
    assert outcome.stats.states < 150
    strategy = to_strategy(game, followed(game, outcome.raw_blocks()))
    played = ends_reported(network, {}) if default else network
    report = verify(played, scenario_objective(scenario), strategy, DEFAULT if default else Fraction(0))
    assert report.ok, report.reason


def test_exhaustive_and_directed_agree_on_a_published_scenario(reference_dir: Path) -> None:
    game = compile_game(*_published(reference_dir, "CT1", False))
    everything = solve_reference(game, directed=False)
    assert everything.won
    assert everything.stats.states == 300, "as many discrete states as other solvers count"
    assert solve_reference(game).stats.states < everything.stats.states


# Small games by hand, one for each rule.


def _network(*automata: Automaton, channels: Tuple[str, ...] = (), clocks: Tuple[str, ...] = ("x",)) -> Network:
    return Network(clocks, (), channels, automata)


def _automaton(name: str, invariant: int, *edges: Edge) -> Automaton:
    places = (
        Location("start", (ClockBound("x", "<=", invariant),) if invariant else ()),
        Location("goal"),
        Location("bad"),
    )
    return Automaton(name, places, "start", edges)


def _edge(target: str, op: str, bound: int, controllable: bool) -> Edge:
    return Edge("start", target, Guard((ClockBound("x", op, bound),)), controllable=controllable)


REACH = Objective(Kind.REACH, goal=("A", "goal"))
SAFETY = Objective(Kind.SAFETY, bad=("A", "bad"))
BOTH = Objective(Kind.REACH_WHILE_SAFE, goal=("A", "goal"), bad=("A", "bad"))


def _won(objective: Objective, *automata: Automaton, reaction: Fraction = Fraction(0)) -> bool:
    return solve_reference(compile_game(_network(*automata), objective, reaction)).won


def test_the_environment_wins_ties() -> None:
    mine, harm = _edge("goal", ">=", 1, True), _edge("bad", ">=", 1, False)
    assert not _won(REACH, _automaton("A", 0, mine, harm))
    assert _won(REACH, _automaton("A", 0, mine, _edge("bad", ">=", 2, False)))
    assert not _won(REACH, _automaton("A", 0, _edge("goal", ">", 1, True), _edge("bad", ">", 1, False)))


def test_an_automaton_of_the_environment_at_its_bound_must_move() -> None:
    assert _won(REACH, _automaton("A", 2, _edge("goal", ">", 1, False)))
    assert not _won(REACH, _automaton("A", 0, _edge("goal", ">", 1, False))), "without a bound it need not"
    assert not _won(REACH, _automaton("A", 2, _edge("goal", ">", 1, False), _edge("bad", ">", 1, False)))


def test_blocked_by_an_automaton_that_the_environment_cannot_move() -> None:
    blocker = Automaton("B", (Location("start", (ClockBound("x", "<=", 1),)),), "start", ())
    lazy = _automaton("A", 0, _edge("goal", ">", 0, False))
    assert not _won(REACH, lazy, blocker), "blocked, and nobody of the environment at a bound: waiting loses"
    assert not _won(SAFETY, _automaton("A", 0), blocker), "a time lock that nobody can leave loses"
    assert not _won(SAFETY, _automaton("A", 2, _edge("bad", ">", 1, True))), "the deadline of a safety objective"
    assert _won(SAFETY, _automaton("A", 2, _edge("bad", ">", 1, True), _edge("goal", ">", 1, True)))
    assert _won(SAFETY, _automaton("A", 0, _edge("bad", ">", 1, True))), "waiting for ever is fine"


def test_reach_while_safe_counts_only_what_stays_safe() -> None:
    detour = Edge("bad", "goal")
    assert _won(REACH, _automaton("A", 0, _edge("bad", ">", 1, True), detour))
    assert not _won(BOTH, _automaton("A", 0, _edge("bad", ">", 1, True), detour))
    assert _won(BOTH, _automaton("A", 0, _edge("bad", ">", 1, True), detour, _edge("goal", ">", 3, True)))


def test_a_late_command_needs_room() -> None:
    window = Edge("start", "goal", Guard((ClockBound("x", ">=", 1), ClockBound("x", "<=", 2))))
    assert _won(REACH, _automaton("A", 0, window), reaction=Fraction(1))
    assert not _won(REACH, _automaton("A", 0, window), reaction=Fraction(11, 10))
    # The environment may come first as long as the command is on its way.
    harm = _edge("bad", ">=", 2, False)
    assert _won(REACH, _automaton("A", 0, window, harm), reaction=Fraction(1, 2))
    assert not _won(REACH, _automaton("A", 0, window, harm), reaction=Fraction(1))


def test_the_zones_of_a_strategy_are_disjoint_and_commands_are_moves(reference_dir: Path) -> None:
    for name in ("CT1", "WC1"):
        game = compile_game(*_published(reference_dir, name, False))
        outcome = solve_reference(game)
        for state, pieces in outcome.blocks:
            moves = {move.edges for move in joint_moves(game, state) if move.controllable}
            for k, (zone, action) in enumerate(pieces):
                assert action is None or action in moves
                assert all(zone.intersect(other) is None for other, _ in pieces[:k])


# Random small games.


def _agrees(game: Game, outcomes: List[Outcome]) -> None:
    regions = RegionGame(game)
    winning = regions.winning()
    for outcome in outcomes:
        assert outcome.won == regions.won(winning)
        for state, pieces in outcome.blocks:
            whole = Federation(tuple(zone for zone, _ in pieces))
            moves = {move.edges: move for move in joint_moves(game, state)}
            here = [position for position in regions.positions if position[0] == state]
            for position in here:
                if whole.contains(position[1]):
                    assert position in winning, "nothing that is lost is called won"
                for zone, action in pieces:
                    if action is not None and zone.contains(position[1]):
                        assert regions.usable(position, moves[action], winning)


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(games((Kind.REACH, Kind.REACH_WHILE_SAFE), (0, 0, 1)))
def test_reach_agrees_with_brute_force(game: Game) -> None:
    _agrees(game, [solve_reference(game), solve_reference(game, directed=False)])


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(games((Kind.SAFETY,), (0, 0, 1)))
def test_safety_agrees_with_brute_force(game: Game) -> None:
    _agrees(game, [solve_reference(game)])


def test_a_game_that_starts_at_the_goal() -> None:
    here = Objective(Kind.REACH, goal=("A", "start"))
    game = compile_game(_network(_automaton("A", 0)), here)
    outcome = solve_reference(game)
    assert outcome.won
    assert not outcome.blocks, "nothing is left to do"
