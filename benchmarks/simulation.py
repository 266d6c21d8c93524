"""Many simulated missions of the bundled scenarios: how fast they are, and how they end with faults.

`python -m benchmarks.simulation --out docs` plays them and writes docs/benchmarks/simulation.json and the tables of
docs/simulated_faults.md. Each number of missions depends on the seeds alone; a cell that takes longer than `--seconds`
of processor time ends with fewer missions. `--speed` measures missions per second instead (of processor time).
"""

from __future__ import annotations

import argparse
import datetime
import json
import multiprocessing
import statistics
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from benchmarks import simulation_page
from benchmarks.synthesis import machine, version
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.solving.optional import promised
from pursue_gen.solving.options import DEFAULT
from pursue_gen.solving.periods import least_period
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.tools.simulation.faults import read_faults
from pursue_gen.tools.simulation.mission import simulate_mission
from pursue_gen.tools.simulation.outcome import FAILED, Settings
from pursue_gen.tools.simulation.runs import Case, MissionRunner, make_case
from pursue_runtime.state import LOST

ROOT = Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"

Row = Mapping[str, Any]

CELLS: Sequence[Tuple[str, int]] = (
    ("loss", 1000),
    ("loss=0.01", 300),
    ("loss=0.1", 300),
    ("loss=0.2", 300),
    ("restart", 300),
    ("orders", 300),
    ("duplicates", 300),
    ("reorder", 300),
    ("delay", 300),
    ("deaths", 300),
    ("all", 15000),
)
"""Faults as `--faults` takes them, and how many missions each scenario plays with them."""

WARM, BATCH, BATCHES = 50, 100, 5
"""Missions before the speed is measured, and in each of so many measurements."""


def bundled() -> List[str]:
    """The scenarios below scenarios/, without .pur, whose objective can be met in the default game."""
    return [path.relative_to(SCENARIOS).with_suffix("").as_posix() for path in sorted(SCENARIOS.rglob("*.pur"))]


def case_for(name: str, faults: str = "all") -> Optional[Case]:
    """The case of a scenario with these faults; None where the objective cannot be met."""
    scenario = least_period(load(SCENARIOS / f"{name}.pur"), Rules())
    try:
        found = promised(scenario, DEFAULT, lambda some, how: solve_scenario(some, Rules(), how))
    except PursueError:
        return None
    return make_case(found.scenario, found.solution, SolveRequest(), "mixed", read_faults(faults), None)[0]


def cells(job: Tuple[str, Sequence[Tuple[str, int]], float]) -> List[Row]:
    """How the missions of a scenario end with each of these faults: the missions from 1 on, so many of them, or as many
    as that take so many seconds of processor time."""
    name, wanted, seconds = job
    case = case_for(name)
    if case is None:
        return []
    runner = MissionRunner(case)
    return [cell(name, runner, replace(case.settings, faults=read_faults(f)), f, runs, seconds) for f, runs in wanted]


def cell(name: str, runner: MissionRunner, settings: Settings, faults: str, runs: int, seconds: float) -> Row:
    """How missions with these settings end."""
    start, done, latest = time.process_time(), 0, 0.0
    ends: Counter[str] = Counter()
    causes: Counter[str] = Counter()
    examples: List[Dict[str, Any]] = []
    while done < runs and (not done or time.process_time() - start < seconds):
        done += 1
        outcome = simulate_mission(runner.stage, settings, done, runner.remaining)
        ends[outcome.end] += 1
        latest = max(latest, outcome.lateness)
        if outcome.end in (LOST, FAILED):
            kind = kind_of(outcome.end, outcome.cause)
            example = {"seed": done, "cause": outcome.reason if outcome.end == FAILED else outcome.cause}
            causes[kind] += 1
            if kind == "ours":
                examples.insert(0, example)
            elif len(examples) < 3:
                examples.append(example)
    return {
        "scenario": name,
        "faults": faults,
        "missions": done,
        "margin": settings.margin,
        "ends": dict(sorted(ends.items())),
        "latest": round(latest, 3),
        "causes": dict(sorted(causes.items())),
        "examples": examples,
    }


