"""Quick fixes for statements that cannot be read."""

from __future__ import annotations

import re
from typing import Iterator, Tuple

from lark import Token

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.document import Edit, behind, written
from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import DECLARED, KEYWORDS, MAY_BE_NAMES
from pursue_gen.language.messages import QUOTES, name_meant
from pursue_gen.language.names import proposal
from pursue_gen.language.syntax import Statement, accepts
from pursue_gen.language.tokens import bare, end_of, start_of

Proposals = Iterator[Tuple[str, Tuple[Edit, ...]]]
"""What each would do, for the person, and the edits that do it; the likeliest comes first."""

_MEANT = re.compile(r"did you mean (\w+)\?|\Awrite (\w+)[:;] ")
"""How hints say what was meant."""
_QUOTES = re.compile(f"[{QUOTES}]+")
_FIRST_WORD = re.compile(r'"\s*[\w-]*')
_SIGNS = {"COLON": ":", "COMMA": ",", "RPAR": ")"}


def did_you_mean(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Writes the word that the finding's hint names in place of what stands there."""
    meant = _MEANT.search(finding.hint)
    if meant is not None and finding.span is not None:
        word = meant.group(1) or meant.group(2)
        yield f"Write {word}", (Edit(*document.lines.of_span(finding.span), word),)


def unexpected(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Something else was expected here: quotes, signs, misspelt words."""
    yield from did_you_mean(document, finding, part, at)
    if not part.tokens:
        return
    wrong = next((index for index, token in enumerate(part.tokens) if token.start_pos == at), None)
    if wrong is None:
        yield from _unfinished(part)
        return
    token = part.tokens[wrong]
    expected = accepts(part.tokens[:wrong])
    if "NAME" in expected and (token.type == "WORD" or token.type in MAY_BE_NAMES):
        name, last = name_meant(list(part.tokens), wrong)
        what = "label" if part.tokens[wrong - 1].type == "LABEL" else "name"
        yield f'Put the {what} in quotes: "{name}"', (Edit(at, end_of(last), f'"{name}"'),)
    elif "NAME" in expected and token.type == "STRAY":
        yield from _straight_quotes(document, at)
    elif "WORD" in expected and token.type == "NAME":
        word = proposal(bare(token))
        yield f"Write {word} without quotes", (Edit(at, end_of(token), word),)
    elif "COLON" in expected:
        yield "Add the missing :", (behind(part.tokens[wrong - 1], ":"),)
    elif "COMMA" in expected and token.type in ("WORD", "TRUE_IF", "FALSE_IF"):
        yield "Add the missing comma", (behind(part.tokens[wrong - 1], ","),)
    elif token.type == "RPAR":
        yield "Delete this )", (Edit(at, end_of(token), ""),)
    elif part.kind == "OBJECTIVE" and token.type == "DO":
        first = next(one for one in part.tokens if one.type == "OBJECTIVE")
        yield "Write reach_objective: do …", (written(first, KEYWORDS["REACH_OBJECTIVE"]),)
    elif part.kind == "RULE" and token.type in ("BEFORE", "OR"):
        yield from _brackets(part, wrong)


def _unfinished(part: Statement) -> Proposals:
    expected = accepts(part.tokens)
    for kind, sign in _SIGNS.items():
        if expected == {kind} and "$END" in accepts((*part.tokens, Token(kind, sign))):
            yield f"Add the missing {sign}", (behind(part.tokens[-1], sign),)
    for index, token in enumerate(part.tokens):
        if token.type == "LPAR" and "$END" in accepts(part.tokens[:index] + part.tokens[index + 1 :]):
            yield "Delete this (", (written(token, ""),)
            return


def _straight_quotes(document: Draft, at: int) -> Proposals:
    """Two typographic quotes around a word become straight ones."""
    line_end = document.lines.end_at(at)
    opening = _QUOTES.match(document.text, at)
    closing = _QUOTES.search(document.text, opening.end(), line_end) if opening else None
    if opening and closing:
        straight = tuple(Edit(match.start(), match.end(), '"') for match in (opening, closing))
        yield "Use straight quotes", straight


def _brackets(part: Statement, wrong: int) -> Proposals:
    """`a or b before c` becomes `(a or b) before c`, where there are no other brackets."""
    body = part.tokens[3:wrong]
    if len(part.tokens) > 3 and not any(token.type in ("LPAR", "RPAR") for token in body) and len(body) == 3:
        start = start_of(body[0])
        yield "Put brackets around the first two", (Edit(start, start, "("), behind(body[-1], ")"))


def close_name(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Closes a quoted name behind its first word."""
    word = _FIRST_WORD.match(document.text, at)
    if word is not None and len(word.group()) > 1 and part.kind in DECLARED:
        yield "Add the closing quote", (Edit(word.end(), word.end(), '"'),)


def close_comment(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Closes a comment at the end of its first line."""
    end = document.lines.end_at(at)
    yield "Close the comment at the end of this line", (Edit(end, end, " */"),)


def visible_blank(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Puts an ordinary blank in the place of signs that cannot be seen."""
    if finding.span is not None:
        yield "Put an ordinary blank here", (Edit(*document.lines.of_span(finding.span), " "),)


def delete_finding(document: Draft, finding: Diagnostic, part: Statement, at: int) -> Proposals:
    """Deletes what the finding is about."""
    if finding.span is not None:
        yield "Delete it", (Edit(*document.lines.of_span(finding.span), ""),)
