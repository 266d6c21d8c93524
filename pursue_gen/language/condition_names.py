"""What the names in a condition stand for, whether or not the condition is finished."""

from __future__ import annotations

from typing import Dict, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.language.messages import MAY_BE_NAMES, kind_of

SUBJECTS = ("agent", "state")
"""The kinds of things with which a part of a condition may begin."""

_OPENS = {
    ("CONNECT", "ONLY_IF"), ("EVENT", "ONLY_IF"), ("OBJECTIVE", "AVOID"), ("OBJECTIVE", "ALWAYS"), ("OBJECTIVE", "IF"),
    ("ASSUME", "NOT"),
}  # fmt: skip
"""The statements with a condition in them, and the word behind which it begins."""

_OBJECT = {"AT": "POI", "DOING": "event"}
_SUBJECT = {"AT": "agent", "ON_WAY": "agent", "DOING": "agent", "IS_TRUE": "state", "IS_FALSE": "state"}
_NAMES = frozenset(("WORD", *MAY_BE_NAMES))


def condition_start(tokens: Sequence[Token]) -> Optional[int]:
    """The number of the first token of the condition in a statement, be it there or missing; None: it has none."""
    for number, token in enumerate(tokens):
        if (kind_of(tokens), token.type) in _OPENS:
            following = tokens[number + 1].type if number + 1 < len(tokens) else ""
            return None if following == "NEVER_WITH" else number + 1  # always may be an agent's name
    return None


def names_in_condition(tokens: Sequence[Token], start: int) -> Tuple[Dict[int, str], Tuple[str, ...]]:
    """By the number of its token the kind of thing that each name from `start` on stands for; and the kinds of names
    that may follow the last token."""
    found: Dict[int, str] = {}
    # an event may stand there alone
    subjects = ("event", *SUBJECTS) if tokens[start - 1].type in ("AVOID", "IF") else SUBJECTS
    expected: Tuple[str, ...] = subjects
    number = start
    while number < len(tokens):
        kind = tokens[number].type
        following = tokens[number + 1].type if number + 1 < len(tokens) else ""
        if len(expected) > 1 and kind in ("ANY", "NO") and following in ("ROBOT", "AGENT"):
            number, expected = number + 1, ()
        elif expected and kind in _NAMES:
            found[number] = expected[0] if len(expected) == 1 else _SUBJECT.get(following, subjects[0])
            expected = ()
        elif kind in _OBJECT:
            expected = (_OBJECT[kind],)
        elif kind in ("AND", "OR", "NOT", "LPAR"):
            expected = subjects = SUBJECTS
        elif kind == "THEN":
            expected = subjects = ("event", *SUBJECTS)
        elif kind == "WITHIN":
            expected = ()
        number += 1
    return found, expected
