"""Words of a text: where they stand, and how messages show them; its lines, and offsets in it."""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Span


def start_of(token: Token) -> int:
    """The offset of a token."""
    return token.start_pos or 0


def end_of(token: Token) -> int:
    """The offset behind a token."""
    return (token.start_pos or 0) + len(token)


def bare(name: Optional[Token]) -> str:
    """A name without its quotes; "" where there is none."""
    return "" if name is None else str(name)[1:-1]


def span_of(token: Token, file: str, member: str = "") -> Span:
    """Where a token stands; `member` as in `Span`."""
    line, column = token.line or 1, token.column or 1
    return Span(file, line, column, token.end_line or line, token.end_column or column + len(token), member)


def shown(text: str, most: int = 30) -> str:
    """A piece of a text as a message can hold it: signs that cannot be seen by their number, and not too long."""
    text = text if len(text) <= most else text[: most - 1] + "…"
    return "".join(c if c.isprintable() else f"U+{ord(c):04X}" for c in text)


def plain(text: str) -> str:
    """The text with newlines as its only line ends, and without the mark that some programs put in front."""
    return text.replace("\r\n", "\n").replace("\r", "\n").replace("\ufeff", " ")


@dataclass(frozen=True)
class Lines:
    """Where the lines of a text begin and end, counted from 0; only a newline ends one.

    Whatever lies outside of the text is moved to the nearest place in it.
    """

    text: str

    @cached_property
    def starts(self) -> Tuple[int, ...]:
        """The offset where each line begins; an empty text has one line."""
        return (0, *(found.end() for found in re.finditer("\n", self.text)))

    def start(self, line: int) -> int:
        """The offset where a line begins."""
        return self.starts[min(max(line, 0), len(self.starts) - 1)]

    def end(self, line: int) -> int:
        """The offset of a line's end, before its newline."""
        return self.starts[line + 1] - 1 if 0 <= line < len(self.starts) - 1 else len(self.text)

    def of(self, offset: int) -> int:
        """The line that an offset is in."""
        return bisect_right(self.starts, offset) - 1

    def start_at(self, offset: int) -> int:
        """Where the line begins that an offset is in."""
        return self.start(self.of(offset))

    def end_at(self, offset: int) -> int:
        """Where the line ends that an offset is in."""
        return self.end(self.of(offset))

    def of_span(self, span: Span) -> Tuple[int, int]:
        """(start, end) of a span, as offsets."""
        start = self.start(span.line - 1) + span.column - 1
        end = self.start(span.end_line - 1) + span.end_column - 1
        last = len(self.text)
        return min(start, last), min(max(start, end), last)
