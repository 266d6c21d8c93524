"""A game on the disk: as a trace for the node UI, or as a journal that `pursue-gen replay` reads."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Iterator

from pursue_gen import __version__
from pursue_gen.explanation.words import time_text
from pursue_gen.files import write_texts
from pursue_gen.play.table import LOST, ROBOTS, RUNNING, WON, Board, Deed, Table
from pursue_gen.solving.rules import rules_text
from pursue_gen.tga.network import is_end

_START = 1000.0
"""The moment (seconds of ROS time) at which the mission of a journal starts."""


def save(board: Board, table: Table, file: Path) -> str:
    """Writes the game; what was written, in words. A name that ends with .jsonl gets a journal, every other a trace.

    Raises PursueError where the file cannot be written.
    """
    journal = file.suffix == ".jsonl"
    write_texts({file: "".join(line + "\n" for line in (_journal if journal else _trace)(board, table))})
    if journal:
        return f"{file} is a journal of this game: pursue-gen replay {file} {board.scenario.file}"
    return f"{file} is a trace of what others began to do, for the node UI: rosrun UI UI --trace {file}"


def _trace(board: Board, table: Table) -> Iterator[str]:
    """What was begun by agents that nobody controls; ends are the simulator's business."""
    yield f"# A game of {board.scenario.name} ({rules_text(board.rules)}), played with pursue-gen {__version__}"
    others = {agent.name for agent in board.scenario.agents if not agent.controllable}
    begun = [deed for deed in table.deeds if deed.agent in others and not _ends(board, deed)]
    for deed in begun:
        yield f"- {{at: {time_text(deed.at)}, do: '{deed.agent}:{deed.word}'}}"
    if not begun:
        yield "[]"


def _ends(board: Board, deed: Deed) -> bool:
    return is_end(board.game.origins[deed.edges[0]])


def _journal(board: Board, table: Table) -> Iterator[str]:
    yield json.dumps({"format": 1, "scenario": board.scenario.name, "settings": {"time_unit": 1.0}})
    status = {LOST: "lost", WON: "won"}.get(table.status, "running")
    yield json.dumps({"at": _START, "call": "hear", "args": ["_start_"], "seq": 1, "status": RUNNING})
    for number, deed in enumerate(table.deeds, start=2):
        last = deed is table.deeds[-1] and table.now == deed.at
        word = f"{deed.agent}:{deed.word}"
        word += f"@{number - 1}" if deed.by == ROBOTS else ""  # a command names the state that it is for
        entry = {"at": _START + float(deed.at), "call": "hear", "args": [word], "seq": number}
        yield json.dumps({**entry, "status": status if last else "running"})
    if status == "lost" and table.deeds and table.now > table.deeds[-1].at:
        entry = {"at": _START + float(table.now), "call": "tick", "args": [], "seq": len(table.deeds) + 1}
        yield json.dumps({**entry, "status": status})
