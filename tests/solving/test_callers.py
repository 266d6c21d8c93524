"""Agents who may call whenever they like: won without relying on their pauses, proven, written, read and simulated."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Tuple

import pytest
from hypothesis import HealthCheck, event, given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import partition
from pursue_gen.partition.strategy_data import cover_data, render, render_cover, strategy_data
from pursue_gen.proof.checker import verify
from pursue_gen.solving.given_plan import trials
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.quick import quick
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import DEFAULT as DEFAULT_RULES
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import Solution, guaranteed, solution
from pursue_gen.solving.without_pauses import won_without_pauses
from pursue_gen.synthesis.plan import read_plan, write_plan
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import GOAL, Settings
from pursue_gen.tools.simulation.runs import MissionRunner, make_case

HOTEL = """
poi "desk"
poi "lift"
poi "first"
poi "second"
connect desk and lift distance 1
connect lift and first distance 2
connect lift and second distance 3
event "callOne" location first
event "callTwo" location second
event "serveOne" location first duration 1
event "serveTwo" location second duration 1
event "towelsOne" location first duration 2
agent "bot1" controllable mobile 1 location desk can_do serveOne, serveTwo, towelsOne
agent "bot2" controllable mobile 1 location desk can_do serveOne, serveTwo
agent "guestOne" location first can_do callOne
agent "guestTwo" location second can_do callTwo
objective: if callOne then serveOne within 20
objective: if callTwo then serveTwo within 20
reach_objective: do towelsOne
"""
CLOCKS = ("CguestOne", "CguestTwo")


def solved(text: str, options: SolveOptions = DEFAULT) -> Tuple[Scenario, Solution]:
    scenario = parse(text, "hotel.pur", "hotel")
    return scenario, solution(translate(scenario), scenario_objective(scenario), DEFAULT_RULES, options)


@pytest.fixture(scope="module")
def hotel() -> Tuple[Scenario, Solution]:
    return solved(HOTEL)


def test_it_is_won_without_the_pauses_between_calls(hotel: Tuple[Scenario, Solution]) -> None:
    _, won = hotel
    assert won.strategy.left_out_clocks == CLOCKS
    assert set(CLOCKS).issubset(won.network.clocks) and set(CLOCKS).isdisjoint(won.part.clocks)
    assert verify(won.network, won.objective, won.strategy, won.reaction).ok


def test_a_quicker_strategy_leaves_them_out_as_well(hotel: Tuple[Scenario, Solution]) -> None:
    found = quick(hotel[1], DEFAULT)
    assert found.strategy.left_out_clocks == CLOCKS and found.guarantee is not None
    assert found.guarantee.worst == guaranteed(found, 20_000).worst is not None
    assert verify(found.network, found.objective, found.strategy, found.reaction).ok


def test_a_plan_says_which_clocks_it_leaves_out_and_reads_back(hotel: Tuple[Scenario, Solution]) -> None:
    scenario, won = hotel
    plan = write_plan(won.strategy, won.network, won.objective)
    assert "\n -- Left out clocks: CguestOne CguestTwo\n" in plan
    assert read_plan(plan, won.network, "plan") == won.strategy
    assert trials(plan, "plan", translate(scenario), won.objective, [DEFAULT_RULES])[-1].solution is not None


def test_a_plan_that_leaves_out_a_clock_that_is_not_there_is_refused(hotel: Tuple[Scenario, Solution]) -> None:
    _, won = hotel
    plan = write_plan(won.strategy, won.network, won.objective).replace(": CguestOne", ": Cnobody")
    with pytest.raises(PursueError, match="leaves out the clock 'Cnobody', which the network does not have") as raised:
        read_plan(plan, won.network, "plan")
    span = raised.value.diagnostics[0].span
    assert span is not None and plan.split("\n")[span.line - 1].startswith(" -- Left out clocks:")


def test_all_files_of_the_mission_name_them(hotel: Tuple[Scenario, Solution]) -> None:
    scenario, won = hotel
    subs = partition(won.strategy, won.network, scenario.agents)
    parts = [strategy_data(sub, Fraction(1, 10)) for sub in subs]
    for data in (*parts, cover_data(won.strategy)):
        assert data["left_out_clocks"] == list(CLOCKS)
    assert {data["format"] for data in parts} == {2}
    texts = [render(subs[0], "hotel", "1", Fraction(1, 10)), render_cover(won.strategy, "hotel", "1")]
    assert all("\nleft_out_clocks: [CguestOne, CguestTwo]\n" in text for text in texts)


def test_missions_reach_the_goal_whenever_they_call(hotel: Tuple[Scenario, Solution]) -> None:
    scenario, won = hotel
    case, _ = make_case(scenario, won, SolveRequest(), "random", (), None)
    runner = MissionRunner(case)
    for seed in range(15):
        mission = simulate_mission(runner.stage, case.settings, seed)
        assert (mission.end, mission.problems) == (GOAL, ()), mission


@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(st.integers(1, 3), min_size=3, max_size=3), st.integers(1, 2), st.integers(12, 30), st.integers(0, 99))
def test_random_missions_are_won_by_strategies_that_leave_pauses_out(
    ways: List[int], served: int, within: int, seed: int
) -> None:
    text = HOTEL.replace("serveOne within 20", f"serveOne within {within}").replace("duration 1", f"duration {served}")
    for distance, way in zip(ways, ("desk and lift distance 1", "first distance 2", "second distance 3")):
        text = text.replace(way, f"{way[:-1]}{distance}")
    scenario, rules = parse(text, "hotel.pur", "hotel"), Rules()
    network, objective = played(translate(scenario), rules), scenario_objective(scenario)
    found = won_without_pauses(network, objective, rules.reaction, 300_000, DEFAULT)
    if found is None:
        return
    event("won without pauses")
    won = Solution(network, objective, found.strategy, rules.reaction, rules=rules)
    runner = MissionRunner(make_case(scenario, won, SolveRequest(), "random", (), None)[0])
    for number in range(seed, seed + 3):
        mission = simulate_mission(runner.stage, Settings("random"), number)
        assert (mission.end, mission.problems) == (GOAL, ()), (text, mission)