def kind_of(end: str, cause: str) -> str:
    """Why a mission ended so: it failed a check, whatever else was wrong ("ours"), or a fault was too long: of a
    command, or of an agent (late, lost, early)."""
    if end == FAILED:
        return "ours"
    return "command" if "was due for" in cause else "agent"


def speed(name: str) -> Optional[float]:
    """Missions without faults per second of processor time: the median of several measurements."""
    case = case_for(name, "none")
    if case is None:
        return None
    runner = MissionRunner(case)
    for seed in range(1, WARM + 1):
        runner.run(seed)
    rates = []
    for number in range(BATCHES):
        start = time.process_time()
        for seed in range(BATCH):
            runner.run(1000 + number * BATCH + seed)
        rates.append(BATCH / (time.process_time() - start))
    return statistics.median(rates)


def _played(jobs: Sequence[Tuple[str, Sequence[Tuple[str, int]], float]], processes: int) -> Iterator[List[Row]]:
    """The cells of each scenario, as soon as they are done."""
    if processes == 1:
        yield from map(cells, jobs)
        return
    with multiprocessing.get_context("spawn").Pool(processes) as pool:
        yield from pool.imap_unordered(cells, jobs)


def main(words: Optional[Sequence[str]] = None) -> int:
    """Plays the missions and writes the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.simulation", description=__doc__)
    parser.add_argument("--out", type=Path, help="the folder of the page, such as docs")
    parser.add_argument("--only", default="", help="faults as in the table, separated by blanks; none: all of them")
    parser.add_argument("--scenarios", nargs="*", default=[], help="such as thesis/scenario_1; none: all")
    parser.add_argument("--seconds", type=float, default=60.0, help="of processor time for each cell (60)")
    parser.add_argument("--jobs", type=int, default=1, help="so many processes (1)")
    parser.add_argument("--speed", action="store_true", help="measure missions per second, without faults")
    parser.add_argument("--before", type=Path, help="with --speed: simulation.json of an earlier state of the project")
    given = parser.parse_args(words)
    names = given.scenarios or bundled()
    path = given.out / "benchmarks" / "simulation.json" if given.out else None
    results: Dict[str, Any] = json.loads(path.read_text()) if path and path.exists() else {}
    stamp = {"date": datetime.date.today().isoformat(), "machine": machine(), "commit": version()}
    if given.speed:
        found = {name: speed(name) for name in names}
        results["speed"] = {**stamp, "rates": {name: round(rate) for name, rate in found.items() if rate}}
        if given.before:
            results["speed before"] = json.loads(given.before.read_text())["speed"]["rates"]
        print(json.dumps(results["speed"], indent=1))
        _write(given.out, path, results)
        return 0
    wanted = [(faults, runs) for faults, runs in CELLS if faults in (given.only.split() or [f for f, _ in CELLS])]
    for rows in _played([(name, wanted, given.seconds) for name in names], given.jobs):
        for row in rows:
            cell = {**row, "date": stamp["date"], "commit": stamp["commit"]}
            results.setdefault("cells", {})[f"{row['faults']} {row['scenario']}"] = cell
            print(json.dumps(cell), flush=True)
        _write(given.out, path, results)
    return 0


def _write(out: Optional[Path], path: Optional[Path], results: Dict[str, Any]) -> None:
    if out is None or path is None:
        return
    results["cells"] = dict(sorted(results.get("cells", {}).items()))
    path.write_text(json.dumps(results, indent=1) + "\n")
    page = out / "simulated_faults.md"
    page.write_text(simulation_page.filled(page.read_text() if page.exists() else None, results))


if __name__ == "__main__":
    sys.exit(main())
