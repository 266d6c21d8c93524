"""Quick fixes for statements that cannot be read."""

from __future__ import annotations

import re
from typing import Iterator, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.edits import Edit
from pursue_gen.language.messages import KEYWORDS, QUOTES, RESERVED, name_meant
from pursue_gen.language.usable import proposal
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.edits import written
from pursue_gen.tools.lsp.tokens import DECLARED, Statement, accepts, end_of

Proposal = Tuple[str, Tuple[Edit, ...]]
_MEANT = re.compile(r"did you mean (\w+)\?|\Awrite (\w+)[:;] ")
"""How hints say what was meant."""
_QUOTES = re.compile(f"[{QUOTES}]+")
_FIRST_WORD = re.compile(r'"\s*[\w-]*')
_SIGNS = {"COLON": ":", "COMMA": ",", "RPAR": ")"}


def did_you_mean(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Writes the word that the finding's hint names in place of what stands there."""
    meant = _MEANT.search(finding.hint)
    if meant is not None and finding.span is not None:
        word = meant.group(1) or meant.group(2)
        yield f"Write {word}", (Edit(*document.positions.of_span(finding.span), word),)


def unexpected(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Something else was expected here: quotes, signs, misspelt words."""
    yield from did_you_mean(document, finding, part, at)
    if part is None:
        return
    wrong = next((index for index, token in enumerate(part.tokens) if token.start_pos == at), None)
    if wrong is None:
        yield from _unfinished(part)
        return
    token = part.tokens[wrong]
    expected = accepts(part.tokens[:wrong])
    if "NAME" in expected and token.type == "WORD":
        name, last = name_meant(list(part.tokens), wrong)
        what = "label" if part.tokens[wrong - 1].type == "LABEL" else "name"
        yield f'Put the {what} in quotes: "{name}"', (Edit(at, end_of(last), f'"{name}"'),)
    elif "NAME" in expected and token.type == "STRAY":
        yield from _straight_quotes(document, at)
    elif "WORD" in expected and token.type == "NAME":
        bare = proposal(str(token)[1:-1], RESERVED)
        yield f"Write {bare} without quotes", (Edit(at, end_of(token), bare),)
    elif "COLON" in expected:
        yield "Add the missing :", (_behind(part.tokens[wrong - 1], ":"),)
    elif "COMMA" in expected and token.type in ("WORD", "TRUE_IF", "FALSE_IF"):
        yield "Add the missing comma", (_behind(part.tokens[wrong - 1], ","),)
    elif token.type == "RPAR":
        yield "Delete this )", (Edit(at, end_of(token), ""),)
    elif part.kind == "OBJECTIVE" and token.type == "DO":
        first = next(one for one in part.tokens if one.type == "OBJECTIVE")
        edit = written(first, KEYWORDS["REACH_OBJECTIVE"])
        yield "Write reach_objective: do …", (edit,)
    elif part.kind == "RULE" and token.type in ("BEFORE", "OR"):
        yield from _brackets(part, wrong)


def _unfinished(part: Statement) -> Iterator[Proposal]:
    expected = accepts(part.tokens)
    for kind, sign in _SIGNS.items():
        if expected == {kind} and "$END" in accepts((*part.tokens, Token(kind, sign))):
            yield f"Add the missing {sign}", (_behind(part.tokens[-1], sign),)
    for index, token in enumerate(part.tokens):
        if token.type == "LPAR" and "$END" in accepts(part.tokens[:index] + part.tokens[index + 1 :]):
            yield "Delete this (", (written(token, ""),)
            return


def _behind(token: Token, text: str) -> Edit:
    return Edit(end_of(token), end_of(token), text)


def _straight_quotes(document: Document, at: int) -> Iterator[Proposal]:
    """Two typographic quotes around a word become straight ones."""
    line_end = document.positions.line_end(document.positions.line_of(at))
    opening = _QUOTES.match(document.text, at)
    closing = _QUOTES.search(document.text, opening.end(), line_end) if opening else None
    if opening and closing:
        straight = tuple(Edit(match.start(), match.end(), '"') for match in (opening, closing))
        yield "Use straight quotes", straight


def _brackets(part: Statement, wrong: int) -> Iterator[Proposal]:
    """`a before b before c` becomes `(a before b) before c`, where there are no other brackets."""
    body = part.tokens[3:wrong]
    if len(part.tokens) > 3 and not any(token.type in ("LPAR", "RPAR") for token in body) and len(body) == 3:
        start = body[0].start_pos or 0
        yield "Put brackets around the first two", (Edit(start, start, "("), _behind(body[-1], ")"))


def close_name(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Closes a quoted name behind its first word."""
    word = _FIRST_WORD.match(document.text, at)
    declares = part is not None and part.kind in DECLARED
    if word is not None and len(word.group()) > 1 and declares:
        yield "Add the closing quote", (Edit(word.end(), word.end(), '"'),)


def close_comment(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Closes a comment at the end of its first line."""
    end = document.positions.line_end(document.positions.line_of(at))
    yield "Close the comment at the end of this line", (Edit(end, end, " */"),)


def visible_blank(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Puts an ordinary blank in the place of signs that cannot be seen."""
    if finding.span is not None:
        yield "Put an ordinary blank here", (Edit(*document.positions.of_span(finding.span), " "),)


def delete_finding(document: Document, finding: Diagnostic, part: Optional[Statement], at: int) -> Iterator[Proposal]:
    """Deletes what the finding is about."""
    if finding.span is not None:
        yield "Delete it", (Edit(*document.positions.of_span(finding.span), ""),)
