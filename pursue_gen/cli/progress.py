"""How far a search is: on one line of a terminal, redrawn in place; elsewhere a line every ten seconds."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from typing import Iterator, Optional, TextIO

from pursue_gen.synthesis.limits import Listener, Progress

_PATIENCE = 0.5
"""Nothing is shown of work that takes no longer than so many seconds."""

_REDRAW = 0.2
"""Seconds from one drawing to the next."""

_INTERVAL = 10.0
"""Seconds from one line to the next where nothing can be redrawn."""


@contextlib.contextmanager
def progress_line(quiet: bool = False, stream: Optional[TextIO] = None) -> Iterator[Optional[Listener]]:
    """A listener that draws the line on the stream (stderr); erased at the end, however the work ends.

    Where the stream is no terminal that can do that, it writes a line every ten seconds. None where it is `quiet`.
    """
    out = sys.stderr if stream is None else stream
    if quiet:
        yield None
        return
    if os.environ.get("TERM", "dumb") == "dumb" or not out.isatty():
        yield _Lines(out).show
        return
    line = _Line(out)
    try:
        yield line.show
    finally:
        line.erase()


class _Line:
    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._start = time.monotonic()
        self._next = self._start + _PATIENCE
        self._drawn = False

    def show(self, progress: Progress) -> None:
        """Draws it, unless that was done less than `_REDRAW` seconds ago."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _REDRAW
        self._drawn = True
        text = in_words(progress, now - self._start)[: _columns(self._stream) - 1]
        self._stream.write(f"\r{text}\033[K")
        self._stream.flush()

    def erase(self) -> None:
        """Leaves the line as it was."""
        if self._drawn:
            self._stream.write("\r\033[K")
            self._stream.flush()


class _Lines:
    """Progress where lines stay, as in a log."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._start = time.monotonic()
        self._next = self._start + _INTERVAL

    def show(self, progress: Progress) -> None:
        """Writes a line, unless that was done less than `_INTERVAL` seconds ago."""
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _INTERVAL
        self._stream.write(f"{in_words(progress, now - self._start)}\n")
        self._stream.flush()


def in_words(progress: Progress, elapsed: float) -> str:
    """One line; `elapsed` are the seconds since all of the work began."""
    words = [f"{progress.states} states", f"{progress.waiting} waiting"]
    if progress.seconds > _REDRAW:  # of less time a rate says nothing
        words.append(f"{progress.states / progress.seconds:.0f} states/s")
    return f"{progress.phase}: {', '.join(words)}, {progress.memory} MiB, {elapsed:.0f} s"


def _columns(stream: TextIO) -> int:
    """The width of the terminal."""
    try:
        return os.get_terminal_size(stream.fileno()).columns or 80
    except (OSError, ValueError):
        return 80
