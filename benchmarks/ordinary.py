"""Are ordinary stories decided? `python -m benchmarks.ordinary --labs 200 --large 20 --out docs`

Measures the whole command `solve` on random lab scenarios (lab_scenarios.py) and on families of ordinary work
(ordinary_families.py), in the default game and with at most 1 GiB. Each command is a process of its own, and what
counts is its processor time. `--driving 41` simulates lab scenarios that are won, and measures how far robots drive
(driving.py). `--out docs` keeps the figures in docs/benchmarks/results.json, each with the version that was measured,
and writes docs/benchmarks.md again.
"""

from __future__ import annotations

import argparse
import datetime
import json
import sys
import tempfile
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Sequence, Tuple

from benchmarks.command import Goal, command_measured, files_of, terminal
from benchmarks.driving import driving_measured
from benchmarks.lab_scenarios import LABS, lab_scenario
from benchmarks.measure import Bounds, Row
from benchmarks.synthesis import version, write

MEMORY = 1024
"""MiB: what a command may take."""

GOALS: Tuple[Goal, ...] = tuple(
    Goal(name, "default", seconds, size)
    for name, goals in (
        ("callers", {3: 0.5, 4: 0.6, 6: 1, 8: 3}),
        ("callers, five robots", {30: 10}),
        ("corridor", {4: 0.5, 8: 0.6, 20: 2, 30: 5}),
        ("square", {8: 0.6}),
        ("warehouse", {4: 1}),
        ("patrol, period given", {12: 5, 40: 5, 140: 5}),
        ("patrol, period to be found", {12: 10, 40: 10, 140: 10}),
        ("errands beside a visitor", {6: 3, 9: 3}),
        ("care home", {1: 10, 2: 10}),
        ("factory", {3: 10}),
        ("escort", {3: 10}),
        ("buildings apart", {1: 1, 2: 1, 4: 1}),
        ("rooms to mop beside calls", {2: 1, 4: 1, 6: 1}),
    )
    for size, seconds in goals.items()
)
"""Members of the families, and what `solve` should take for each."""

_AT_LEAST = 10.0
"""A member of a family is ended after twice its goal, but not before so many seconds."""


def labs_measured(name: str, count: int) -> Iterator[Row]:
    """A row for each of the first so many seeds of a key of LABS."""
    size, seconds, _ = LABS[name]
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(count):
            file = Path(folder) / f"{name.replace(' ', '_')}_{seed}.pur"
            file.write_text(lab_scenario(seed, size), encoding="utf-8")
            goal = Goal(name, "default", seconds, seed)
            yield command_measured(goal, [file], Path(folder), Bounds(seconds / 2, MEMORY), MEMORY)


def families_measured(goals: Sequence[Goal]) -> Iterator[Row]:
    """A row for each member of a family."""
    with tempfile.TemporaryDirectory() as folder:
        for goal in goals:
            bounds = Bounds(max(goal.seconds, _AT_LEAST / 2), MEMORY)
            yield command_measured(goal, files_of(goal, Path(), Path(folder)), Path(folder), bounds, MEMORY)


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Prints a line for each command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--labs", type=int, default=40, metavar="SEEDS", help="lab scenarios (40)")
    parser.add_argument("--large", type=int, default=0, metavar="SEEDS", help="lab scenarios of the larger size (0)")
    parser.add_argument("--driving", type=int, default=0, metavar="SEEDS", help="lab scenarios that are simulated (0)")
    names = sorted({goal.name for goal in GOALS})
    parser.add_argument("--families", nargs="*", default=names, metavar="NAME", help=f"{'; '.join(names)} (all)")
    parser.add_argument("--out", type=Path, metavar="FOLDER", help="write the figures to benchmarks.md there")
    given = parser.parse_args(arguments)
    unknown = sorted(set(given.families) - set(names))
    if unknown:
        parser.error(f"no family is called {', '.join(unknown)}; there is {', '.join(names)}")
    rows: List[Row] = []
    driving: List[Row] = []
    try:
        for row in _rows(given):
            rows.append(row)
            print(terminal(row), flush=True)
        for row in driving_measured(given.driving):
            driving.append(row)
            print(f"{row['name']}: driven {row['driven']:g}, least known {row['least']:g}", flush=True)
    except KeyboardInterrupt:
        print("interrupted; nothing was written", file=sys.stderr)
        return 130
    if given.out:
        keep(given.out, rows, driving)
    return 0


def _rows(given: argparse.Namespace) -> Iterator[Row]:
    yield from families_measured([goal for goal in GOALS if goal.name in given.families])
    yield from labs_measured("lab", given.labs)
    yield from labs_measured("large lab", given.large)


def keep(folder: Path, rows: Sequence[Row], driving: Sequence[Row] = ()) -> None:
    """Writes the rows into the results of the benchmarks, in place of those of the same commands, each with the version
    that it is of; and the page again."""
    file = folder / "benchmarks" / "results.json"
    results: Dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    now = {"date": f"{datetime.date.today()}", "version": version()}
    known = {row["name"]: row for row in results.get("ordinary", ())}
    known.update({row["name"]: {**row, **now} for row in rows})
    order = {goal.title: place for place, goal in enumerate(GOALS)}
    results["ordinary"] = sorted(known.values(), key=lambda row: (order.get(row["name"], len(order)), row["size"]))
    if driving:
        results["driving"] = [{**row, **now} for row in driving]
    write(folder, results, plots=False)


if __name__ == "__main__":
    sys.exit(main())
