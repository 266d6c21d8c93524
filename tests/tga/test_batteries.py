"""Batteries in the game: movements and actions begin only at levels that suffice, and strategies keep to that."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional, Set, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.ablations import without_each
from pursue_gen.explanation.explain import explain
from pursue_gen.language import parse
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, solve_scenario
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Edge, Network
from pursue_gen.tga.uppaal import read_network, write_network
from pursue_gen.tools.play.session import opening, session_of
from pursue_gen.tools.simulation.outcome import SAFE, Settings
from pursue_gen.tools.simulation.promises import Promises
from pursue_gen.tools.simulation.runs import MissionRunner, case_of
from pursue_gen.vocabulary.statuses import statuses
from pursue_gen.workspace import Options
from pursue_runtime.state import SystemState

HOUSE = """\
poi "dock"
poi "hall"
connect dock and hall distance 3
event "charge" location dock duration 8
event "wipe" location hall duration 1
event "ring"
agent "bot" controllable mobile 1 location dock can_do charge, wipe, ring
{}
reach_objective: do wipe and ring within 60
"""
WANTED = "reach_objective: do wipe and ring within 60"
BATTERY = "battery bot capacity {} uses 1 per unit recharges {} per unit at dock"


def house(capacity: int, rate: int = 1) -> Scenario:
    return parse(HOUSE.format(BATTERY.format(capacity, rate)), "x.pur", "x")


def levels_of(edge: Edge) -> Tuple[Optional[int], Optional[int]]:
    """The level at which an edge is possible, and the one that it leads to."""
    before = [t.value for clause in edge.guard.integers for t in clause if t.variable == "Lbot"]
    return before[0] if before else None, dict(edge.assign).get("Lbot")


def moves(network: Network, source: str, target: str) -> Set[Tuple[Optional[int], Optional[int]]]:
    edges = network.automaton("bot").edges
    return {levels_of(edge) for edge in edges if (edge.source, edge.target) == (source, target)}


def solved(scenario: Scenario) -> Optional[Solution]:
    try:
        return solve_scenario(scenario, Rules())
    except PursueError as problem:
        assert problem.exit_status == 4
        return None


def test_what_may_be_used_at_most_is_taken_off_at_the_beginning() -> None:
    network = translate(house(10))
    assert ("Lbot", 10) in network.variables
    assert moves(network, "dock", "going_dock_to_hall") == {(10, 6), (8, 4), (6, 2), (4, 0)}
    assert moves(network, "hall", "doing_wipe_in_hall") == {(10, 8), (8, 6), (6, 4), (4, 2), (2, 0)}
    assert moves(network, "going_dock_to_hall", "hall") == {(None, None)}


def test_what_is_recharged_at_least_is_added_at_the_end() -> None:
    network = translate(house(10))
    assert moves(network, "dock", "doing_charge_in_dock") == {(None, None)}
    ends = moves(network, "doing_charge_in_dock", "dock")
    assert ends == {(10, None), (8, 10), (6, 10), (4, 10), (2, 10), (0, 8)}


def test_without_a_battery_nothing_changes() -> None:
    scenario = house(10)
    assert "Lbot" not in dict(translate(replace(scenario, batteries=())).variables)


def test_uppaal_reads_the_network_with_a_battery() -> None:
    scenario = house(10)
    network = translate(scenario)
    assert read_network(write_network(network, scenario_objective(scenario)), "TGA.xml") == network


@pytest.mark.parametrize(("capacity", "wins"), [(5, False), (6, True)])
def test_a_goal_is_reached_only_on_a_battery_that_lasts(capacity: int, wins: bool) -> None:
    assert (solved(house(capacity)) is not None) == wins


def test_a_charger_makes_the_difference() -> None:
    patrol = HOUSE.replace(WANTED, "objective: patrol hall, dock every 48 by bot")
    assert solved(parse(patrol.format(BATTERY.format(8, 1)), "x.pur", "x")) is not None
    assert solved(parse(patrol.format("battery bot capacity 400 uses 10 per unit"), "x.pur", "x")) is None


BY_DISTANCE = "battery bot capacity {} uses 0.5 per metre, 1 per unit recharges 1 per unit at dock"


def test_on_its_way_it_uses_by_the_length_whatever_that_takes() -> None:
    network = translate(parse(HOUSE.format(BY_DISTANCE.format(4)), "x.pur", "x"))
    assert dict(network.variables)["Lbot"] == 8
    assert moves(network, "dock", "going_dock_to_hall") == {(level, level - 3) for level in (8, 5, 4)}
    assert moves(network, "hall", "doing_wipe_in_hall") == {(8, 4), (5, 1), (4, 0)}
    (known,) = (each for each in statuses(parse(HOUSE.format(BY_DISTANCE.format(4)), "x.pur", "x"), network)
                if each.of == "Lbot")  # fmt: skip
    assert known.texts["5"] == "2.5 of 4"


@pytest.mark.parametrize(("capacity", "wins"), [(3, False), (4, True)])
def test_what_it_uses_by_distance_decides(capacity: int, wins: bool) -> None:
    assert (solved(parse(HOUSE.format(BY_DISTANCE.format(capacity)), "x.pur", "x")) is not None) == wins
    assert solved(house(capacity)) is None, "by time it uses more"


@settings(max_examples=5)
@given(st.integers(6, 24), st.integers(1, 5), st.sampled_from([24, 32]))
def test_missions_keep_batteries_that_are_used_by_distance(capacity: int, rate: int, every: int) -> None:
    battery = BY_DISTANCE.format(capacity).replace("recharges 1", f"recharges {rate}")
    text = HOUSE.replace(WANTED, f"objective: patrol hall, dock every {every} by bot")
    scenario = parse(text.format(battery), "x.pur", "x")
    won = solved(scenario)
    if won is None:
        return
    runner = MissionRunner(case_of(scenario, won, Options(), Settings(until=100.0))[0])
    for seed in range(2):
        outcome = runner.run(seed)
        assert outcome.end == SAFE, outcome.reason


@settings(max_examples=5)
@given(st.integers(6, 24), st.integers(1, 5), st.sampled_from([24, 32, 48]))
def test_missions_of_strategies_keep_their_batteries_as_the_judge_counts_them(
    capacity: int, rate: int, every: int
) -> None:
    text = HOUSE.format(BATTERY.format(capacity, rate)).replace(
        WANTED, f"objective: patrol hall, dock every {every} by bot"
    )
    scenario = parse(text, "x.pur", "x")
    won = solved(scenario)
    if won is None:
        return
    runner = MissionRunner(case_of(scenario, won, Options(), Settings(until=100.0))[0])
    for seed in range(2):
        outcome = runner.run(seed)
        assert outcome.end == SAFE, outcome.reason


def test_the_judge_finds_a_battery_that_is_empty() -> None:
    promises = Promises(house(10))
    steps = [
        (0.0, "dock"), (2.0, "going_dock_to_hall"), (6.0, "hall"), (20.0, "doing_wipe_in_hall"), (22.0, "hall"),
        (23.0, "going_hall_to_dock"), (26.5, "dock"), (28.0, "doing_charge_in_dock"), (30.0, "dock"),
    ]  # fmt: skip
    for number, (now, place) in enumerate(steps, 1):
        promises.on_state(SystemState(number, now, {"bot": place}, {}, {}, unit=1.0), now)
    assert promises.problems == []
    promises.on_state(SystemState(10, 31.0, {"bot": "going_dock_to_hall"}, {}, {}, unit=1.0), 31.0)
    promises.on_state(SystemState(11, 34.0, {"bot": "hall"}, {}, {}, unit=1.0), 34.0)
    assert promises.problems == ["the battery of bot has run empty"]


def test_a_lost_scenario_says_which_battery_would_do() -> None:
    explanation = explain(house(5), Rules(), Limits(work=20_000_000))
    assert "a battery of bot with capacity 6 instead of 5" in [change.sentence for change in explanation.changes]


def test_what_makes_a_game_large_may_be_its_battery() -> None:
    parts = {part.name: lesser for part, lesser in without_each(house(10))}
    assert parts["the battery of bot"].batteries == ()


def test_levels_are_said_in_words() -> None:
    scenario = house(10)
    (battery,) = (each for each in statuses(scenario, translate(scenario)) if each.of == "Lbot")
    assert battery.label == "battery of bot" and battery.texts["4"] == "4 of 10"
    assert "  battery of bot: 10 of 10" in opening(session_of(scenario, Rules()))
