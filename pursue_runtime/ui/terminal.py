"""Lines for a person: with colours and a progress line on a terminal, plain anywhere else."""

from __future__ import annotations

import shutil
import sys
from typing import Mapping, TextIO

GOOD, BAD, BOLD, PLAIN = "32", "31", "1", ""
"""Styles: the codes of ANSI terminals."""


def on_terminal() -> bool:
    """Return True where a person reads and writes."""
    return all(stream is not None and not stream.closed and stream.isatty() for stream in (sys.stdin, sys.stdout))


class Terminal:
    """Writes whole lines; a progress line stays at the bottom."""

    def __init__(self, stream: TextIO, environment: Mapping[str, str]) -> None:
        self._stream = stream
        self.is_terminal = stream.isatty() and environment.get("TERM") != "dumb"
        self._colours = self.is_terminal and not environment.get("NO_COLOR")
        self._unfinished = False

    def line(self, text: str, style: str = PLAIN) -> None:
        """Writes a line, above the progress line."""
        if self._colours and style:
            text = f"\033[{style}m{text}\033[0m"
        self._write(text + "\n")
        self._unfinished = False

    def progress(self, text: str) -> None:
        """Replaces the progress line; nothing but on a terminal."""
        if self.is_terminal:
            self._write(text[: shutil.get_terminal_size().columns - 1])
            self._unfinished = True

    def close(self) -> None:
        """Takes the progress line away."""
        if self._unfinished:
            self._write("")
            self._unfinished = False

    def _write(self, text: str) -> None:
        self._stream.write(("\r\033[K" if self._unfinished else "") + text)
        self._stream.flush()
