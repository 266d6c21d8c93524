"""From a text to the trees of its statements, with every syntax error of it in words."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any, FrozenSet, Iterable, List, Tuple

from lark import Lark, Token, Tree, UnexpectedToken

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.messages import STATEMENTS, explain, unfinished, unknown_statement

_DEEPEST = 40
"""Brackets within brackets in a rule; beyond it is no scenario, and Python's own stack has an end."""


def span_of(token: Token, file: str) -> Span:
    """Where a token stands."""
    line, column = token.line or 1, token.column or 1
    return Span(file, line, column, token.end_line or line, token.end_column or column + len(token))


@lru_cache(maxsize=None)
def _grammar() -> Lark:
    """The parser; made once, at the first text, so that to import the package costs nothing."""
    text = (Path(__file__).parent / "grammar.lark").read_text(encoding="utf-8")
    return Lark(text, parser="lalr", lexer="basic", start=["statement", "wrong"], propagate_positions=True)


def read_statements(text: str, file: str) -> Tuple[List[Tree], List[Diagnostic]]:  # type: ignore[type-arg]
    """The trees of all statements that are well formed, and an error for each that is not, in file order."""
    trees: List[Tree] = []  # type: ignore[type-arg]
    findings: List[Diagnostic] = []
    after_objective = False
    for chunk in _chunks(_significant(_grammar().lex(text))):
        first = chunk[0]
        if first.type not in STATEMENTS:
            findings.append(unknown_statement(first, span_of(first, file)))
        elif first.type == "TAIL" and not after_objective:
            message = "a query of the original's tools (control: …) stands only behind an objective"
            findings.append(error("PML017", message, span_of(first, file), "delete it"))
        else:
            finding = _parse(chunk, file, trees)
            findings += finding
        after_objective = first.type in ("OBJECTIVE", "REACH_OBJECTIVE")
    return trees, findings


def _significant(tokens: Iterable[Token]) -> List[Token]:
    """The tokens without those pose comments that stand anywhere but behind a point of interest, on its line."""
    kept: List[Token] = []
    for token in tokens:
        if token.type == "POSE":
            behind_poi = len(kept) > 1 and kept[-2].type == "POI" and kept[-1].type == "NAME"
            if not behind_poi or kept[-1].line != token.line:
                continue
        kept.append(token)
    return kept


def _chunks(tokens: List[Token]) -> List[List[Token]]:
    """The tokens cut into statements: at each word that begins one, and where a line begins like an unknown one."""
    chunks: List[List[Token]] = []
    for index, token in enumerate(tokens):
        opens_line = index == 0 or tokens[index - 1].line != token.line
        following = tokens[index + 1].type if index + 1 < len(tokens) else ""
        goes_on = following in ("NAME", "UNCLOSED_NAME", "COLON")
        if token.type in STATEMENTS:  # inside a line such a word may also stand where a name should
            begins = opens_line or goes_on or token.type in ("CONNECT", "TAIL")
        else:
            begins = opens_line and goes_on and token.type == "WORD"
        if begins or not chunks:
            chunks.append([])
        chunks[-1].append(token)
    return chunks


def _parse(chunk: List[Token], file: str, trees: List[Tree]) -> List[Diagnostic]:  # type: ignore[type-arg]
    """Parses one statement onto `trees`; the error in it, if there is one."""
    parser: Any = _grammar().parse_interactive(start="statement")
    depth = 0
    for index, token in enumerate(chunk):
        depth += {"LPAR": 1, "RPAR": -1}.get(token.type, 0)
        if depth > _DEEPEST:
            message = f"more than {_DEEPEST} brackets within brackets"
            return [error("PML016", message, span_of(token, file), "split the rule into several rules")]
        try:
            parser.feed_token(token)
        except UnexpectedToken:
            return [explain(chunk, index, _expected(parser), span_of(token, file))]
    expected = _expected(parser)
    if "$END" not in expected:
        return [unfinished(chunk, expected, span_of(chunk[-1], file))]
    trees.append(parser.feed_eof(chunk[-1]))
    return []


def _expected(parser: Any) -> FrozenSet[str]:
    return frozenset(parser.accepts())
