"""The book of a strategy holds what the strategy holds: every state, command and zone, and where each step leads."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Set

import pytest

from pursue_gen.explanation.network_words import zone_texts
from pursue_gen.language import load
from pursue_gen.partition import partition
from pursue_gen.report.strategy_data import Book, as_json, book_of, size
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario

SCENARIOS = Path(__file__).resolve().parent.parent.parent / "scenarios"
CATCH = load(SCENARIOS / "thesis" / "catch_the_thief.pur")


@pytest.fixture(scope="module")
def won() -> Solution:
    return solve_scenario(CATCH, Rules())


@pytest.fixture(scope="module")
def book(won: Solution) -> Book:
    return book_of(CATCH, won, "dedicated")


def test_every_block_and_command_is_there_with_its_zones(won: Solution, book: Book) -> None:
    assert size(book) == (len(won.strategy.blocks), sum(len(block.commands) for block in won.strategy.blocks))
    told = {exact for _, exact in book.zones}
    written = {zone_texts(zone) for block in won.strategy.blocks for zone in block.wait}
    written |= {zone_texts(zone) for block in won.strategy.blocks for c in block.commands for zone in c.zones}
    assert told == written


def test_each_step_leads_to_where_its_automaton_has_gone(won: Solution, book: Book) -> None:
    for situation in book.situations:
        for step in (*situation.commands, *situation.others):
            target = book.situations[step.target]
            assert (target.places, target.values) != (situation.places, situation.values)
    first = book.situations[0]
    assert [book.automata[k][2][place][0] for k, place in enumerate(first.places)][:3] == ["at a", "at a", "at c"]


def test_every_situation_can_be_reached_from_the_start_and_the_goal_too(book: Book) -> None:
    seen: Set[int] = {0}
    waiting = [0]
    while waiting:
        situation = book.situations[waiting.pop()]
        for step in (*situation.commands, *situation.others):
            if step.target not in seen:
                seen.add(step.target)
                waiting.append(step.target)
    assert seen == set(range(len(book.situations)))
    assert any(situation.goal for situation in book.situations)


def test_who_is_told_by_whom_is_the_partition(won: Solution) -> None:
    owners = book_of(CATCH, won, "all").controllers
    subs = partition(won.strategy, won.network, CATCH.agents, reach_obj="all")
    assert owners["reachObj"] == ("controller_polBot1", "controller_polBot2")
    assert {(agent, sub.controller) for sub in subs for agent in sub.agents} == {
        (agent, name) for agent, names in owners.items() for name in names
    }


def test_the_data_of_the_page_name_nothing_that_is_not_there(book: Book) -> None:
    data = json.loads(json.dumps(as_json(book)))
    for places, values, wait, ours, others, goal in data["states"]:
        assert len(places) == len(data["automata"]) and len(values) == len(data["variables"]) and goal in (0, 1)
        for who, words, target, when in (*ours, *others):
            assert who < len(data["automata"]) and words < len(data["texts"]) and target < len(data["states"])
            assert all(zone < len(data["zones"]) for zone in (*when, *wait))
