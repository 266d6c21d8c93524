"""How many missions have been played, and how much of a bundle each robot has got: on lines of a terminal that are
redrawn in place."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import sys
import threading
import time
from typing import TYPE_CHECKING, Callable, Dict, Iterator, Optional, TextIO, Tuple

from pursue_gen.cli.progress import TerminalLine

if TYPE_CHECKING:
    from pursue_gen.tools.transport.client import Robot
    from pursue_gen.tools.transport.sender import Progress

_REDRAW, _INTERVAL, _UPLOADS = 0.5, 10.0, 0.1
"""Seconds from one drawing to the next, from one line to the next where nothing can be redrawn, and from one drawing of
uploads to the next."""


@contextlib.contextmanager
def counting(all_: int, quiet: bool = False) -> Iterator[Callable[[int], None]]:
    """A listener for how many of all missions are done; its line on stderr is erased at the end, however that comes.

    Where it cannot be redrawn, a line comes every ten seconds. It goes on while one mission takes long, as where a new
    plan is looked for. Nothing is drawn if `quiet`.
    """
    if quiet:
        yield lambda done: None
        return
    line, start, known, over = TerminalLine(sys.stderr), time.monotonic(), [0], threading.Event()

    def draw() -> None:
        while not over.wait(_REDRAW if line.redrawn else _INTERVAL):
            line.show(_in_words(known[0], all_, time.monotonic() - start))

    drawer = threading.Thread(target=draw, daemon=True)
    # Else a Ctrl-C that the main thread has blocked, as where it starts processes, would come by way of this one.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        drawer.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    try:
        yield lambda done: known.__setitem__(0, done)
    finally:
        over.set()
        drawer.join()
        line.erase()


def _in_words(done: int, all_: int, seconds: float) -> str:
    from pursue_gen.tools.simulation.planner import SEARCHES

    pace = f", {60 * done / seconds:,.0f} a minute" if done > 1 else ""
    what = ", a new plan is looked for" if SEARCHES.is_set() else ""
    return f"simulating: {done:,} of {all_:,} missions{pace}, {seconds:.0f} s{what}"


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
        """Draws all lines, unless that was done less than `_UPLOADS` seconds ago and there is more to come."""
        with self._lock:
            self._sent[robot.name] = (sent, size)
            if time.monotonic() >= self._next or sent == size:
                self._next = time.monotonic() + _UPLOADS
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
