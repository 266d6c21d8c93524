"""How robots stand, as a table, as JSON, and while they are being sent a mission."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import threading
import time
from dataclasses import replace
from typing import Any, Dict, Iterator, List, Optional, Sequence, TextIO, Tuple

from pursue_gen.transport.client import Robot, Status
from pursue_gen.transport.sender import Progress, Row
from pursue_runtime.manifest import mission_id

_HEAD = ("robot", "address", "now", "before", "prepared", "outcome")
_REDRAW = 0.1
"""Seconds from one drawing to the next."""


def table(rows: Sequence[Row], looked: bool = False) -> List[str]:
    """One line per robot, below a head; `?` where something is not known, `-` where there is nothing.

    `before` is what it had before it was sent something; where it was only `looked` at, before what it has now.
    """
    cells = [_HEAD, *(_cells(row, looked) for row in rows)]
    widths = [max(len(line[column]) for line in cells) for column in range(len(_HEAD) - 1)]
    return ["  ".join((*(cell.ljust(width) for cell, width in zip(line, widths)), line[-1])) for line in cells]


def _cells(row: Row, looked: bool) -> Tuple[str, ...]:
    after = row.after
    prepared = "?" if after is None else "-" if after.prepared is None else mission_id(after.prepared)
    now = "?" if after is None else _plays(after, f" ({after.scenario})" if after.scenario else "")
    return (row.robot.name, row.robot.address, now, _earlier(row, looked), prepared, row.outcome)


def _earlier(row: Row, looked: bool) -> str:
    if row.before is None:
        return "?"
    if not looked:
        return _plays(row.before)
    return mission_id(row.before.history[-1]) if row.before.history else "-"


def _plays(status: Status, scenario: str = "") -> str:
    follows = "" if status.next is None else f", then {mission_id(status.next)}"
    return f"{mission_id(status.current)}{scenario}{follows}"


def as_json(rows: Sequence[Row], **facts: Any) -> Dict[str, Any]:
    """The rows for programs; missions are digests in full, "" the workspace's own. `facts` come first."""
    robots = [
        {
            "robot": row.robot.name,
            "address": row.robot.address,
            "outcome": row.outcome,
            "same": row.same,
            "before": _facts(row.before),
            "now": _facts(row.after),
        }
        for row in rows
    ]
    return {**facts, "robots": robots}


def _facts(status: Optional[Status]) -> Optional[Dict[str, Any]]:
    if status is None:
        return None
    return {name: value for name, value in vars(status).items() if name not in ("robot", "ticket")}


def standing_told(rows: Sequence[Row]) -> Tuple[Row, ...]:
    """The rows with what a robot does now as their outcome; what was said before was the same."""
    told = []
    for row in rows:
        if row.after is None:
            told.append(replace(row, outcome=f"not reached: {row.outcome}"))
        else:
            told.append(replace(row, outcome="a mission is under way" if row.after.mission_runs else "no mission runs"))
    return tuple(told)


@contextlib.contextmanager
def upload_lines(quiet: bool = False, stream: Optional[TextIO] = None) -> Iterator[Optional[Progress]]:
    """Draws a line per robot on the stream (stderr) while it is being sent a bundle; erased at the end.

    None where nothing is to be drawn: `quiet`, or the stream is no terminal that can do it.
    """
    out = sys.stderr if stream is None else stream
    if quiet or os.environ.get("TERM", "dumb") == "dumb" or not out.isatty():
        yield None
        return
    lines = _Lines(out)
    try:
        yield lines.show
    finally:
        lines.erase()


class _Lines:
    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._lock = threading.Lock()
        self._sent: Dict[str, Tuple[int, int]] = {}
        self._drawn = 0
        self._next = 0.0

    def show(self, robot: Robot, sent: int, size: int) -> None:
        """Draws all lines, unless that was done a moment ago and there is more to come."""
        with self._lock:
            self._sent[robot.name] = (sent, size)
            if time.monotonic() >= self._next or sent == size:
                self._next = time.monotonic() + _REDRAW
                self._draw()

    def _draw(self) -> None:
        columns = shutil.get_terminal_size().columns - 1
        width = max(map(len, self._sent))
        up = f"\033[{self._drawn}A" if self._drawn else ""
        lines = [f"{name:{width}}  {sent} of {size} bytes"[:columns] for name, (sent, size) in self._sent.items()]
        self._stream.write(up + "".join(f"\r{line}\033[K\n" for line in lines))
        self._stream.flush()
        self._drawn = len(lines)

    def erase(self) -> None:
        """Leaves the terminal as it was."""
        with self._lock:
            if self._drawn:
                self._stream.write(f"\033[{self._drawn}A\r\033[J")
                self._stream.flush()
