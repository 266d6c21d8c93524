"""What the whole command `solve` takes: start of Python, reading, verdict, proof, guaranteed time and margin.

Each row is a process `pursue-gen solve` of its own, as people call it. A limit ends it from outside, because one that
is given to the command changes what it does. What counts is processor time, user and system.
"""

from __future__ import annotations

import json
import re
import sys
import tempfile
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional, Tuple

from benchmarks.families import FAMILIES
from benchmarks.measure import GAMES, ROOT, Bounds, Row
from benchmarks.ordinary_families import ORDINARY
from benchmarks.process import Ran, run
from benchmarks.tables import markdown, number, seconds, verdict
from pursue_gen.outcomes import LimitHit, Lost

_QUICK_COMMAND = 5.0
"""Seconds of the processor: what takes less is measured twice, and the better figure counts."""

_BY_THE_CLOCK = 40
"""On a machine that many share a command may take so many times its processor time."""

_STORIES = "stories/"


@dataclass(frozen=True)
class Goal:
    """A command and the processor time that it should take at most, in seconds.

    `name`: a file of scenarios/ or of the stories without its suffix, a published scenario, or a family with its
    `size`. `least`: the least worst-case time of the game in time units, where it is known (docs/solver.md, and for
    the delivery that of the strategy in one piece).
    """

    name: str
    game: str
    seconds: float
    size: Optional[int] = None
    least: Optional[float] = None

    @property
    def title(self) -> str:
        """How tables name it."""
        name = self.name.rsplit("/", 1)[-1].replace("_", " ")
        if self.name.startswith(_STORIES):
            return f"{name} story"
        return name if self.size is None else f"{name} {self.size}"


GOALS: Tuple[Goal, ...] = (
    Goal("thesis/scenario_1", "default", 0.4, least=23.3),
    Goal("thesis/scenario_2", "default", 0.4, least=23.3),
    Goal("thesis/scenario_3", "default", 0.4, least=23.4),
    Goal("thesis/scenario_4", "default", 0.4, least=26.4),
    Goal("thesis/catch_the_thief", "default", 0.6, least=20.6),
    Goal("CT1", "ideal", 1, least=56),
    Goal("CT1", "default", 1, least=61.9),
    Goal("CT2a", "ideal", 1, least=70),
    Goal("CT2a", "default", 1, least=79.2),
    Goal("CT4", "ideal", 1, least=93),
    Goal("CT4", "default", 1, least=117.8),
    Goal("CT5", "ideal", 1),
    Goal("CT5", "default", 1),
    Goal("EB2", "ideal", 1),
    Goal("EB2x", "ideal", 1),
    Goal("EB4", "ideal", 10),
    Goal("CT3b", "default", 3),
    Goal("drug_delivery/drug_delivery", "ideal", 3),
    Goal("drug_delivery/drug_delivery", "default", 3),
    Goal("stories/hotel", "default", 5),
    Goal("stories/airport", "default", 5),
    Goal("stories/museum", "default", 5),
    Goal("delivery", "default", 10, size=4),
    Goal("delivery", "default", 10, size=20),
    Goal("visitors", "default", 30, size=6),
    Goal("bystanders", "default", 0.6, size=0),
    Goal("bystanders", "default", 0.6, size=50),
    Goal("cleaning", "default", 10, size=20),
    Goal("chase", "default", 10, size=20),
    Goal("round in any order", "default", 10, size=30),
    Goal("hotel", "default", 10, size=150),
    Goal("ring", "default", 10, size=150),
)
"""The commands that are measured, with what they should take on a machine like the one of docs/benchmarks.md."""

QUICK = ("thesis/scenario_1", "bystanders")
"""The ones of a short run."""


def files_of(goal: Goal, published: Path, folder: Path) -> List[Path]:
    """The files of the command; a member of a family is written into the folder. Empty where they are not at hand."""
    if goal.size is not None:
        family = next(family for family in (*FAMILIES, *ORDINARY) if family.name == goal.name)
        member = folder / f"{re.sub('[^a-z]+', '_', goal.name)}_{goal.size}.pur"
        member.write_text(family.text(goal.size))
        return [member]
    if "/" not in goal.name:
        files = [published / goal.name / "TGA.xml", published / goal.name / "TCTL.q"]
        return files if all(file.is_file() for file in files) else []
    place = ROOT / ("benchmarks" if goal.name.startswith(_STORIES) else "scenarios")
    return [place / f"{goal.name}.pur"]


