"""Words of a text: where they stand, and how messages show them."""

from __future__ import annotations

from typing import Optional

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
