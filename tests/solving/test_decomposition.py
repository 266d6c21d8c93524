"""Games of many agents: some of the robots suffice, or a subgoal is met after the other."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any, Callable, List, Set

import pytest

from benchmarks import families
from benchmarks.families import catch_by_places, catch_by_robots, clean_by_robots, deliver_by_robots, hand_to_visitors
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.checker import verify
from pursue_gen.solving.decomposition import has_parts, won_by_some
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.solution import Solution, guaranteed, solution
from pursue_gen.solving.subgoals import subgoals
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.replay.game import Source, game_of
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case

DELAY = Fraction(1, 10)

MUSEUM = (Path(families.__file__).parent / "stories/museum.pur").read_text()


def scenario_of(text: str) -> Scenario:
    return parse(text, "crowd.pur", "crowd")


def won_so(text: str) -> Solution:
    """What is found for some of the robots or in stages, proven once more."""
    scenario = scenario_of(text)
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = won_by_some(network, objective, DELAY, SolveOptions())
    assert found is not None
    assert verify(network, objective, found.strategy, DELAY).ok
    return Solution(network, objective, found.strategy, DELAY, found.stats)


def named(strategy: Strategy) -> Set[str]:
    """Everybody of whom the strategy ever speaks."""
    return {name for block in strategy.blocks for name, _ in block.state.locations}


@pytest.mark.parametrize("family, robot", [(catch_by_robots, "officer1"), (clean_by_robots, "bot1")])
def test_where_one_robot_suffices_the_others_do_not_matter(family: Callable[[int], str], robot: str) -> None:
    strategy = won_so(family(20)).strategy
    assert strategy.stages == ()
    assert {name for name in named(strategy) if name.startswith(("officer", "bot"))} == {robot}


def test_twenty_robots_cost_twenty_small_games() -> None:
    few, many = won_so(deliver_by_robots(5)), won_so(deliver_by_robots(20))
    assert [len(milestones) for milestones in many.strategy.stages] == [20, 1]
    assert many.stats is not None and few.stats is not None
    assert many.stats.discrete_states < 5 * few.stats.discrete_states
    assert len(many.strategy.blocks) < 5 * len(few.strategy.blocks)


def test_a_strategy_that_gives_way_to_one_in_stages_is_not_proven_first(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: Any, **__: Any) -> Strategy:
        raise AssertionError("it is proven in one piece")

    scenario = scenario_of(deliver_by_robots(4))
    monkeypatch.setattr("pursue_gen.solving.solution.prove", refused)
    won = solution(translate(scenario), scenario_objective(scenario), Rules())
    assert won.strategy.stages
    assert verify(won.network, won.objective, won.strategy, DELAY).ok


def test_visitors_are_met_one_after_the_other() -> None:
    won = won_so(hand_to_visitors(4))
    assert [milestone for (milestone,) in won.strategy.stages] == [
        ("rule1", "rule10"), ("rule2", "rule20"), ("rule3", "rule30"), ("rule4", "rule40"), ("reachObj", "win")
    ]  # fmt: skip
    for block in won.strategy.blocks:
        assert sum(name.startswith("visitor") for name, _ in block.state.locations) <= 1, "the others may be anywhere"


def test_what_makes_a_threat_impossible_comes_first() -> None:
    first, *others = won_so(MUSEUM).strategy.stages
    assert first == (("Slocked", "1"),)
    assert others == [(("visit", "visit0"), ("floor", "floor0")), (("reachObj", "win"),)]


def test_in_the_ideal_game_a_later_stage_ends_what_robots_were_doing() -> None:
    """The watchman may still be at work when the vault is locked; nobody but the controller ends that."""
    scenario = scenario_of(MUSEUM)
    network, objective = played(translate(scenario), IDEAL), scenario_objective(scenario)
    found = won_by_some(network, objective, Fraction(0), SolveOptions())
    assert found is not None and verify(network, objective, found.strategy).ok
    assert found.strategy.stages[0] == (("Slocked", "1"),)
    later = [block for part, block in zip(found.strategy.parts, found.strategy.blocks) if part and part[0] > 0]
    assert any(("watchman", "doing_lock_in_vault") in block.state.locations for block in later)


def test_a_game_that_takes_little_work_is_solved_in_one_piece() -> None:
    scenario = scenario_of(hand_to_visitors(1))
    won = solution(translate(scenario), scenario_objective(scenario), Rules())
    assert won.strategy.stages == () and won.guarantee is None


@pytest.mark.parametrize(
    "text, parts",
    [
        (catch_by_places(4), False),
        (catch_by_robots(2), True),
        (hand_to_visitors(1), True),
        (clean_by_robots(1), True),
    ],
    ids=["one chase", "two officers", "two things to do", "to guard"],
)
def test_one_robot_with_one_thing_to_do_has_a_game_in_one_piece_alone(text: str, parts: bool) -> None:
    scenario = scenario_of(text)
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    assert has_parts(network, objective) is parts
    if not parts:
        assert won_by_some(network, objective, DELAY, SolveOptions()) is None


def test_where_there_are_no_parts_the_game_is_searched_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """With so little work for a first try, a search that is given up would be begun anew."""
    games: List[object] = []

    def counted(*given: Any, **named: Any) -> Verdict:
        games.append(named.get("first"))
        return solve(*given, **named)

    monkeypatch.setattr("pursue_gen.solving.decomposition._FIRST", 1)
    monkeypatch.setattr("pursue_gen.solving.solution.solve", counted)
    monkeypatch.setattr("pursue_gen.solving.without_pauses.solve", counted)
    scenario = scenario_of(catch_by_places(4))
    assert solution(translate(scenario), scenario_objective(scenario), Rules()).strategy.blocks
    assert games == [1]


def test_a_larger_one_is_solved_in_stages() -> None:
    scenario = scenario_of(hand_to_visitors(4))
    network, objective = translate(scenario), scenario_objective(scenario)
    assert len(solution(network, objective, Rules()).strategy.stages) == 5


def test_a_strategy_with_a_block_for_every_order_of_arrivals_gives_way_to_one_in_stages() -> None:
    scenario = scenario_of(deliver_by_robots(3))
    network, objective = translate(scenario), scenario_objective(scenario)
    won = solution(network, objective, Rules())
    whole = solution(network, objective, Rules(), SolveOptions(whole=True))
    assert len(won.strategy.stages) == 2 and whole.strategy.stages == ()
    assert 2 * len(won.strategy.blocks) <= len(whole.strategy.blocks)
    slow, quick = guaranteed(won).worst, guaranteed(whole).worst
    assert slow is not None and quick is not None and slow <= Fraction(11, 10) * quick


def test_what_cannot_be_won_is_not() -> None:
    slow = hand_to_visitors(2).replace("controllable mobile 1", "controllable mobile 4")
    scenario = scenario_of(slow)
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = won_by_some(network, objective, DELAY, SolveOptions())
    assert found is None or verify(network, objective, found.strategy, DELAY).ok


CARRIED = """
poi "p0"
poi "p1"
connect p0 and p1 distance 2
event "load" location p1
event "greet"
event "report"
rule "papers": load before report
rule "goods": (load or greet) before report
agent "bot" controllable mobile 1 location p0 can_do load, greet, report
{}reach_objective: do report
"""


def test_a_subgoal_that_is_met_with_an_earlier_one_has_no_stage() -> None:
    assert won_so(CARRIED.format("")).strategy.stages == ((("papers", "papers0"),), (("reachObj", "win"),))


def test_a_threat_that_no_value_can_make_impossible_is_no_fault() -> None:
    scenario = scenario_of(CARRIED.format("objective: avoid load\n"))
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    assert won_by_some(network, objective, DELAY, SolveOptions()) is None


def test_subgoals_come_before_what_needs_them() -> None:
    scenario = scenario_of(deliver_by_robots(2))
    goals = subgoals(translate(scenario), ("reachObj", "win"))
    assert [(goal.place[0], sorted(goal.agents)) for goal in goals] == [
        ("rule1", ["bot1"]), ("rule2", ["bot2"]), ("reachObj", ["bot1"])
    ]  # fmt: skip
    assert goals[2].before == {goals[0].place, goals[1].place}


@pytest.mark.parametrize("text", [hand_to_visitors(3), deliver_by_robots(3), MUSEUM])
def test_a_plan_in_stages_is_read_as_it_was_written(text: str) -> None:
    won = won_so(text)
    plan = write_plan(won.strategy, won.network, won.objective)
    assert read_plan(plan, won.network, "plan.txt") == won.strategy


def test_a_milestone_that_the_network_does_not_have_is_an_error_with_its_line() -> None:
    won = won_so(hand_to_visitors(2))
    plan = write_plan(won.strategy, won.network, won.objective).replace("Stage: rule2.rule20", "Stage: rule2.nowhere")
    with pytest.raises(PursueError, match="milestone 'rule2.nowhere'") as problem:
        read_plan(plan, won.network, "plan.txt")
    assert problem.value.diagnostics[0].span is not None and problem.value.diagnostics[0].span.line == 4


def test_a_plan_without_one_of_its_stages_is_refused_with_the_block_that_nobody_needs() -> None:
    won = won_so(hand_to_visitors(2))
    lacking = replace(won.strategy, stages=won.strategy.stages[1:])
    with pytest.raises(PursueError, match=r"the block for .*visitor1\.\w+.* leads to no milestone") as problem:
        prove(won.network, won.objective, lacking, DELAY)
    assert "play" not in problem.value.diagnostics[0].hint, "none is shown"


@pytest.mark.parametrize("controllers", ["distributed", "centralized"])
@pytest.mark.parametrize("text", [hand_to_visitors(3), deliver_by_robots(3), MUSEUM])
def test_controllers_play_the_stages_to_the_goal(text: str, controllers: str) -> None:
    scenario, won = scenario_of(text), won_so(text)
    runner = MissionRunner(make_case(scenario, won, SolveRequest(controllers=controllers), "random", (), None)[0])
    settings = Settings("random")
    missions = [simulate_mission(runner.stage, settings, number) for number in range(1, 16)]
    assert [mission.end for mission in missions] == ["goal"] * 15, missions


def test_a_recorded_game_in_stages_is_solved_again_for_replay() -> None:
    text = hand_to_visitors(4)
    game = game_of(Source("crowd", text, "crowd.pur", Rules()))
    assert game.orders is not None
