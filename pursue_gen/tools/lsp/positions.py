"""Offsets in a text, and the positions that editors count instead: lines from 0, columns in units of an encoding."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Tuple

from pursue_gen.diagnostics import Span

UTF_16 = "utf-16"
"""What editors count columns in unless they agree on something else."""


def plain(text: str) -> str:
    """The text with newlines as its only line ends, and without the mark that some programs put in front."""
    return text.replace("\r\n", "\n").replace("\r", "\n").replace("\ufeff", " ")


@dataclass(frozen=True)
class Positions:
    """Translates between offsets in a text (its line ends are newlines) and positions.

    Columns are counted in units of `encoding`: "utf-16", "utf-8" or "utf-32". Whatever lies outside of the text is
    moved to the nearest place in it.
    """

    text: str
    encoding: str = UTF_16

    @cached_property
    def _starts(self) -> Tuple[int, ...]:
        starts = [0]
        at = self.text.find("\n")
        while at >= 0:
            starts.append(at + 1)
            at = self.text.find("\n", at + 1)
        return tuple(starts)

    @property
    def lines(self) -> int:
        """How many lines there are; an empty text has one."""
        return len(self._starts)

    def line_start(self, line: int) -> int:
        """The offset where a line begins."""
        return self._starts[min(max(line, 0), len(self._starts) - 1)]

    def line_end(self, line: int) -> int:
        """The offset of a line's end, before its newline."""
        return self._starts[line + 1] - 1 if 0 <= line < len(self._starts) - 1 else len(self.text)

    def line_of(self, offset: int) -> int:
        """The line that an offset is in."""
        return bisect_right(self._starts, offset) - 1

    def offset(self, line: int, column: int) -> int:
        """The offset of a position; a column between the units of one character means the character's start."""
        if line < 0:
            return 0
        if line >= len(self._starts):
            return len(self.text)
        start, end = self.line_start(line), self.line_end(line)
        if self.text[start:end].isascii():
            return min(start + max(column, 0), end)
        at, left = start, column
        while at < end:
            left -= self._width(self.text[at])
            if left < 0:
                break
            at += 1
        return at

    def position(self, offset: int) -> Tuple[int, int]:
        """(line, column) of an offset."""
        offset = min(max(offset, 0), len(self.text))
        line = self.line_of(offset)
        before = self.text[self._starts[line] : offset]
        return line, len(before) if before.isascii() else sum(map(self._width, before))

    def of_span(self, span: Span) -> Tuple[int, int]:
        """(start, end) of a diagnostic's span, as offsets."""
        start = self.line_start(span.line - 1) + span.column - 1
        end = self.line_start(span.end_line - 1) + span.end_column - 1
        last = len(self.text)
        return min(start, last), min(max(start, end), last)

    def _width(self, character: str) -> int:
        code = ord(character)
        if self.encoding == UTF_16:
            return 2 if code > 0xFFFF else 1
        if self.encoding == "utf-8":
            return 1 + (code > 0x7F) + (code > 0x7FF) + (code > 0xFFFF)
        return 1
