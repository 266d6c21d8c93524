"""The data of a strategy hold what the strategy holds: every state, command and zone, and where each step leads."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Set

import pytest

from pursue_gen.explanation.network_words import zone_texts
from pursue_gen.language import load
from pursue_gen.partition import partition
from pursue_gen.report.strategy_data import StrategyData, as_json, size, strategy_data_of
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario

SCENARIOS = Path(__file__).resolve().parent.parent.parent / "scenarios"
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
    written = {zone_texts(zone) for block in won.strategy.blocks for zone in block.wait}
    written |= {zone_texts(zone) for block in won.strategy.blocks for c in block.commands for zone in c.zones}
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
    for places, values, wait, commands, others, goal in loaded["states"]:
        assert len(places) == len(loaded["automata"]) and len(values) == len(loaded["variables"]) and goal in (0, 1)
        for who, words, target, when in (*commands, *others):
            assert who < len(loaded["automata"]) and words < len(loaded["texts"]) and target < len(loaded["states"])
            assert all(zone < len(loaded["zones"]) for zone in (*when, *wait))
