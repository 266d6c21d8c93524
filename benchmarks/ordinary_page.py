"""The figures of benchmarks/ordinary.py as tables and sentences."""

from __future__ import annotations

import statistics
from typing import Any, List, Mapping

from benchmarks import command
from benchmarks.lab_scenarios import LABS
from benchmarks.measure import Row
from benchmarks.tables import DASH, markdown, number, seconds

_NEAR = 1.2
"""Robots should drive at most so many times the least that is known."""

_NONE = "Not measured yet: `python -m benchmarks.ordinary --out docs`.\n"


def families(results: Mapping[str, Any]) -> str:
    """What `solve` takes for members of the families of ordinary work, beside what it should."""
    rows = [row for row in results.get("ordinary", ()) if not _lab(row)]
    return f"{_measured(rows)}\n{command.table(rows)}" if rows else _NONE


def labs(results: Mapping[str, Any]) -> str:
    """How many random lab scenarios are decided, and in which time: a line for each size."""
    lines: List[List[str]] = []
    undecided: List[str] = []
    rows: List[Row] = []
    for name, (size, limit, goal) in LABS.items():
        mine = [row for row in results.get("ordinary", ()) if _lab(row) == name]
        if not mine:
            continue
        rows += mine
        decided = sorted(row["cpu"] for row in mine if row.get("verdict"))
        counts = [sum(row.get("verdict") == verdict for row in mine) for verdict in ("won", "lost", None)]
        times = sorted(row["cpu"] for row in mine)
        lines.append(
            [f"{size.places} places, {size.robots} robots, {size.people} people, {size.promises} promises"]
            + [number(len(mine)), *map(number, counts), f"{limit:g}"]
            + [f"{len(decided) / len(mine):.0%}", f"{goal:.0%}", seconds(statistics.median(times))]
            + [seconds(statistics.median(decided)) if decided else DASH]
            + [number(max(row["memory"] for row in mine))]
        )
        seeds = ", ".join(str(row["size"]) for row in mine if not row.get("verdict"))
        undecided += [f"Not decided, of {size.places} places: {seeds}."] if seeds else []
    if not rows:
        return _NONE
    head = (
        "size", "seeds", "won", "lost", "not decided", "within, s", "decided", "goal", "median of all, s",
        "of those decided, s", "MiB, most",
    )  # fmt: skip
    return f"{_measured(rows)}\n{markdown(head, lines, left=1)}\n" + "\n\n".join(undecided) + "\n" * bool(undecided)


def driving(results: Mapping[str, Any]) -> str:
    """How far robots drive in lab scenarios in which nobody else moves, a line for each in which they do."""
    rows = results.get("driving", ())
    if not rows:
        return _NONE
    those = [row for row in rows if row["driven"] > 0]
    near = sum(row["driven"] <= _NEAR * row["least"] for row in those)
    lines = [
        [row["name"], number(row["driven"]), number(row["least"])]
        + [f"{row['driven'] / row['least']:.2f}" if row["least"] else DASH]
        for row in those
    ]
    counts = f"Of {len(rows)} scenarios that are won, in {len(rows) - len(those)} nobody drives."
    counts += f" In {near} of the other {len(those)} they drive at most {_NEAR:g} times the least that is known."
    table = markdown(("scenario", "driven", "least known", "quotient"), lines, left=1)
    return f"{_measured(rows)}\n{counts}\n\n{table}"


def _lab(row: Row) -> str:
    """The key of LABS that a row is of; "" for one of a family."""
    name: str = row["name"].rsplit(" ", 1)[0]
    return name if name in LABS else ""


def _measured(rows: List[Row]) -> str:
    """When, and on which versions."""
    found = sorted({(row["date"], row["version"]) for row in rows})
    return "Measured " + ", ".join(f"{date} (version {version})" for date, version in found) + ".\n"
