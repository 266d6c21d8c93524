"""A game on the disk: as a trace for the node UI, or as a journal that `pursue-gen replay` reads."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Iterator

from pursue_gen import __version__
from pursue_gen.files import write_texts
from pursue_gen.language.numbers import time_text
from pursue_gen.solving.rules import rules_text
from pursue_gen.tools.play.state import LOST, ROBOTS, RUNNING, WON, PlayState, Setup
from pursue_runtime.observer.records import FORMAT, format_record

_START = 1000.0
"""The moment (seconds of ROS time) at which the mission of a journal starts."""


def save(setup: Setup, play: PlayState, file: Path) -> str:
    """Writes the game; what was written, in words. A name that ends with .jsonl gets a journal, every other a trace.

    Raises PursueError where the file cannot be written.
    """
    journal = file.suffix == ".jsonl"
    records = (format_record(number, record).decode() for number, record in enumerate(_journal(setup, play)))
    write_texts({file: "".join(records if journal else (f"{line}\n" for line in _trace(setup, play)))})
    if journal:
        return f"{file} is a journal of this game: pursue-gen replay {file} {setup.scenario.file}"
    return f"{file} is a trace of what others began to do, for the node UI: rosrun UI UI --trace {file}"


def _trace(setup: Setup, play: PlayState) -> Iterator[str]:
    """What was begun by agents that nobody controls; ends are the simulator's business."""
    yield f"# A game of {setup.scenario.name} ({rules_text(setup.rules)}), played with pursue-gen {__version__}"
    others = {agent.name for agent in setup.scenario.agents if not agent.controllable}
    begun = [deed for deed in play.deeds if deed.agent in others and not setup.game.origins[deed.edges[0]].is_end]
    for deed in begun:
        yield f"- {{at: {time_text(deed.at)}, do: '{deed.agent}:{deed.word}'}}"
    if not begun:
        yield "[]"


def _journal(setup: Setup, play: PlayState) -> Iterator[Dict[str, Any]]:
    yield {"format": FORMAT, "scenario": setup.scenario.name, "settings": {"time_unit": 1.0}}
    status = {LOST: "lost", WON: "won"}.get(play.status, "running")
    yield {"at": _START, "call": "hear", "args": ["_start_"], "seq": 1, "status": RUNNING}
    for number, deed in enumerate(play.deeds, start=2):
        last = deed is play.deeds[-1] and play.now == deed.at
        word = f"{deed.agent}:{deed.word}"
        word += f"@{number - 1}" if deed.by == ROBOTS else ""  # a command names the state that it is for
        entry = {"at": _START + float(deed.at), "call": "hear", "args": [word], "seq": number}
        yield {**entry, "status": status if last else "running"}
    if status == "lost" and play.deeds and play.now > play.deeds[-1].at:
        entry = {"at": _START + float(play.now), "call": "tick", "args": [], "seq": len(play.deeds) + 1}
        yield {**entry, "status": status}
