"""What TIGA logged is read from its output, whole or cut."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.tiga import NOTHING, Figures, figures

PROGRESS = (
    "Verifying property 1 at line 1\n"
    " -- \x1b[1;34mThroughput: 4680 states/sec\x1b[0;0m, Size: 38 states, Load: 26 states\x1b[K\n"
    " -- \x1b[1;34mThroughput: 90000 states/sec\x1b[0;0m, Size: 233 states, Load: 120 states\x1b[K\n"
    " -- \x1b[1;34mThroughput: 61000 states/sec\x1b[0;0m, Size: 707 states, Load: 194 states\x1b[K\n"
    "Preparing: 0%\x1b[K\n"
)
STRATEGY = """
 -- Property is satisfied.
Strategy to win:

State: ( bot.a goal.idle ) Pbot=1
While you are in (Cbot<=1), wait.
When you are in (1<Cbot), take transition bot.a->bot.b { Cbot > 1, bot_a2b!, Cbot := 0 }

State: ( bot.b goal.idle ) Pbot=2
When you are in (1<Cbot), take transition bot.b->bot.b { Cbot > 1, work!, Cbot := 0 }
goal.idle->goal.win { 1, work?, 1 }
When you are in (3<Cbot), take transition bot.b->bot.a { Cbot > 1, bot_b2a!, Cbot := 0 }
"""


def test_the_last_progress_line_the_best_rate_and_the_size_of_the_strategy() -> None:
    assert figures(PROGRESS + STRATEGY) == Figures(states=707, waiting=194, rate=90000, blocks=2, commands=3)


def test_an_output_without_a_strategy_still_has_its_progress() -> None:
    assert figures(PROGRESS + "Out of memory\n") == Figures(707, 194, 90000, None, None)


def test_a_counter_strategy_counts_too() -> None:
    text = STRATEGY.replace("Strategy to win", "Counter strategy to prevent from winning")
    assert figures(text) == Figures(None, None, None, 2, 3)


def test_what_is_no_output_of_tiga_has_no_figures() -> None:
    assert figures("") == NOTHING
    assert figures("State: ( a ) \nWhen you are in something else") == NOTHING


@pytest.mark.parametrize(
    ("name", "expected"),
    [("CT1", (707, 164, 194)), ("CT5", (12_362, 7_989, 9_005)), ("WC2a", (13, 7, 2)), ("EB2", (27_748, 887, 987))],
)
def test_the_published_outputs(reference_dir: Path, name: str, expected: object) -> None:
    found = figures(next((reference_dir / name).glob("UPPAAL_plan*.txt")).read_text(errors="replace"))
    assert (found.states, found.blocks, found.commands) == expected
