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
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Tuple

from benchmarks import simulation_page
from benchmarks.synthesis import machine
from pursue_gen.diagnostics import PursueError
from pursue_gen.language import load
from pursue_gen.simulation.faults import read_faults
from pursue_gen.simulation.make import make_case
from pursue_gen.simulation.runs import Case, MissionRunner
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import solve_scenario

ROOT = Path(__file__).resolve().parent.parent
SCENARIOS = ROOT / "scenarios"

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
    ("all", 6000),
)
"""Faults as `--faults` takes them, and how many missions each scenario plays with them."""

WARM, BATCH, BATCHES = 50, 100, 9
"""Missions before the speed is measured, and in each of so many measurements."""


def bundled() -> List[str]:
    """The scenarios below scenarios/, without .pur, whose objective can be met in the default game."""
    return [path.relative_to(SCENARIOS).with_suffix("").as_posix() for path in sorted(SCENARIOS.rglob("*.pur"))]


def case_for(name: str, faults: str) -> Optional[Case]:
    """The case of a scenario with these faults; None where the objective cannot be met."""
    scenario = load(SCENARIOS / f"{name}.pur")
    try:
        won = solve_scenario(scenario, Rules())
    except PursueError:
        return None
    return make_case(scenario, won, SolveRequest(), "mixed", read_faults(faults), None)[0]


def cell(job: Tuple[str, str, int, float]) -> Optional[Dict[str, Any]]:
    """How the missions 1 to `runs` of a scenario end with these faults, within so many seconds of processor time."""
    name, faults, runs, seconds = job
    case = case_for(name, faults)
    if case is None:
        return None
    runner, start = MissionRunner(case), time.process_time()
    ends: Counter[str] = Counter()
    causes: Counter[str] = Counter()
    examples: List[Dict[str, Any]] = []
    latest, done = 0.0, 0
    for seed in range(1, runs + 1):
        outcome = runner.run(seed)
        done = seed
        ends[outcome.end] += 1
        latest = max(latest, outcome.lateness)
        if outcome.end in ("lost", "failed"):
            causes[kind_of(outcome.cause)] += 1
            if len(examples) < 3:
                examples.append({"seed": seed, "cause": outcome.cause or outcome.reason})
        if time.process_time() - start > seconds:
            break
    return {
        "scenario": name,
        "faults": faults,
        "missions": done,
        "margin": case.settings.margin,
        "ends": dict(sorted(ends.items())),
        "latest": round(latest, 3),
        "causes": dict(sorted(causes.items())),
        "examples": examples,
    }


def kind_of(cause: str) -> str:
    """Which kind of fault was too long: a command, the end of an agent (late, lost, early), or none ("ours")."""
    if "was due for" in cause:
        return "command"
    return "agent" if cause else "ours"


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


def _played(jobs: Sequence[Tuple[str, str, int, float]], processes: int) -> "Any":
    """The cells, each as soon as it is done."""
    if processes == 1:
        yield from (found for found in map(cell, jobs) if found)
        return
    with multiprocessing.get_context("spawn").Pool(processes) as pool:
        yield from (found for found in pool.imap_unordered(cell, jobs) if found)


def main(words: Optional[Sequence[str]] = None) -> int:
    """Plays the missions and writes the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.simulation", description=__doc__)
    parser.add_argument("--out", type=Path, help="the folder of the page, such as docs")
    parser.add_argument("--only", default="", help="faults as in the table, separated by blanks; none: all of them")
    parser.add_argument("--scenarios", nargs="*", default=[], help="such as thesis/scenario_1; none: all")
    parser.add_argument("--seconds", type=float, default=60.0, help="of processor time for each cell (60)")
    parser.add_argument("--jobs", type=int, default=1, help="so many processes (1)")
    parser.add_argument("--speed", action="store_true", help="measure missions per second, without faults")
    given = parser.parse_args(words)
    names = given.scenarios or bundled()
    path = given.out / "benchmarks" / "simulation.json" if given.out else None
    results: Dict[str, Any] = json.loads(path.read_text()) if path and path.exists() else {}
    stamp = {"date": datetime.date.today().isoformat(), "machine": machine()}
    if given.speed:
        found = {name: speed(name) for name in names}
        results["speed"] = {**stamp, "rates": {name: round(rate) for name, rate in found.items() if rate}}
        print(json.dumps(results["speed"], indent=1))
        _write(given.out, path, results)
        return 0
    wanted = given.only.split() or [faults for faults, _ in CELLS]
    jobs = [(name, faults, runs, given.seconds) for faults, runs in CELLS if faults in wanted for name in names]
    for row in _played(jobs, given.jobs):
        key = f"{row['faults']} {row['scenario']}"
        results.setdefault("cells", {})[key] = row
        results["played"] = stamp
        print(json.dumps(row), flush=True)
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
