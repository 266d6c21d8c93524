"""The measurement of one game in a process of its own: `python -m benchmarks.measure` reads a case from stdin (JSON).

It prints a line of JSON after each stage, the last one with everything; its caller takes the last line that came.
"""

from __future__ import annotations

import json
import resource
import signal
import statistics
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

ROOT = Path(__file__).resolve().parent.parent
GAMES = {"ideal": ("controllable", Fraction(0)), "default": ("reported", Fraction(1, 10))}
"""The two games: who controls the ends, and the reaction in time units."""

SHORT, RUNS, FAMILY_RUNS = 0.5, 7, 3
"""Games that take less than so many seconds are solved so often, and the median counts."""

MARGIN_STATES = {"story": 5_000}
"""Limit of the search for a margin, in symbolic states of the checker; beyond it the margin is only a lower bound."""

_BY_THE_CLOCK = 10
"""On a busy machine deciding and proving may take so many times their limit by the clock."""

Row = Dict[str, Any]


@dataclass(frozen=True)
class Case:
    """A game to measure: `group` ("thesis", "story", "reference", "family" or "file"), `name`, `game` (a key of GAMES).

    Families have a `size`. The scenario is in `file` (a .pur, or a network beside its TCTL.q), or it is `text`.
    """

    group: str
    name: str
    game: str
    size: Optional[int] = None
    file: Optional[str] = None
    text: Optional[str] = None

    @property
    def key(self) -> Tuple[str, str, int, str]:
        """The identity of a case."""
        return (self.group, self.name, -1 if self.size is None else self.size, self.game)


@dataclass(frozen=True)
class Bounds:
    """Limits of a case: processor seconds to decide and as many to prove (twice that together), MiB of the process."""

    seconds: float
    memory: int


def measured(case: Case, bounds: Bounds) -> Row:
    """The costs of the case, measured in another process; `outcome`: the stage that did not end, or "".

    Keys: those of the case (without its text), verdict ("won", "lost" or None), outcome, states, zones, seconds
    (median; of the solver alone, of a family's members processor time of solving and proving), runs, decided and proof
    (processor time of the solver's whole call, tables and strategy included, and of the checker), memory (MiB, peak of
    the process up to there), blocks, commands, stages, margin (time units), margin_open (it is at least that).
    """
    row: Row = {"group": case.group, "name": case.name, "size": case.size, "game": case.game, "outcome": ""}
    job = json.dumps({"case": asdict(case), "bounds": asdict(bounds)})
    command = [sys.executable, "-m", "benchmarks.measure"]
    pipes: Dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    late = False
    with subprocess.Popen(command, cwd=str(ROOT), universal_newlines=True, **pipes) as process:
        try:
            out, err = process.communicate(job, timeout=_BY_THE_CLOCK * bounds.seconds + 60)
        except subprocess.TimeoutExpired:
            late = True
            process.kill()
            out, err = process.communicate()
    whole = [line for line in out.splitlines() if line.endswith("}")]
    row.update(json.loads(whole[-1]) if whole else {"outcome": "time" if late else ""})
    if process.returncode and not late:
        # Killed by the system, or Python ran out of what RLIMIT_AS leaves it.
        killed = process.returncode < 0 or "MemoryError" in err or "bad_alloc" in err
        reason = (err.strip().splitlines() or ["failed"])[-1].split("PursueError: ")[-1][:120]
        row["outcome"] = ("proof" if whole else "memory") if killed else reason
    return row


def _measure(case: Case, bounds: Bounds) -> None:
    """The costs of the case: of a member of a family as the commands solve it, else of the engine and the checker."""
    from pursue_gen.solving.rules import Rules

    network, objective = game_of(case)
    how = _as_commands_do if case.group == "family" else _in_one_piece
    how(case, network, objective, Rules(*GAMES[case.game]), bounds)


def _in_one_piece(case: Case, network: Any, objective: Any, rules: Any, bounds: Bounds) -> None:
    """Decide, prove and compute the margin; print the costs after each of these stages."""
    from pursue_gen.outcomes import LimitHit, NotProven
    from pursue_gen.proof.margin import strategy_margin
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.proving import prove
    from pursue_gen.solving.rules import played
    from pursue_gen.synthesis.limits import Limits
    from pursue_gen.synthesis.solve import solve

    network = played(network, rules)
    limits = Limits(memory=bounds.memory)
    row: Row = {}
    try:
        start = time.process_time()
        with _at_most(bounds.seconds):
            verdict = solve(network, objective, reaction=rules.reaction, limits=limits)
        row.update(decided=time.process_time() - start, verdict="won" if verdict.won else "lost")
        row.update(_counted(verdict.stats), seconds=verdict.stats.seconds, runs=1, memory=_peak())
        _print({**row, "outcome": "proof" if verdict.won else ""})
        if verdict.stats.seconds < SHORT:
            again = [solve(network, objective, reaction=rules.reaction).stats.seconds for _ in range(RUNS - 1)]
            row.update(seconds=statistics.median([verdict.stats.seconds, *again]), runs=RUNS)
        if verdict.strategy is None:
            _print(row)
            return
        start = time.process_time()
        with _at_most(bounds.seconds):
            strategy = prove(network, objective, verdict.strategy, rules.reaction, verdict.ranks, SolveOptions(limits))
        row.update(_size(strategy), proof=time.process_time() - start, memory=_peak())
        _print(row)
    except (LimitHit, NotProven) as problem:
        message = problem.diagnostics[0].message.split(";")[0]
        failure = "refused" if isinstance(problem, NotProven) else "proof" if row else _which_limit(message)
        _print({**row, "outcome": failure, "reason": message, "memory": _peak()})
        return
    except _TooLong:
        _print({**row, "outcome": "proof" if row else "time", "memory": _peak()})
        return
    found = strategy_margin(network, objective, strategy, rules.reaction, MARGIN_STATES.get(case.group, 50_000))
    _print({**row, "margin": float(found.wins), "margin_open": found.fails is None})


