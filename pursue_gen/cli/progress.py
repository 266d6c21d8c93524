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
    if quiet:
        yield None
        return
    line = _Paced(TerminalLine(sys.stderr if stream is None else stream))
    try:
        yield line.show
    finally:
        line.line.erase()


class TerminalLine:
    """A line of a terminal, redrawn in place; where that cannot be (`redrawn` is False), lines that stay."""

    def __init__(self, stream: TextIO) -> None:
        self.redrawn = os.environ.get("TERM", "dumb") != "dumb" and stream.isatty()
        self._stream, self._drawn = stream, False

    def show(self, text: str) -> None:
        """Draws or writes the text, cut where the terminal ends."""
        self._drawn = self.redrawn  # first: a Ctrl-C may come behind what is written
        self._stream.write(f"\r{text[: _columns(self._stream) - 1]}\033[K" if self.redrawn else f"{text}\n")
        self._stream.flush()

    def erase(self) -> None:
        """Leaves the line as it was."""
        if self._drawn:
            self._stream.write("\r\033[K")
            self._stream.flush()


class _Paced:
    """Progress on such a line, now and then."""

    def __init__(self, line: TerminalLine) -> None:
        self.line = line
        self._start = time.monotonic()
        self._pause = _REDRAW if line.redrawn else _INTERVAL
        self._next = self._start + (_PATIENCE if line.redrawn else _INTERVAL)

    def show(self, progress: Progress) -> None:
        """Shows it, unless that was done less than `_REDRAW` seconds ago (`_INTERVAL` where lines stay)."""
        now = time.monotonic()
        if now >= self._next:
            self._next = now + self._pause
            self.line.show(in_words(progress, now - self._start))


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
