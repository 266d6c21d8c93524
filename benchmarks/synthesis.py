"""Prints how long synthesis takes: `python benchmarks/synthesis.py [SCENARIO.pur | TGA.xml ...]`.

Without arguments: the scenarios in scenarios/, and the published ones where they are at hand (beside the project in
shared/reference, or where PURSUE_REFERENCE says). Each game is decided in a process of its own, the ideal one and the
default one; times are those of one run, so quote them with the machine they come from.

columns: discrete states; those per second; seconds to decide; seconds to prove; peak memory of the process (MiB);
blocks and commands of the proven strategy.
"""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
import time
from fractions import Fraction
from pathlib import Path
from typing import Dict, Iterator, List, Tuple, Union

ROOT = Path(__file__).resolve().parent.parent
GAMES = {"ideal": ("controllable", Fraction(0)), "default": ("reported", Fraction(1, 10))}
LIMIT = 120.0  # seconds to decide a game

Row = Dict[str, Union[str, int, float]]


def measured(file: Path, game: str) -> Row:
    """Decides and proves one game in this process."""
    from pursue_gen.language import load
    from pursue_gen.pipeline import Rules, played, prove
    from pursue_gen.synthesis.solve import solve
    from pursue_gen.tga import scenario_objective, translate
    from pursue_gen.tga.uppaal import read_network, read_query

    if file.suffix == ".xml":
        network = read_network(file.read_text(), str(file))
        objective = read_query((file.parent / "TCTL.q").read_text(), str(file.parent / "TCTL.q"))
    else:
        scenario = load(file)
        network, objective = translate(scenario), scenario_objective(scenario)
    rules = Rules(*GAMES[game])
    network = played(network, rules)
    verdict = solve(network, objective, rules.reaction, seconds=LIMIT)
    row: Row = {"verdict": "won" if verdict.won else "lost", "states": verdict.stats.discrete_states}
    row["seconds"] = verdict.stats.seconds
    if verdict.strategy is not None:
        start = time.perf_counter()
        strategy = prove(network, objective, verdict.strategy, rules.reaction, verdict.ranks)
        row["proof"] = time.perf_counter() - start
        row["blocks"] = len(strategy.blocks)
        row["commands"] = sum(len(block.commands) for block in strategy.blocks)
    row["memory"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return row


def files(arguments: List[str]) -> Iterator[Tuple[str, Path]]:
    """What to measure, with a name for each."""
    if arguments:
        yield from ((argument, Path(argument)) for argument in arguments)
        return
    for file in sorted((ROOT / "scenarios").glob("*/*.pur")):
        yield f"{file.parent.name}/{file.stem}", file
    published = Path(os.environ.get("PURSUE_REFERENCE", ROOT.parent / "shared" / "reference")) / "pursue-scenarios"
    for file in sorted(published.glob("*/TGA.xml")):
        yield file.parent.name, file


def main() -> int:
    """Prints the table, a row at a time."""
    if sys.argv[1:2] == ["--one"]:
        print(json.dumps(measured(Path(sys.argv[2]), sys.argv[3])))
        return 0
    head = f"{'scenario':32} {'game':8} {'verdict':8} {'states':>8} {'states/s':>9} {'seconds':>8} {'proof':>7}"
    print(f"{head} {'MiB':>6} {'blocks':>7} {'commands':>8}")
    for name, file in files(sys.argv[1:]):
        for game in GAMES:
            command = [sys.executable, __file__, "--one", str(file), game]
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
            if done.returncode:
                print(f"{name:32} {game:8} {done.stderr.strip().splitlines()[-1][:90]}", flush=True)
                continue
            row = json.loads(done.stdout)
            rate = row["states"] / max(row["seconds"], 1e-9)
            line = f"{name:32} {game:8} {row['verdict']:8} {row['states']:8} {rate:9.0f} {row['seconds']:8.3f}"
            proof = f"{row['proof']:.3f}" if "proof" in row else "-"
            line += f" {proof:>7} {row['memory']:6.0f}"
            print(f"{line} {row.get('blocks', '-'):>7} {row.get('commands', '-'):>8}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
