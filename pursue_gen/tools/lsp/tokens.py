"""A text as words, comments and statements, whether or not they are right; and what each name in them is used for."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from typing import Any, Dict, FrozenSet, Iterable, List, Optional, Sequence, Tuple

from lark import Token, UnexpectedToken

from pursue_gen.language.messages import KEYWORDS, MAY_BE_NAMES, STATEMENTS, kind_of
from pursue_gen.language.poses import robots_in
from pursue_gen.language.syntax import MOST_LETTERS, MOST_WORDS, chunks, grammar, significant  # the one cutter there is
from pursue_gen.tools.lsp.condition_names import condition_start, names_in_condition

COMMENTS = frozenset({"LINE_COMMENT", "BLOCK_COMMENT", "UNCLOSED_COMMENT"})

DECLARED: Dict[str, str] = {"POI": "POI", "EVENT": "event", "RULE": "rule", "STATE": "state", "AGENT": "agent"}
"""The kind of thing that a statement declares, by the token that begins the statement."""

_USED: Dict[Tuple[str, str], str] = {
    ("CONNECT", "CONNECT"): "POI",
    ("CONNECT", "AND"): "POI",
    ("EVENT", "LOCATION"): "POI",
    ("RULE", "RULE"): "event",
    ("RULE", "ROBOT"): "event",
    ("RULE", "AGENT"): "event",
    ("RULE", "BEFORE"): "event",
    ("RULE", "OR"): "event",
    ("RULE", "AND"): "event",
    ("STATE", "TRUE_IF"): "event",
    ("STATE", "FALSE_IF"): "event",
    ("STATEDEPENDENCY", "STATEDEPENDENCY"): "event",
    ("STATEDEPENDENCY", "ONLY_IF"): "state",
    ("AGENT", "LOCATION"): "POI",
    ("AGENT", "CAN_DO"): "event",
    ("AGENT", "REACTS_TO"): "event",
    ("TRAVEL", "TRAVEL"): "agent",
    ("TRAVEL", "FROM"): "POI",
    ("TRAVEL", "TO"): "POI",
    ("BATTERY", "BATTERY"): "agent",
    ("BATTERY", "AT"): "POI",
    ("ASSUME", "ASSUME"): "agent",
    ("ASSUME", "DOES"): "event",
    ("ASSUME", "BETWEEN"): "event",
    ("ASSUME", "LEAVES"): "POI",
    ("ASSUME", "AT"): "POI",
    ("OBJECTIVE", "OBJECTIVE"): "agent",
    ("OBJECTIVE", "NEVER_WITH"): "agent",
    ("OBJECTIVE", "PATROL"): "POI",
    ("OBJECTIVE", "BY"): "agent",
    ("OBJECTIVE", "AT"): "POI",
    ("OBJECTIVE", "IF"): "event",
    ("OBJECTIVE", "THEN"): "event",
    ("OBJECTIVE", "AVOID"): "event",
    ("REACH_OBJECTIVE", "DO"): "event",
    ("REACH_OBJECTIVE", "AND"): "event",
}
"""The kind of thing that a name stands for, by the statement and the last word of the language before the name."""

_QUOTED = ("TRAVEL", "BATTERY")
"""Statements in which the agent that they are about may have quotes."""

_BEFORE_NAMES = frozenset({"COLON", "COMMA", "LPAR"})


@dataclass(frozen=True)
class Occurrence:
    """A name where it stands, without quotes: text[start:end]. `declares`: this is where it is declared."""

    name: str
    kind: str
    start: int
    end: int
    declares: bool
    statement: int


@dataclass(frozen=True)
class Statement:
    """A statement, right or wrong: its tokens (no comments but poses) and its stretch of the text."""

    tokens: Tuple[Token, ...]

    @property
    def kind(self) -> str:
        """The token that says which statement it is; anything where no statement begins like this."""
        return kind_of(self.tokens)

    @property
    def start(self) -> int:
        """Offset of its first character."""
        return self.tokens[0].start_pos or 0

    @property
    def end(self) -> int:
        """Offset behind its last character."""
        return end_of(self.tokens[-1])

    @property
    def name(self) -> Optional[Token]:
        """The quoted name that it declares, as far as there is one."""
        named = self.kind in DECLARED and len(self.tokens) > 1 and self.tokens[1].type == "NAME"
        return self.tokens[1] if named else None

    def has(self, kind: str) -> bool:
        """Does a token of this kind stand in it?"""
        return any(token.type == kind for token in self.tokens)


def end_of(token: Token) -> int:
    """The offset behind a token."""
    return (token.start_pos or 0) + len(token)


def all_tokens(text: str) -> Tuple[Token, ...]:
    """Every word, sign and comment of a text; nothing of one that is too large to be a scenario."""
    if len(text) > MOST_LETTERS:
        return ()
    # a comment or a blank stands between most words
    found = tuple(islice(grammar().lex(text, dont_ignore=True), 3 * MOST_WORDS))
    return tuple(token for token in found if token.type != "BLANK") if len(found) < 3 * MOST_WORDS else ()


def statements(tokens: Iterable[Token]) -> Tuple[Statement, ...]:
    """The statements that tokens make, comments left out."""
    kept = significant(token for token in tokens if token.type not in COMMENTS or token.type == "UNCLOSED_COMMENT")
    return tuple(Statement(tuple(chunk)) for chunk in chunks(kept))


def kinds_behind(tokens: Sequence[Token]) -> Tuple[str, ...]:
    """What a name may stand for that is used behind these tokens of one statement; (): no name is used there."""
    if not tokens:
        return ()
    start = condition_start(tokens)
    if start is not None:
        return names_in_condition(tokens, start)[1]
    named = are_names(tokens)
    keywords = [token.type for token, is_name in zip(tokens, named) if token.type in KEYWORDS and not is_name]
    kind = _USED.get((kind_of(tokens), keywords[-1])) if keywords else None
    return () if kind is None else (kind,)


def are_names(tokens: Sequence[Token]) -> List[bool]:
    """Which tokens of one statement are names in use, as far as they stand where one may stand.

    A word of the language that may be a name is one where a name has to stand.
    """
    named: List[bool] = []
    kind = kind_of(tokens)
    for index, token in enumerate(tokens):
        before = tokens[index - 1] if index else None
        behind = before is not None and not named[-1] and (
            before.type in _BEFORE_NAMES or (kind, before.type) in _USED
        )  # fmt: skip
        following = tokens[index + 1].type if index + 1 < len(tokens) else ""
        opens = before is not None and before.type == "COLON" and kind == "OBJECTIVE"
        begins = opens and token.type in ("ALWAYS", "PATROL") and following != "NEVER_WITH"
        named.append(token.type == "WORD" or (token.type in MAY_BE_NAMES and behind and not begins))
    return named


def accepts(tokens: Sequence[Token]) -> FrozenSet[str]:
    """The kinds of tokens that may follow these of one statement, "$END" among them; none after a wrong one."""
    if not tokens:
        return STATEMENTS - {"TAIL"}
    if tokens[0].type not in STATEMENTS:
        return frozenset()
    parser: Any = grammar().parse_interactive(start="statement")
    try:
        for token in tokens:
            parser.feed_token(token)
    except UnexpectedToken:
        return frozenset()
    return frozenset(parser.accepts())


def occurrences(parts: Sequence[Statement]) -> Tuple[Occurrence, ...]:
    """Every name in the statements that stands where one may stand, in the order of the text."""
    return tuple(found for number, part in enumerate(parts) for found in _occurrences(part, number))


def _occurrences(part: Statement, number: int) -> List[Occurrence]:
    found = []
    kind: Optional[str] = None
    named = are_names(part.tokens)
    condition = condition_start(part.tokens)
    for index, token in enumerate(part.tokens[:condition]):
        start = token.start_pos or 0
        if index == 1 and token.type == "NAME" and part.kind in DECLARED:
            name = str(token)[1:-1]
            found.append(Occurrence(name, DECLARED[part.kind], start + 1, start + 1 + len(name), True, number))
        elif token.type in KEYWORDS and not named[index]:
            kind = _USED.get((part.kind, token.type))
        elif kind is not None and named[index] and (index > 1 or part.kind not in DECLARED):
            found.append(Occurrence(str(token), kind, start, start + len(token), False, number))
        elif kind is not None and token.type == "NAME" and part.kind in _QUOTED:
            name = str(token)[1:-1]
            found.append(Occurrence(name, kind, start + 1, start + 1 + len(name), False, number))
        elif token.type == "POSE":
            places = [(name, start + offset) for name, offset, _ in robots_in(str(token))]
            found += [Occurrence(name, "agent", at, at + len(name), False, number) for name, at in places]
    if condition is not None:
        for index, kind in names_in_condition(part.tokens, condition)[0].items():
            token = part.tokens[index]
            start = token.start_pos or 0
            found.append(Occurrence(str(token), kind, start, start + len(token), False, number))
    return found
