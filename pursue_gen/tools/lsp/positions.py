"""Offsets in a text, and the positions that editors count instead: lines from 0, columns in units of an encoding."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Tuple

from pursue_gen.language.lines import Lines

UTF_16 = "utf-16"
"""What editors count columns in unless they agree on something else."""


@dataclass(frozen=True)
class Positions(Lines):
    """Translates between offsets in a text (its line ends are newlines) and positions.

    Columns are counted in units of `encoding`: "utf-16", "utf-8" or "utf-32".
    """

    encoding: str = UTF_16

    def offset(self, line: int, column: int) -> int:
        """The offset of a position; a column between the units of one character means the character's start."""
        if line < 0:
            return 0
        if line >= len(self.starts):
            return len(self.text)
        start, end = self.start(line), self.end(line)
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
        line = self.of(offset)
        before = self.text[self.starts[line] : offset]
        return line, len(before) if before.isascii() else sum(map(self._width, before))

    def _width(self, character: str) -> int:
        code = ord(character)
        if self.encoding == UTF_16:
            return 2 if code > 0xFFFF else 1
        if self.encoding == "utf-8":
            return 1 + (code > 0x7F) + (code > 0x7FF) + (code > 0xFFFF)
        return 1
