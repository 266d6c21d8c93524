"""Missions among people who cannot matter, who walk about and say what they like all the time."""

from __future__ import annotations

import functools

import pytest

from benchmarks.families import pass_bystanders
from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, HELD, Settings
from pursue_gen.tools.simulation.remaining import Remaining
from pursue_gen.tools.simulation.stage import Stage, stage_of
from pursue_gen.workspace import Options
from pursue_runtime.state import STOPPED


@functools.lru_cache(maxsize=None)
def crowd() -> Stage:
    text = pass_bystanders(3).replace('event "report"', 'event "report"\nevent "shout"')
    text = text.replace("mobile 3 location hub", "mobile 1 location hub can_do shout")
    scenario = parse(text, "crowd.pur", "crowd")
    return stage_of(scenario, solve_scenario(scenario, Rules()), Options())


def test_their_strategy_names_the_robots_alone() -> None:
    assert {"bot1", "bot2", "person1"} <= {automaton.name for automaton in crowd().model.automata}
    assert crowd().cover.names == {"bot1", "bot2", "reachObj", "rule1", "rule2"}


def test_every_mission_reaches_the_goal_in_time() -> None:
    times = Remaining(crowd().solution)
    alone = parse(pass_bystanders(0), "alone.pur", "alone")
    assert times.bound() == Remaining(solve_scenario(alone, Rules())).bound()
    outcomes = [simulate_mission(crowd(), Settings("random", bound=times.bound()), seed) for seed in range(25)]
    assert {outcome.end for outcome in outcomes} == {GOAL}, [o.reason for o in outcomes if o.end != GOAL][:3]
    assert sum(outcome.steps for outcome in outcomes) > 25 * 20  # they have done something meanwhile


@pytest.mark.parametrize("kind", ["delay", "loss", "restart", "deaths", "late"])
def test_with_faults_missions_reach_the_goal_or_stop_safely(kind: str) -> None:
    outcomes = [simulate_mission(crowd(), Settings("random", (kind,)), seed) for seed in range(8)]
    assert {outcome.end for outcome in outcomes} <= {GOAL, HELD, STOPPED}, [o.reason for o in outcomes]
