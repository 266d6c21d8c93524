"""Parts of statements, and edits of them, that quick fixes are made of."""

from __future__ import annotations

from typing import Optional, Tuple

from lark import Token

from pursue_gen.language.edits import Edit
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.tokens import Statement, end_of


def bare(token: Optional[Token]) -> str:
    """A name without its quotes."""
    return str(token)[1:-1] if token is not None else ""


def first(part: Optional[Statement], kind: str) -> Optional[Token]:
    """The first token of that kind."""
    return next((token for token in part.tokens if token.type == kind), None) if part is not None else None


def pair(part: Optional[Statement], word: str) -> Optional[Tuple[Token, Token]]:
    """The word and the number behind it."""
    tokens = part.tokens if part is not None else ()
    for token, number in zip(tokens, tokens[1:]):
        if token.type == word and number.type == "NUMBER":
            return token, number
    return None


def behind(token: Token, text: str) -> Edit:
    """Adds a text behind a token."""
    return Edit(end_of(token), end_of(token), text)


def written(token: Token, text: str) -> Edit:
    """Writes a text in the place of a token."""
    return Edit(token.start_pos or 0, end_of(token), text)


def cut(document: Document, begin: Token, last: Token) -> Edit:
    """Deletes from a token to another, with the blanks before."""
    start = begin.start_pos or 0
    kept = len(document.text[:start].rstrip(" \t"))
    return Edit(kept, end_of(last), "")
