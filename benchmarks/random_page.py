"""The figures of random small games: how they are measured in another process, and their table."""

from __future__ import annotations

import json
import sys
from typing import Any, Dict, Iterator, List

from benchmarks.measure import ROOT, Bounds, Row
from benchmarks.process import run
from benchmarks.tables import markdown, number, seconds

MOST = 500
"""The games have at most so many discrete states."""

TIMES, PLUS = 20, 0.1
"""A game should take at most so many times the plain solver's seconds, and so many seconds more."""

LIMIT = 30.0
"""Seconds for one game, and as many for the plain solver."""

KINDS = ("reach", "safety", "reach-while-safe")
"""The kinds of objectives, as `tga.network.Kind` names them."""

GAMES_EACH, GAMES_QUICK = 50, 3
"""So many games of each kind are measured, and in a short run."""

_SECONDS_EACH = 5.0
"""All games together get so many seconds for each of `GAMES_EACH`; what was measured until then counts."""


def random_measured(count: int, bounds: Bounds) -> Iterator[Row]:
    """The rows, measured in another process."""
    command = [sys.executable, "-m", "benchmarks.random_games", str(count)]
    ran = run(command, _SECONDS_EACH * count, ROOT, bounds.memory + 1024)
    if ran.status:
        outcome = "too long" if ran.late else (ran.last_line or f"it ended with status {ran.status}")[:120]
        yield {"group": "random", "name": "all", "size": None, "game": "all", "outcome": outcome}
    for line in ran.out.splitlines():
        yield json.loads(line)


# Tables ---------------------------------------------------------------------------------------------------------------


def table(rows: List[Row]) -> str:
    """A line per kind of objective and game."""
    head = (
        "objective", "game", "games", "won", "states: median", "most", "seconds: median", "plain solver",
        "slowest", "plain solver", "largest part of what is allowed", "above it",
    )  # fmt: skip
    mine = [row for row in rows if row["group"] == "random" and not row["outcome"]]
    lines = [
        [row["name"], row["game"], number(row["games"]), number(row["won"]), number(row["states_median"])]
        + [number(row["states"]), seconds(row["seconds"]), seconds(row["plain"]), seconds(row["slowest"]["seconds"])]
        + [seconds(row["slowest"]["plain"]), f"{100 * row['closest']['part']:.0f} %", number(row["above"])]
        for row in mine
    ]
    total = {key: sum(row[key] for row in mine) for key in ("games", "above", "disagreed", "undecided", "on_regions")}
    text = (
        f"{total['games']} games: {total['above'] or 'none'} above {TIMES} times the plain solver plus {PLUS:g} s, "
        f"{total['undecided'] or 'none'} undecided; {total['disagreed'] or 'no'} verdicts differ, brute force on "
        f"regions ({total['on_regions']} games) included.\n"
    )
    return f"{markdown(head, lines)}\n{text}"


def terminal(row: Row) -> str:
    """A line for the terminal."""
    if row["outcome"]:
        return f"random games: {row['outcome']}"
    slowest: Dict[str, Any] = row["slowest"]
    name = f"random games, {row['name']}"
    return (
        f"{name:34} {row['game']:8} {row['games']} games, {row['above']} above what is allowed, "
        f"slowest {slowest['seconds']:g} s (plain solver {slowest['plain']:g} s), {row['disagreed']} verdicts differ"
    )
