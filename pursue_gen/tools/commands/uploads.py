"""How much of a bundle each robot has got, on lines of a terminal that are redrawn in place."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import threading
import time
from typing import Dict, Iterator, Optional, TextIO, Tuple

from pursue_gen.tools.transport.client import Robot
from pursue_gen.tools.transport.sender import Progress

_REDRAW = 0.1
"""Seconds from one drawing to the next."""


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
        """Draws all lines, unless that was done less than `_REDRAW` seconds ago and there is more to come."""
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
