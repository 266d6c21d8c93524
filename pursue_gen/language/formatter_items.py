"""A PuRSUE-ML text as what a formatter keeps: its words and its comments, and where lines were broken."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import List

from lark import Lark

LINE, BLOCK = "LINE", "BLOCK"
_COMMENT = re.compile(r"//[^\n]*|/\*(?:.|\n)*?\*/")


@dataclass(frozen=True)
class Item:
    """A word of the language or a comment, as it stands in the text but for blanks at the ends of its lines.

    `kind`: the terminal of the grammar, or LINE or BLOCK for comments (poses are comments here); `start`: offset in
    the text; `breaks`: how many line ends there are between the item before (or the text's beginning) and this one.
    """

    kind: str
    text: str
    start: int
    breaks: int

    @property
    def is_comment(self) -> bool:
        """True for comments of both kinds."""
        return self.kind in (LINE, BLOCK)


@lru_cache(maxsize=None)
def _lexer() -> Lark:
    """The terminals of the grammar, without a parser; made once, at the first text."""
    grammar = (Path(__file__).parent / "grammar.lark").read_text(encoding="utf-8")
    return Lark(grammar, parser=None, lexer="basic", start=["statement", "wrong"])


def items_of(text: str) -> List[Item]:
    """Every word and comment of a text whose line ends are newlines, in order."""
    items: List[Item] = []
    end = 0

    def add(kind: str, start: int, stop: int) -> None:
        nonlocal end
        kept = "\n".join(line.rstrip(" \t\f") for line in text[start:stop].split("\n"))
        items.append(Item(kind, kept, start, text.count("\n", end, start)))
        end = stop

    def add_comments(stop: int) -> None:
        for comment in _COMMENT.finditer(text, end, stop):  # the lexer leaves nothing else between its tokens
            add(LINE if comment.group().startswith("//") else BLOCK, *comment.span())

    for token in _lexer().lex(text):
        start = token.start_pos or 0
        add_comments(start)
        add(LINE if token.type == "POSE" else token.type, start, start + len(token))
    add_comments(len(text))
    return items
