"""Random scenarios, won by some of the robots and in stages: held against the game as it is, and played."""

from __future__ import annotations

from typing import Optional, Tuple

from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.checker import verify
from pursue_gen.solving.decomposition import won_by_some
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, SAFE, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case
from tests.oracle.checker import in_python
from tests.proof.staged_games import damaged
from tests.proof.test_stages import of_the_whole
from tests.solving.random_stories import stories

RANDOM = settings(max_examples=25, deadline=None, suppress_health_check=list(HealthCheck))
RULES = st.sampled_from((Rules(), IDEAL))
LITTLE = Limits(states=2_000, work=1_000_000)
MANY_BLOCKS = 500
"""Strategies with more blocks that name everything are not looked at as a whole: that takes seconds."""


def game_of(scenario: Scenario, rules: Rules) -> Tuple[Network, Objective]:
    try:
        return played(translate(scenario), rules), scenario_objective(scenario)
    except PursueError:
        assume(False)
        raise


def composed(network: Network, objective: Objective, rules: Rules) -> Optional[Strategy]:
    """What is found for some of the robots or in stages, whatever the game takes in one piece."""
    found = won_by_some(network, objective, rules.reaction, SolveOptions())
    event("not found" if found is None else "in stages" if found.strategy.stages else "by some")
    return None if found is None else found.strategy


def verdict_of(network: Network, objective: Objective, rules: Rules) -> Optional[bool]:
    """Who wins the game as it is; None where that takes more than a little work."""
    try:
        return solve(network, objective, rules.reaction, limits=LITTLE).won
    except PursueError:
        return None


@RANDOM
@given(story=stories(), rules=RULES)
def test_what_is_won_so_is_won_and_both_checkers_say_so(story: Tuple[str, Scenario], rules: Rules) -> None:
    network, objective = game_of(story[1], rules)
    strategy = composed(network, objective, rules)
    if strategy is None:
        return
    assert verdict_of(network, objective, rules) is not False
    report = verify(network, objective, strategy, rules.reaction)
    with in_python():
        assert verify(network, objective, strategy, rules.reaction) == report
    assert report.ok
    if strategy.blocks:
        plan = write_plan(strategy, network, objective)
        assert read_plan(plan, network, "plan.txt") == strategy


@RANDOM
@given(data=st.data(), story=stories())
def test_stages_win_as_a_whole_as_they_are_and_where_they_pass_after_damage(
    data: st.DataObject, story: Tuple[str, Scenario]
) -> None:
    network, objective = game_of(story[1], IDEAL)
    strategy = composed(network, objective, IDEAL)
    if strategy is None or not strategy.stages:
        return
    for _ in range(data.draw(st.integers(0, 2))):
        strategy = data.draw(damaged(network, strategy))
    try:
        passes = verify(network, objective, strategy).ok
    except PursueError:
        return  # it speaks of clocks that its stage does not have
    whole = of_the_whole(network, strategy) if passes else Strategy(())
    if passes and len(whole.blocks) <= MANY_BLOCKS:
        report = verify(network, objective, whole)
        assert report.ok, (report.reason, report.play)


@settings(RANDOM, max_examples=8)
@given(story=stories(), controllers=st.sampled_from(("distributed", "centralized")))
def test_missions_come_to_the_goal_by_commands_that_the_strategy_holds(
    story: Tuple[str, Scenario], controllers: str
) -> None:
    text, scenario = story
    rules = Rules()
    network, objective = game_of(scenario, rules)
    strategy = composed(network, objective, rules)
    if strategy is None:
        return
    won = Solution(network, objective, strategy, rules.reaction, rules=rules)
    runner = MissionRunner(make_case(scenario, won, SolveRequest(controllers=controllers), "random", (), None)[0])
    for seed in range(4):
        mission = simulate_mission(runner.stage, Settings("random", until=1000.0 if objective.goal else 100.0), seed)
        assert mission.end == (GOAL if objective.goal else SAFE), (text, mission)