def _as_commands_do(case: Case, network: Any, objective: Any, rules: Any, bounds: Bounds) -> None:
    """Solve and prove, with some of the robots and in stages where that helps; print what both took together."""
    from pursue_gen.outcomes import LimitHit, Lost
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.rules import played
    from pursue_gen.solving.solution import solution
    from pursue_gen.synthesis.limits import Limits
    from pursue_gen.synthesis.solve import solve

    options = SolveOptions(Limits(memory=bounds.memory))
    seconds: List[float] = []
    while not seconds or (seconds[0] < SHORT and len(seconds) < FAMILY_RUNS):
        start = time.process_time()
        try:
            with _at_most(2 * bounds.seconds):
                won = solution(network, objective, rules, options)
            row = {"verdict": "won", **_counted(won.stats), **_size(won.strategy), "stages": len(won.strategy.stages)}
        except Lost:
            row = {"verdict": "lost"}
        except LimitHit as problem:
            message = problem.diagnostics[0].message.split(";")[0]
            _print({"outcome": _which_limit(message), "reason": message, "memory": _peak()})
            return
        except _TooLong:
            _print({"outcome": "time", "memory": _peak()})
            return
        seconds.append(time.process_time() - start)
    row.update(seconds=statistics.median(seconds), runs=len(seconds), memory=_peak())
    if row["verdict"] == "lost":
        row.update(_counted(solve(played(network, rules), objective, rules.reaction).stats))
    _print(row)


class _TooLong(BaseException):
    """The limit on processor time; like Ctrl-C it ends all loops, and nothing goes on after it with a way around."""


@contextmanager
def _at_most(seconds: float) -> Iterator[None]:
    """Raises _TooLong after so many processor seconds: on a busy machine as much work is done as on an idle one."""

    def too_long(*_: Any) -> None:
        raise _TooLong

    signal.signal(signal.SIGPROF, too_long)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def _counted(stats: Any) -> Row:
    """What an engine counted."""
    return {
        "engine": stats.engine,
        "states": stats.discrete_states,
        "zones": stats.zones,
        "symbolic": stats.symbolic_states,
    }


def _size(strategy: Any) -> Row:
    """How large a strategy is."""
    return {"blocks": len(strategy.blocks), "commands": sum(len(block.commands) for block in strategy.blocks)}


def _which_limit(message: str) -> str:
    """The outcome at a limit, by the message that names it."""
    return "memory" if "memory" in message else "time"


def game_of(case: Case) -> Tuple[Any, Any]:
    """Network and objective of the case."""
    from pursue_gen.language import load, parse
    from pursue_gen.tga import scenario_objective, translate
    from pursue_gen.tga.uppaal import read_network, read_query

    if case.text is None and str(case.file).endswith(".xml"):
        file = Path(str(case.file))
        query = file.parent / "TCTL.q"
        return read_network(file.read_text(), str(file)), read_query(query.read_text(), str(query))
    scenario = load(Path(str(case.file))) if case.text is None else parse(case.text, f"{case.name}.pur", "member")
    return translate(scenario), scenario_objective(scenario)


def _peak() -> float:
    """The most memory that this process has had, in MiB."""
    try:
        # ru_maxrss also counts what the process that started this one had.
        status = Path("/proc/self/status").read_text()
        return int(status.split("VmHWM:")[1].split()[0]) / 1024
    except (OSError, IndexError):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def _print(row: Row) -> None:
    rounded = {key: round(value, 6) if isinstance(value, float) else value for key, value in row.items()}
    print(json.dumps({"outcome": "", **rounded}), flush=True)


def main() -> None:
    """Measures the case on standard input."""
    job = json.load(sys.stdin)
    bounds = Bounds(**job["bounds"])
    limit = (bounds.memory + 1024) * 2**20  # the solver's own limit comes first; libraries need addresses too
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))
    _measure(Case(**job["case"]), bounds)


if __name__ == "__main__":
    main()
