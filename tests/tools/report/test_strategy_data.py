"""The data of a strategy hold what the strategy holds: every state, command and zone, and where each step leads."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Set, Tuple

import pytest

from benchmarks.families import deliver_by_robots
from pursue_gen.language import load, parse
from pursue_gen.language.network_names import reach_objective, safety_objective
from pursue_gen.partition import partition
from pursue_gen.partition.strategy_data import zone_text
from pursue_gen.solving.decomposition import won_by_some
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.watchers import Watcher
from pursue_gen.tools.report.strategy_data import UNKNOWN, StrategyData, as_json, shown_name, size, strategy_data_of
from tests.patrols import corridor
from tests.proof.test_shares import WARD, in_shares

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
CATCH = load(SCENARIOS / "thesis" / "catch_the_thief.pur")


@pytest.fixture(scope="module")
def won() -> Solution:
    return solve_scenario(CATCH, Rules())


@pytest.fixture(scope="module")
def data(won: Solution) -> StrategyData:
    return strategy_data_of(CATCH, won, "dedicated")


def test_every_block_and_command_is_there_with_its_zones(won: Solution, data: StrategyData) -> None:
    assert size(data) == (len(won.strategy.blocks), sum(len(block.commands) for block in won.strategy.blocks))
    texts = {exact for _, exact in data.zones}
    written = {zone_text(zone) for block in won.strategy.blocks for zone in block.wait}
    written |= {zone_text(zone) for block in won.strategy.blocks for c in block.commands for zone in c.zones}
    assert texts == written


def test_each_step_leads_to_where_its_automaton_has_gone(won: Solution, data: StrategyData) -> None:
    for situation in data.situations:
        for step in (*situation.commands, *situation.others):
            target = data.situations[step.target]
            assert (target.places, target.values) != (situation.places, situation.values)
    first = data.situations[0]
    assert [data.automata[k][2][place][0] for k, place in enumerate(first.places)][:3] == ["at a", "at a", "at c"]


def test_every_situation_can_be_reached_from_the_start_and_the_goal_too(data: StrategyData) -> None:
    seen: Set[int] = {0}
    waiting = [0]
    while waiting:
        situation = data.situations[waiting.pop()]
        for step in (*situation.commands, *situation.others):
            if step.target not in seen:
                seen.add(step.target)
                waiting.append(step.target)
    assert seen == set(range(len(data.situations)))
    assert any(situation.goal for situation in data.situations)


def test_who_is_reported_by_whom_is_the_partition(won: Solution) -> None:
    owners = strategy_data_of(CATCH, won, "all").controllers
    subs = partition(won.strategy, won.network, CATCH.agents, reach_obj="all")
    assert owners["reachObj"] == ("controller_polBot1", "controller_polBot2")
    assert {(agent, sub.controller) for sub in subs for agent in sub.agents} == {
        (agent, name) for agent, names in owners.items() for name in names
    }


def test_the_data_of_the_page_name_nothing_that_is_not_there(data: StrategyData) -> None:
    loaded = json.loads(json.dumps(as_json(data)))
    for places, values, wait, commands, others, goal, done in loaded["states"]:
        assert len(places) == len(loaded["automata"]) and len(values) == len(loaded["variables"])
        assert goal in (0, 1) and not done
        for who, words, target, when in (*commands, *others):
            assert who < len(loaded["automata"]) and words < len(loaded["texts"]) and target < len(loaded["states"])
            assert all(zone < len(loaded["zones"]) for zone in (*when, *wait))


@pytest.fixture(scope="module")
def delivery() -> Tuple[Solution, StrategyData]:
    scenario = parse(deliver_by_robots(3), "delivery.pur", "delivery")
    won = solve_scenario(scenario, Rules())
    return won, strategy_data_of(scenario, won, "dedicated")


def test_the_parts_of_a_stage_are_there_each_with_those_it_speaks_of(delivery: Tuple[Solution, StrategyData]) -> None:
    won, data = delivery
    assert [len(stage) for stage in won.strategy.stages] == [3, 1]
    assert size(data) == (len(won.strategy.blocks), sum(len(block.commands) for block in won.strategy.blocks))
    assert [(part.stage, part.who, part.until) for part in data.parts] == [
        (0, ("bot1",), "rule1: next: report"),
        (0, ("bot2",), "rule2: next: report"),
        (0, ("bot3",), "rule3: next: report"),
        (1, ("bot1",), "the goal: reached"),
    ]
    for part in data.parts:
        first = data.situations[part.first]
        named = [data.automata[k][0] for k, place in enumerate(first.places) if not data.is_free(k, place)]
        assert set(part.who) < set(named), "it speaks of its robot and of its rule"
        assert [name for name in named if name.startswith("bot")] == list(part.who)
    ends = [(situation.goal, situation.done) for situation in data.situations if situation.goal or situation.done]
    assert ends.count((True, True)) == 1 and ends.count((False, True)) == 3


def test_no_step_of_a_part_leads_out_of_it(delivery: Tuple[Solution, StrategyData]) -> None:
    _, data = delivery
    firsts = [*(part.first for part in data.parts), len(data.situations)]
    for begin, end in zip(firsts, firsts[1:]):
        for situation in data.situations[begin:end]:
            assert all(begin <= step.target < end for step in (*situation.commands, *situation.others))


def test_whom_no_stage_names_is_left_out_and_states_are_shown_where_they_are_named() -> None:
    state = 'state "open": initially false, true_if load1\nstateDependency: unload1 only_if open is_true\n'
    text = deliver_by_robots(3).replace('agent "bot1"', f'{state}agent "passer" mobile 3 location hub\nagent "bot1"')
    scenario = parse(text, "delivery.pur", "delivery")
    network, objective = played(translate(scenario), Rules()), scenario_objective(scenario)
    found = won_by_some(network, objective, Rules().reaction, SolveOptions())
    assert found is not None and found.strategy.stages
    data = strategy_data_of(scenario, Solution(network, objective, found.strategy, Rules().reaction), "dedicated")
    assert data.left_out == ("passer",) and "passer" not in [name for name, _, _ in data.automata]
    assert data.variables == ("open",)
    known = {situation.values for situation in data.situations}
    assert known == {(UNKNOWN,), (0,), (1,)}


def test_of_tours_each_robot_has_a_part_and_what_is_kept_apart_is_not_left_out() -> None:
    scenario = parse(corridor(6, 2, " every 81"), "patrol.pur", "patrol")
    won = solve_scenario(scenario, Rules())
    data = strategy_data_of(scenario, won, "dedicated")
    assert [(part.stage, part.who, part.until) for part in data.parts] == [(0, ("bot1",), ""), (0, ("bot2",), "")]
    assert [name for name, _, _ in data.automata] == ["bot1", "bot2", "bot1_tour", "bot2_tour"]
    places = {name: [words for words, *_ in shown] for name, _, shown in data.automata}
    assert "stop 2 of 11" in places["bot1_tour"]
    assert data.left_out == ()


def test_who_comes_to_the_goal_and_who_keeps_promises_until_then_have_a_part_each() -> None:
    network, objective, strategy = in_shares(WARD)
    won = Solution(network, objective, strategy, Rules().reaction)
    data = strategy_data_of(parse(WARD, "ward.pur", "ward"), won, "dedicated")
    assert [(part.stage, part.who, part.until) for part in data.parts] == [(0, ("bot2",), ""), (0, ("bot1",), "")]
    assert [k < data.parts[1].first for k, situation in enumerate(data.situations) if situation.goal] == [True]


def test_an_objective_is_called_by_its_number_and_by_the_robots_for_which_it_is_watched() -> None:
    assert shown_name(safety_objective(0), "deadline") == "the objective"
    assert shown_name(reach_objective(1), "goal") == "goal 2"
    watcher = Watcher(safety_objective(2), ("cart_1", "cart_2"))
    assert shown_name(watcher.name, "deadline") == "objective 3 for cart_1 and cart_2"
