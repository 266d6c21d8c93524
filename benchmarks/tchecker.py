"""TChecker beside the solver: it explores the zone graph of the same network, and says how many states it visited."""

from __future__ import annotations

import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, Sequence

from benchmarks.process import Ran, run
from benchmarks.tables import markdown, number, seconds, verdict

Row = Dict[str, Any]

ALGORITHM = "covreach"
"""Exploration of the zone graph where a state that lies within one that was visited is not looked at again."""

_FIGURE = re.compile(r"^(VISITED_STATES|RUNNING_TIME_SECONDS)[ :=]+([0-9.eE+-]+)\s*$", re.MULTILINE)


class TCheckerError(Exception):
    """No figures, and why: one line for people."""


@dataclass(frozen=True)
class Explored:
    """What an exploration took: `states`: symbolic states that were visited; `seconds`: by its own clock; `memory`:
    MiB of its process."""

    states: int
    seconds: float
    memory: float


def explored(binary: Path, text: str, limit: float, memory: int = 0) -> Explored:
    """Explores all that a file reaches, with `tck-reach` at that path.

    `limit` (seconds), `memory` (MiB, 0: none): its limits. Raises TCheckerError where there are no figures: the program
    does not start, fails, does not end in time, or prints something else.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "network.tck"
        file.write_text(text, encoding="ascii")
        try:
            ran = run([str(binary.absolute()), "-a", ALGORITHM, file.name], limit, file.parent, memory)
        except OSError as problem:
            raise TCheckerError(f"{binary} does not start: {problem.strerror}") from None
    if ran.late:
        raise TCheckerError(f"no end within {limit:g} s")
    if ran.status:
        ended = f"signal {-ran.status}" if ran.status < 0 else f"exit status {ran.status}"
        raise TCheckerError(f"{binary.name} failed with {ended}: {ran.last_line[:200] or 'it printed nothing'}")
    return _figures(binary, ran)


def _figures(binary: Path, ran: Ran) -> Explored:
    found = dict(_FIGURE.findall(ran.out))
    try:
        return Explored(int(found["VISITED_STATES"]), float(found["RUNNING_TIME_SECONDS"]), ran.memory)
    except (KeyError, ValueError):
        wanted = "lines with VISITED_STATES and RUNNING_TIME_SECONDS"
        raise TCheckerError(f"{binary.name} printed no {wanted}; is it tck-reach of TChecker 0.3 or later?") from None


def table(rows: Sequence[Row]) -> str:
    """Ours beside TChecker's figures, where it ran; else how to run it."""
    head = ("scenario", "verdict", "states", "TChecker", "seconds", "TChecker", "quotient")
    lines = []
    for row in rows:
        states, took = row.get("tchecker_states"), row.get("tchecker_seconds")
        if states is None and not row.get("tchecker_outcome"):
            continue
        name = row["name"] if row.get("size") is None else f"{row['name']} {row['size']}"
        quotient = f"{took / row['seconds']:.1f}" if took is not None and row.get("seconds") else "-"
        found = number(states) if states is not None else row["tchecker_outcome"]
        ours = [name, verdict(row), number(row.get("states")), found, seconds(row.get("seconds"))]
        lines.append([*ours, seconds(took), quotient])
    if not lines:
        return "Not measured: there was no `tck-reach` (`--tchecker PATH`).\n"
    return markdown(head, lines)
