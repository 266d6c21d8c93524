"""Figures and tables of the benchmarks on ROS; what measures them runs with the tests on ROS."""

from __future__ import annotations

from typing import Any, Dict

import pytest

from benchmarks import reaction_page
from benchmarks.reaction import SCENARIO, figures
from benchmarks.soak import RULES, Clocks
from benchmarks.soak import SCENARIO as LONG
from pursue_gen.language import parse
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.synthesis.strategy import Strategy

RESULTS: Dict[str, Any] = {
    "reaction": {
        "floor": {"count": 1000.0, "median": 0.5, "p99": 1.0, "worst": 2.0},
        "order": {"count": 1000.0, "median": 1.0, "p99": 2.5, "worst": 9.0},
    },
    "idle": {"observer": 0.125},
    "machine": "a machine",
    "date": "a day",
    "soak": {
        "events": 10000,
        "warm": 1000,
        "seconds": 500.2,
        "mission_seconds": 17000.0,
        "drift_ms": 0.001,
        "memory": {"observer": {"warm": 2048, "end": 2148}},
        "machine": "a machine",
        "date": "another day",
    },
}


def test_figures_are_milliseconds_median_and_percentile() -> None:
    found = figures([number / 1000 for number in range(1000, 0, -1)])
    assert found == {"count": 1000.0, "median": 500.5, "p99": 991.0, "worst": 1000.0}


def test_tables_compare_with_the_floor() -> None:
    table = reaction_page.reaction_table(RESULTS)
    assert "| 1000 | 1.00 | 2.50 | 9.00 | 2.0 | 2.5 |" in table
    assert "| `observer` | 0.12 |" in reaction_page.idle_table(RESULTS)
    assert "| `observer` | 2.0 | 2.1 | +100 |" in reaction_page.soak_table(RESULTS)


def test_a_page_is_filled_and_filled_again() -> None:
    page = reaction_page.filled(None, RESULTS)
    assert "10,000 events in 17,000 s" in page and "Measured a day on a machine." in page
    assert reaction_page.filled(page, RESULTS) == page
    assert "Not measured." in reaction_page.filled(page, {})


def strategy(text: str, rules: Rules) -> Strategy:
    """The strategy of a scenario."""
    return solve_scenario(parse(text, "s.pur", "s"), rules).strategy


def test_the_robot_answers_as_soon_as_it_may() -> None:
    """What is measured is the reaction, not a strategy that takes its time."""
    [block] = [block for block in strategy(SCENARIO, Rules()).blocks if block.commands]
    lower = [bound for zone in block.commands[0].zones for bound in zone if bound.left is None]
    assert [(bound.right, -bound.bound) for bound in lower] == [("Cbot", 1)]


def test_the_long_mission_goes_round() -> None:
    commands = [command for block in strategy(LONG, RULES).blocks for command in block.commands]
    done = {move.edge.sync.channel for command in commands for move in command.moves if move.edge.sync}
    assert {"wipe", "rinse", "bot_office2washroom", "bot_washroom2office"} <= done


def state(seq: int, stamp: float, **clocks: float) -> str:
    """A state as it is published."""
    told = "\n".join(f"{name}={value:.9f}" for name, value in clocks.items())
    return f"seq={seq} stamp={stamp:.6f} unit=0.5 status=running\nbot=desk\nPbot=1\n\n{told}"


def test_drift_is_the_distance_from_the_last_reset() -> None:
    clocks = Clocks()
    for text in (state(1, 10.0, Ca=0.0, Cb=0.0), state(2, 11.0, Ca=2.0, Cb=0.0), state(3, 12.0, Ca=4.0, Cb=2.0)):
        clocks.update(text)
    assert clocks.drift == pytest.approx(0.0, abs=1e-9)
    clocks.update(state(5, 13.0, Ca=6.01, Cb=4.0))
    assert clocks.drift == pytest.approx(0.005) and clocks.missed == 1
