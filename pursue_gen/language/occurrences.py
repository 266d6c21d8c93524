"""What each name in a text is used for, whether or not its statement is right."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import AbstractSet, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from lark import Token

from pursue_gen.language.for_each import NAMES, around_of, behind_of, body_of, head_of, variables_of, with_groups
from pursue_gen.language.kinds import DECLARED, KEYWORDS, MAY_BE_NAMES, STATEMENTS
from pursue_gen.language.messages import kind_of
from pursue_gen.language.poses import robots_in
from pursue_gen.language.syntax import Statement
from pursue_gen.language.tokens import bare, start_of

_USED: Dict[Tuple[str, str], str] = {
    (token, word.upper()): thing for token, kind in STATEMENTS.items() for word, thing in kind.used().items()
}
"""The kind of thing that a name stands for, by the statement and the last word of the language before the name."""

_BEFORE_NAMES = frozenset({"COLON", "COMMA", "LPAR"})

_LISTS_NONE = "BATTERY"
"""The statement in which no names are listed, and behind a comma comes a word."""

SUBJECTS = ("agent", "state")
"""The kinds of things with which a part of a condition may begin."""

GROUP, VARIABLE = "group", "variable"
"""The kinds of names that stand for members: of the whole text, and of one statement that is for each of a group."""

MEMBERS = ("POI", "agent", "event", "state", "thing")
"""The kinds of things that may be in a group."""

_OPENS = {(token, word.upper()) for token, kind in STATEMENTS.items() for word in kind.conditions_behind()}
"""The statements with a condition in them, and the word behind which it begins."""

_OPENING = frozenset(("ALWAYS", "AT_LEAST", "ESCORT", "PATROL", "PLACE", "WAY"))
"""Words that may be names and with which an objective may begin."""
_BEHIND_STATES = frozenset(("IS_TRUE", "IS_FALSE"))
"""Words behind which nothing stands but the name of a state."""
_OBJECT = {"AT": "POI", "FROM": "POI", "TO": "POI", "BETWEEN": "POI", "DOING": "event", "HAS": "thing"}
_SUBJECT = {
    "AT": "agent", "ON_WAY": "agent", "BETWEEN": "agent", "DOING": "agent", "HAS": "agent",
    "IS_TRUE": "state", "IS_FALSE": "state",
}  # fmt: skip


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
    if behind_of(tokens):
        return (VARIABLE,) if tokens[-2].type == "NAME" else (VARIABLE, GROUP)
    head, tokens = tokens, body_of(tokens)
    if not tokens:
        return (GROUP,) if head and head[-1].type == "IN" else ()
    start = condition_start(tokens)
    if start is not None:
        return names_in_condition(tokens, start)[1]
    named = are_names(tokens)
    keywords = [token.type for token, is_name in zip(tokens, named) if token.type in KEYWORDS and not is_name]
    if keywords == ["GROUP"]:
        return MEMBERS
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
            (before.type in _BEFORE_NAMES and kind != _LISTS_NONE) or (kind, before.type) in _USED
        )  # fmt: skip
        following = tokens[index + 1].type if index + 1 < len(tokens) else ""
        opens = before is not None and before.type == "COLON"
        begins = opens and kind == "OBJECTIVE" and token.type in _OPENING and following != "NEVER_WITH"
        begins = begins or (token.type, following) == ("AT_MOST", "NUMBER")
        begins = begins or (kind, token.type, index) == ("STATE", "SHOWN_BY", 6)  # behind the comma
        whoever = token.type == "ANY" and following in ("ROBOT", "AGENT")
        whoever = whoever or (token.type, following) == ("EACH", "PLACE")
        stands = (behind and not begins and not whoever) or following in _BEHIND_STATES
        named.append(token.type == "WORD" or (token.type in MAY_BE_NAMES and stands))
    return named


def occurrences(parts: Sequence[Statement]) -> Tuple[Occurrence, ...]:
    """Every name in the statements that stands where one may stand, in the order of the text; not those that are made
    of others (`call of r`).
    """
    found = tuple(one for number, part in enumerate(parts) for one in _occurrences(part.body, number))
    if not with_groups(part.tokens for part in parts):
        return found
    kinds = {one.name: one.kind for one in reversed(found) if one.declares}
    made = {start_of(token) + (token.type == "NAME") for part in parts for token in around_of(part.tokens)}
    standing = list(_of_groups(parts))
    standing += _behind_of(parts, kinds, {one.start for one in standing})
    taken = made | {one.start for one in standing}
    standing += [
        replace(one, kind=kinds.get(one.name, one.kind)) if parts[one.statement].kind == "GROUP" else one
        for one in found
        if one.start not in taken
    ]
    return tuple(sorted(standing, key=lambda one: one.start))


def _behind_of(parts: Sequence[Statement], kinds: Mapping[str, str], taken: AbstractSet[int]) -> Iterator[Occurrence]:
    """The members of groups that stand behind `of`, where no group and no variable does."""
    for number, part in enumerate(parts):
        for before, token in zip(part.tokens, part.tokens[1:]):
            name, start = str(token), start_of(token)
            if before.type == "OF" and name in kinds and start not in taken:
                yield Occurrence(name, kinds[name], start, start + len(name), False, number)


def _of_groups(parts: Sequence[Statement]) -> Iterator[Occurrence]:
    """The names of groups, and of variables in the statements that are for each of a group."""
    groups = {bare(part.tokens[1]) for part in parts if part.kind == "GROUP" and len(part.tokens) > 1}
    for number, part in enumerate(parts):
        variables, head = variables_of(part.tokens), len(head_of(part.tokens))
        for index, (before, token) in enumerate(zip(part.tokens, part.tokens[1:]), 1):
            declares = part.kind == "GROUP" and index == 1 and token.type == "NAME"
            name, start = bare(token) if declares else str(token), start_of(token) + declares
            listed = token.type == "WORD" or (token.type in NAMES and before.type in ("IN", "OF", "COMMA"))
            if declares or (listed and name in groups and name not in variables):
                yield Occurrence(name, GROUP, start, start + len(name), declares, number)
            elif token.type == "WORD" and name in variables and before.type != "IN":
                yield Occurrence(name, VARIABLE, start, start + len(name), index < head, number)


def _occurrences(part: Statement, number: int) -> Iterator[Occurrence]:
    def of(token: Token, kind: str, declares: bool = False) -> Occurrence:
        quote = token.type == "NAME"
        name, start = bare(token) if quote else str(token), start_of(token) + quote
        return Occurrence(name, kind, start, start + len(name), declares, number)

    kind: Optional[str] = None
    named = are_names(part.tokens)
    condition = condition_start(part.tokens)
    for index, token in enumerate(part.tokens[:condition]):
        used = named[index] and (index > 1 or part.kind not in DECLARED)
        if index == 1 and token.type == "NAME" and part.kind in DECLARED:
            yield of(token, DECLARED[part.kind], declares=True)
        elif token.type in KEYWORDS and not named[index]:
            kind = _USED.get((part.kind, token.type))
        elif kind is not None and (used or (token.type == "NAME" and STATEMENTS[part.kind].second)):
            yield of(token, kind)
        elif token.type == "POSE":
            for name, offset, _ in robots_in(str(token)):
                start = start_of(token) + offset
                kind = "POI" if part.kind == "LIFT" else "agent"
                yield Occurrence(name, kind, start, start + len(name), False, number)
    if condition is not None:
        for index, kind in names_in_condition(part.tokens, condition)[0].items():
            yield of(part.tokens[index], kind)


def condition_start(tokens: Sequence[Token]) -> Optional[int]:
    """The number of the first token of the condition in a statement, be it there or missing; None: it has none."""
    for number, token in enumerate(tokens):
        may_open = token.type not in MAY_BE_NAMES or (number > 0 and tokens[number - 1].type == "COLON")
        if may_open and (kind_of(tokens), token.type) in _OPENS:
            following = tokens[number + 1].type if number + 1 < len(tokens) else ""
            is_name = tokens[number - 1].type != "COLON" or following == "NEVER_WITH"
            if token.type != "ALWAYS" or not is_name:  # always may be the name of an agent, or of a place
                return number + 1
    return None


def names_in_condition(tokens: Sequence[Token], start: int) -> Tuple[Dict[int, str], Tuple[str, ...]]:
    """By the number of its token the kind of thing that each name from `start` on stands for; and the kinds of names
    that may follow the last token."""
    found: Dict[int, str] = {}
    # an event may stand there alone
    subjects = ("event", *SUBJECTS) if tokens[start - 1].type in ("AVOID", "IF") else SUBJECTS
    expected: Tuple[str, ...] = subjects
    more: Tuple[str, ...] = ()  # with which a list goes on
    number, between = start, False
    while number < len(tokens):
        kind = tokens[number].type
        following = tokens[number + 1].type if number + 1 < len(tokens) else ""
        if len(expected) > 1 and kind in ("ANY", "NO") and following in ("ROBOT", "AGENT"):
            number, expected = number + 1, ()
        elif len(expected) > 1 and kind == "AT_MOST" and following == "NUMBER":
            number, expected, more = number + 1, (), SUBJECTS
        elif expected and kind in NAMES:
            found[number] = expected[0] if len(expected) == 1 else _subject(tokens[number + 1 :], subjects[0])
            expected = ()
        elif kind == "COMMA" or (kind == "OF" and more == SUBJECTS):
            expected = more
        elif kind in _OBJECT:
            expected, between = (_OBJECT[kind],), kind == "BETWEEN"
            more = expected if kind == "AT" else ()
        elif kind == "AND" and between:
            expected, between = ("POI",), False
        elif kind in ("AND", "OR", "NOT", "LPAR"):
            expected = subjects = SUBJECTS
        elif kind == "THEN":
            expected = subjects = ("event", *SUBJECTS)
        elif kind == "WITHIN":
            expected = ()
        number += 1
    return found, expected


def _subject(following: Sequence[Token], default: str) -> str:
    """The kind of thing of which a part of a condition speaks, from what follows its name; a list goes on before."""
    while following and following[0].type == "COMMA":
        following = following[2:]
    return _SUBJECT.get(following[0].type, default) if following else default