def commands_measured(goals: Iterable[Goal], published: Path, bounds: Bounds) -> Iterator[Row]:
    """A row for each command whose files are at hand."""
    with tempfile.TemporaryDirectory() as folder:
        for goal in goals:
            files = files_of(goal, published, Path(folder))
            if files:
                row = command_measured(goal, files, Path(folder), bounds)
                if row["cpu"] < _QUICK_COMMAND:
                    again = command_measured(goal, files, Path(folder), bounds)
                    row = min(row, again, key=lambda one: float(one["cpu"]))
                yield row


def command_measured(goal: Goal, files: List[Path], folder: Path, bounds: Bounds, memory: int = 0) -> Row:
    """What the command takes; with `memory`, so many MiB are its own limit, and addresses end not far above it.

    Keys: as of `measured`, and cpu (processor seconds), goal (the same, as it should be), worst (time units, what the
    strategy guarantees) and least (of the game, where it is known).
    """
    ends, reaction = GAMES[goal.game]
    rules = ["--ends", ends, "--reaction", str(reaction)] if goal.game != "default" else []
    command = [sys.executable, "-m", "pursue_gen", "solve", *map(str, files), *rules, "--json"]
    command += ["--memory", str(memory)] if memory else []
    addresses = memory + 1024 if memory else 0  # as in measure.py: libraries need some too
    ran = run([*command, "-o", str(folder / "plan.txt")], 2 * bounds.seconds, ROOT, addresses, _BY_THE_CLOCK)
    row: Row = {"group": "command", "name": goal.title, "size": goal.size, "game": goal.game, "outcome": ""}
    row.update(cpu=round(ran.cpu, 3), memory=round(ran.memory, 1), goal=goal.seconds, least=goal.least)
    row.update(_outcome(ran))
    return row


def _outcome(ran: Ran) -> Dict[str, Any]:
    if ran.late:
        return {"outcome": "time"}
    if ran.status not in (0, Lost.exit_status, LimitHit.exit_status):
        findings = [line for line in ran.err.splitlines() if ": error " in line]
        return {"outcome": ((findings or [ran.last_line])[0] or f"it ended with status {ran.status}")[:120]}
    try:
        said = json.loads(ran.out)
    except ValueError:
        return {"outcome": "it printed no verdict"}
    if said.get("won") is None:
        message = said["diagnostics"][0]["message"] if said.get("diagnostics") else ""
        return {"outcome": "memory" if "memory" in message else "time", "reason": message.split(";")[0]}
    if not said["won"]:
        return {"verdict": "lost"}
    worst = said.get("time", {}).get("worst")
    return {
        "verdict": "won",
        **{key: said[key] for key in ("states", "zones", "engine", "blocks", "commands") if key in said},
        "worst": None if worst is None else float(Fraction(worst)),
    }


# Tables --------------------------------------------------------------------------------------------------------------


def table(rows: List[Row]) -> str:
    """What the commands take beside what they should."""
    head = ("scenario", "game", "verdict", "processor time, s", "goal, s", "MiB", "commands", "guaranteed time")
    lines = [
        [row["name"], row["game"], verdict(row), seconds(row["cpu"]), f"{row['goal']:g}", number(row["memory"])]
        + [number(row.get("commands")), _time(row.get("worst"))]
        for row in _mine(rows)
    ]
    reached = [row for row in _mine(rows) if row.get("verdict") and row["cpu"] <= row["goal"]]
    text = markdown(head, lines, left=3)
    dates = sorted({row["date"] for row in _mine(rows) if "date" in row and "version" not in row})
    measured = f" Measured {', '.join(dates)}." if dates else ""
    return f"{text}\n{len(reached)} of {len(lines)} reach the goal.{measured}\n"


def times_table(rows: List[Row]) -> str:
    """What the strategies guarantee beside the least that any does."""
    known = [row for row in _mine(rows) if row.get("least") and row.get("worst")]
    lines = [
        [row["name"], row["game"], _time(row["worst"]), f"{row['least']:g}", f"{row['worst'] / row['least']:.3f}"]
        for row in known
    ]
    return markdown(("scenario", "game", "guaranteed time", "least worst-case time", "quotient"), lines)


def _mine(rows: List[Row]) -> List[Row]:
    return [row for row in rows if row["group"] == "command"]


def _time(value: Optional[float]) -> str:
    return "-" if value is None else f"{value:g}"


def terminal(row: Row) -> str:
    """A line for the terminal."""
    cpu, goal = seconds(row["cpu"]), f"{row['goal']:g}"
    name = f"solve {row['name']}"
    return f"{name:34} {row['game']:8} {verdict(row):12} {cpu:>9} s of processor time, goal {goal} s"
