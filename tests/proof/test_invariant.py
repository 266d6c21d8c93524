"""Seeing at once that no play leaves what a safety strategy covers: never passed where a play fails."""

from __future__ import annotations

import functools
from dataclasses import replace
from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.lab_scenarios import Size, lab_scenario
from pursue_gen.language import parse
from pursue_gen.proof import checker
from pursue_gen.proof.checker import pruned, verify
from pursue_gen.proof.closed_loop import ClosedLoop
from pursue_gen.proof.independence import named_part
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.policies import won_by_policy
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from tests.oracle.checker import natively
from tests.proof.test_checker import SAFETY, automaton, block, edge, moves, network
from tests.proof.test_checker_random import _all_keys, _changed, networks
from tests.proof.test_parts import REACH, before, since
from tests.proof.test_parts import block as goes_in
from tests.synthesis import random_games
from tests.synthesis.play_by_play import broken
from tests.synthesis.test_verdicts import published

DELAYS = (Fraction(0), Fraction(1, 2), Fraction(1))


def covered(network: Network, objective: Objective, strategy: Strategy, reaction: Fraction) -> bool:
    loop = ClosedLoop(named_part(network, strategy), objective, strategy, reaction, None)
    return loop.covered(LimitMonitor()) is not None


@given(st.data(), networks(), random_games.objectives(Kind.SAFETY), st.sampled_from(DELAYS), st.integers(0, 2))
def test_no_strategy_with_a_losing_play_passes(
    data: st.DataObject, network: Network, objective: Objective, reaction: Fraction, changes: int
) -> None:
    strategy = solve(network, objective, reaction).strategy
    for _ in range(changes):
        if strategy is not None and _all_keys(strategy):
            strategy = _changed(data.draw, strategy)
    if strategy is not None and covered(network, objective, strategy, reaction):
        assert broken(network, objective, strategy, reaction) is None
        assert verify(network, objective, strategy, reaction, prompt=False).ok


@given(st.data(), random_games.networks((Kind.SAFETY,)), st.sampled_from(DELAYS), st.booleans())
def test_what_passes_passes_play_by_play(
    data: st.DataObject, game: Tuple[Network, Objective], reaction: Fraction, change: bool
) -> None:
    network, objective = game
    strategy = solve(network, objective, reaction).strategy
    if strategy is not None and change and _all_keys(strategy):
        strategy = _changed(data.draw, strategy)
    if strategy is not None and covered(network, objective, strategy, reaction):
        assert verify(network, objective, strategy, reaction, prompt=False).ok


def test_who_goes_round_for_ever_leaves_nothing_that_is_covered_and_reaches_no_goal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(checker, "_LARGE", 0)
    steps = [Edge(*pair, Guard((ClockBound("x", ">=", 1),)), resets=("x",)) for pair in (("a", "b"), ("b", "a"))]
    places = Location("a"), Location("b"), Location("done"), Location("lost")
    game = Network(("x",), (), (), (Automaton("A", places, "a", (*steps, Edge("a", "done"))),))
    goes = [goes_in({"A": step.source}, (before("x", 1),), (since("x", 1), "A", step)) for step in steps]
    assert verify(game, Objective(Kind.SAFETY, bad=(("A", "lost"),)), Strategy(tuple(goes))).ok
    assert "for ever" in verify(game, REACH, Strategy(tuple(goes))).reason


@pytest.mark.parametrize("name", ["EB1", "EB3", "WC1", "CT5"])
def test_strategies_of_the_solver_pass_and_what_is_left_of_them_wins(reference_dir, monkeypatch, name):
    network, objective = published(reference_dir, name)
    strategy = solve(network, objective).strategy
    assert strategy is not None
    monkeypatch.setattr(checker, "_LARGE", 0)
    report = verify(network, objective, strategy)
    assert report.ok
    monkeypatch.undo()
    fewer = pruned(strategy, report)
    assert covered(network, objective, fewer, Fraction(0))
    assert verify(network, objective, fewer).ok
    assert len(fewer.blocks) <= len(strategy.blocks)


def test_a_strategy_of_the_solver_with_one_zone_less_passes_only_where_no_play_misses_it(reference_dir):
    network, objective = published(reference_dir, "EB1")
    strategy = solve(network, objective).strategy
    assert strategy is not None
    missed = 0
    for b, whole in enumerate(strategy.blocks):
        fewer = replace(whole, wait=whole.wait[1:], commands=whole.commands if whole.wait else whole.commands[1:])
        without = replace(strategy, blocks=strategy.blocks[:b] + (fewer,) + strategy.blocks[b + 1 :])
        if not verify(network, objective, without).ok:
            missed += 1
            assert not covered(network, objective, without, Fraction(0))
    assert missed > 10


# The bot stands at a place that it has to leave while x <= 3; the environment may hurt it from x = 5 on.
CAREFUL = network(
    automaton("bot", "a:x<=6 b lose", edge("a", "b", "x>=1"), edge("a", "lose", "x>=5", env=True)),
)
LEAVE = moves(CAREFUL, ("bot", 0))


def test_where_points_that_no_play_reaches_lead_astray_plays_are_followed(monkeypatch):
    early = Strategy((block(CAREFUL, "a", ["x<2"], ("x>=2,x<=3", LEAVE)), block(CAREFUL, "b", [""])))
    more = Strategy((block(CAREFUL, "a", ["x<2", "x>4"], ("x>=2,x<=3", LEAVE)), block(CAREFUL, "b", [""])))
    assert covered(CAREFUL, SAFETY, early, Fraction(0))
    assert not covered(CAREFUL, SAFETY, more, Fraction(0))
    for large in (0, 20_000):
        monkeypatch.setattr(checker, "_LARGE", large)
        assert verify(CAREFUL, SAFETY, early).ok
        report = verify(CAREFUL, SAFETY, more)
        assert report.ok
        assert pruned(more, report) == early


def test_a_command_on_its_way_is_followed_to_the_end_of_its_delay():
    late = Strategy((block(CAREFUL, "a", ["x<2"], ("x>=2,x<=3", LEAVE)), block(CAREFUL, "b", [""])))
    assert covered(CAREFUL, SAFETY, late, Fraction(1))
    assert not covered(CAREFUL, SAFETY, late, Fraction(2))
    assert not verify(CAREFUL, SAFETY, late, Fraction(2)).ok


def test_a_strategy_that_does_not_know_the_start_does_not_pass():
    late = Strategy((block(CAREFUL, "a", ["x>1,x<2"], ("x>=2,x<=3", LEAVE)), block(CAREFUL, "b", [""])))
    assert not covered(CAREFUL, SAFETY, late, Fraction(0))


@functools.lru_cache(maxsize=None)
def of_a_rest() -> Tuple[Network, Objective, Strategy]:
    """A game in which a robot rests, and a strategy for it."""
    text = lab_scenario(355329724, Size(places=4, robots=1, people=2, promises=2))
    scenario = parse(text, "lab.pur", "lab")
    game, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    with natively():
        found = won_by_policy(game, objective, Rules().reaction, 10_000_000, SolveOptions())
    assert found is not None
    return game, objective, found.strategy


def test_what_is_not_left_though_extrapolation_leads_out_of_it_is_proven() -> None:
    """The clock of the robot's rest is beyond all bounds there, and forgotten: then a person seems to come too soon."""
    game, objective, strategy = of_a_rest()
    assert verify(game, objective, strategy, Rules().reaction).ok
