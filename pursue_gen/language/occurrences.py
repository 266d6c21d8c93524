"""What each name in a text is used for, whether or not its statement is right."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.language.condition_names import condition_start, names_in_condition
from pursue_gen.language.messages import KEYWORDS, MAY_BE_NAMES, kind_of
from pursue_gen.language.poses import robots_in
from pursue_gen.language.syntax import DECLARED, Statement, bare, start_of

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


def occurrences(parts: Sequence[Statement]) -> Tuple[Occurrence, ...]:
    """Every name in the statements that stands where one may stand, in the order of the text."""
    return tuple(found for number, part in enumerate(parts) for found in _occurrences(part, number))


def _occurrences(part: Statement, number: int) -> List[Occurrence]:
    found = []
    kind: Optional[str] = None
    named = are_names(part.tokens)
    condition = condition_start(part.tokens)
    for index, token in enumerate(part.tokens[:condition]):
        start = start_of(token)
        if index == 1 and token.type == "NAME" and part.kind in DECLARED:
            name = bare(token)
            found.append(Occurrence(name, DECLARED[part.kind], start + 1, start + 1 + len(name), True, number))
        elif token.type in KEYWORDS and not named[index]:
            kind = _USED.get((part.kind, token.type))
        elif kind is not None and named[index] and (index > 1 or part.kind not in DECLARED):
            found.append(Occurrence(str(token), kind, start, start + len(token), False, number))
        elif kind is not None and token.type == "NAME" and part.kind in _QUOTED:
            name = bare(token)
            found.append(Occurrence(name, kind, start + 1, start + 1 + len(name), False, number))
        elif token.type == "POSE":
            places = [(name, start + offset) for name, offset, _ in robots_in(str(token))]
            found += [Occurrence(name, "agent", at, at + len(name), False, number) for name, at in places]
    if condition is not None:
        for index, kind in names_in_condition(part.tokens, condition)[0].items():
            token = part.tokens[index]
            start = start_of(token)
            found.append(Occurrence(str(token), kind, start, start + len(token), False, number))
    return found
