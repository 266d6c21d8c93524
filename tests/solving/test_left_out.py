"""Scenarios with agents that cannot matter: solved, written, read, measured and simulated as without them."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Tuple

import pytest
from typer.testing import CliRunner

from benchmarks.families import deliver_by_robots
from pursue_gen.cli.app import app
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import partition
from pursue_gen.partition.strategy_data import cover_data, strategy_data
from pursue_gen.proof.margin import strategy_margin
from pursue_gen.solving.deadlines import fastest_solution
from pursue_gen.solving.given_plan import trials
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.rules import DEFAULT as DEFAULT_RULES
from pursue_gen.solving.rules import IDEAL
from pursue_gen.solving.solution import Solution, guaranteed, solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.tga import scenario_objective, translate

TEXT = deliver_by_robots(2)
PASSERS_BY = TEXT.replace('event "report"', 'event "report"\nevent "shout"').replace(
    "reach_objective",
    'agent "walker" mobile 3 location hub can_do shout\n'
    'agent "spare" controllable mobile 2 location hub can_do shout\nreach_objective',
)

SLEEPER = TEXT.replace('event "report"', 'event "report"\nevent "nap" duration 3').replace(
    "reach_objective", 'agent "sleeper" location hub can_do nap\nreach_objective'
)


def _solved(text: str, options: SolveOptions = DEFAULT) -> Tuple[Scenario, Solution]:
    scenario = parse(text, "crowd.pur", "crowd")
    return scenario, solution(translate(scenario), scenario_objective(scenario), DEFAULT_RULES, options)


@pytest.fixture(scope="module")
def crowd() -> Tuple[Scenario, Solution]:
    return _solved(PASSERS_BY)


def test_the_network_stays_whole_and_the_strategy_names_what_matters(crowd: Tuple[Scenario, Solution]) -> None:
    _, won = crowd
    names = ["bot1", "bot2", "reachObj", "rule1", "rule2"]
    assert [a.name for a in won.network.automata] == ["bot1", "bot2", "walker", "spare", "reachObj", "rule1", "rule2"]
    assert all([name for name, _ in block.state.locations] == names for block in won.strategy.blocks)
    assert won.strategy.blocks == _solved(TEXT)[1].strategy.blocks


def test_with_the_switch_the_whole_game_is_solved(crowd: Tuple[Scenario, Solution]) -> None:
    _, won = _solved(SLEEPER, SolveOptions(whole=True))
    assert won.part is won.network
    assert len(won.strategy.blocks) > len(crowd[1].strategy.blocks)


def test_times_and_margins_are_those_without_them(crowd: Tuple[Scenario, Solution]) -> None:
    _, won = crowd
    _, alone = _solved(TEXT)
    assert guaranteed(won) == guaranteed(alone)
    margins = [strategy_margin(w.network, w.objective, w.strategy, w.reaction, 1_000) for w in (won, alone)]
    assert margins[0] == margins[1]


def test_the_least_time_is_that_without_them() -> None:
    text = deliver_by_robots(1)
    crowded = text.replace("reach_objective", 'agent "walker" mobile 3 location hub\nreach_objective')
    found = []
    for one in (text, crowded):
        scenario = parse(one, "crowd.pur", "crowd")
        found.append(fastest_solution(translate(scenario), scenario_objective(scenario), DEFAULT_RULES))
    assert found[0].guarantee == found[1].guarantee
    assert found[0].strategy == found[1].strategy


def test_a_strategy_may_compare_a_clock_that_only_moves_compare_which_it_excludes() -> None:
    """In the ideal game one of the robots does all, and the other one, which stands still, has no edge that counts."""
    text = """poi "a"
        poi "b"
        connect a and b distance 1
        event "fetch" location b duration 3
        event "drop" location a duration 3
        rule "parcel" for each robot: fetch before drop
        agent "bot1" controllable mobile 3 location a can_do fetch, drop
        agent "bot2" controllable mobile 3 location b can_do fetch, drop
        travel bot2 from b to a takes 13 to 39
        reach_objective: do drop"""
    scenario = parse(text, "slow.pur", "slow")
    won = solved(translate(scenario), scenario_objective(scenario), IDEAL, DEFAULT)
    assert won.guarantee is not None and won.guarantee.worst is not None and won.guarantee.worst < 17


def test_a_plan_says_what_it_leaves_out_and_reads_back(crowd: Tuple[Scenario, Solution]) -> None:
    _, won = crowd
    plan = write_plan(won.strategy, won.network, won.objective)
    assert " -- Left out: walker spare Pwalker Pspare\n" in plan
    assert read_plan(plan, won.network, "plan") == won.strategy
    ideal = translate(crowd[0])
    assert trials(plan, "plan", ideal, won.objective, [DEFAULT_RULES])[-1].solution is not None


def test_a_plan_that_leaves_out_too_much_is_refused(crowd: Tuple[Scenario, Solution]) -> None:
    _, won = crowd
    plan = write_plan(won.strategy, won.network, won.objective)
    with pytest.raises(PursueError, match="the state says nothing of automaton 'walker'"):
        read_plan(plan.replace(" walker", "", 1), won.network, "plan")
    with pytest.raises(PursueError, match="leaves out 'nobody', which the network does not have"):
        read_plan(plan.replace(" walker", " nobody", 1), won.network, "plan")
    without_rule = plan.replace("Left out:", "Left out: rule2 Prule2").replace(" rule2._rule2_initial_location", "")
    assert without_rule != plan
    with pytest.raises(PursueError):
        read_plan(without_rule, won.network, "plan")


def test_controllers_get_blocks_with_what_matters(crowd: Tuple[Scenario, Solution]) -> None:
    scenario, won = crowd
    subs = partition(won.strategy, won.network, scenario.agents)
    assert {sub.controller: sub.commands for sub in subs}["controller_spare"] == 0
    data = strategy_data(subs[0], Fraction(1, 10))
    assert all({"walker", "spare"}.isdisjoint(entry["state"]) for entry in data["strategy"])
    assert all({"walker", "spare"}.isdisjoint(entry["state"]) for entry in cover_data(won.strategy)["cover"])


def test_the_commands_solve_and_verify_agree(tmp_path: Path) -> None:
    scenario, plan = tmp_path / "crowd.pur", tmp_path / "plan.txt"
    scenario.write_text(SLEEPER)
    solved = CliRunner().invoke(app, ["solve", str(scenario), "-o", str(plan), "--json"])
    assert solved.exit_code == 0, solved.output
    assert "Left out: sleeper" in plan.read_text()
    verified = CliRunner().invoke(app, ["verify", str(scenario), str(plan)])
    assert verified.exit_code == 0, verified.output
    whole = CliRunner().invoke(app, ["solve", str(scenario), "-o", str(plan), "--json", "--whole"])
    assert whole.exit_code == 0, whole.output
    assert "Left out" not in plan.read_text()
    found = [json.loads(result.stdout) for result in (solved, whole)]
    assert [one["left_out"] for one in found] == [["sleeper"], []]
    assert found[0]["states"] < found[1]["states"]


@pytest.mark.parametrize("crowd", [0, 20])
def test_what_no_robot_can_touch_is_said_to_be_so(crowd: int) -> None:
    people = "".join(f'agent "person{i}" mobile 3 location hub\n' for i in range(crowd + 1))
    people = people.replace("location hub", "location hub can_do shout", 1)
    text = deliver_by_robots(1).replace('event "report"', 'event "report"\nevent "shout"')
    text = text.replace("reach_objective: do report after 0", people + "objective: avoid shout")
    with pytest.raises(PursueError, match="no robot can do anything about it, as it depends on person0") as failure:
        _solved(text)
    assert failure.value.exit_status == 4
    with pytest.raises(PursueError) as failure:
        _solved(text.replace("avoid shout", "if shout then report within 3"))
    assert "no robot can do anything" not in str(failure.value)
