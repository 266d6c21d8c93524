"""The parts of a statement that is for each of a group, as far as it is written: its variables, groups and body."""

from __future__ import annotations

import re
from typing import FrozenSet, Iterable, Iterator, List, NamedTuple, Sequence, Tuple

from lark import Token

from pursue_gen.language.kinds import MAY_BE_NAMES

NAMES = frozenset(("WORD", *MAY_BE_NAMES))
"""The tokens that may be names in use."""

_RANGE = "WORD IN NAME|ROBOT WORD"
_RANGES = re.compile(rf"TWO (ROBOTS WORD COMMA WORD|WORD COMMA WORD IN NAME)|({_RANGE})( COMMA ({_RANGE}))*")


class Range(NamedTuple):
    """Variables, and the group that each of them stands for a member of; `robots`: the group is the word in `each
    robot r` or `each two robots a, b`, for all robots."""

    variables: Tuple[Token, ...]
    group: Token
    robots: bool = False


def with_groups(statements: Iterable[Sequence[Token]]) -> bool:
    """True where some of the statements may have to be written out."""
    return any(token.type in ("GROUP", "FOR", "EXCEPT", "OF") for tokens in statements for token in tokens)


def body_of(tokens: Sequence[Token]) -> Sequence[Token]:
    """The tokens of a statement without `for each … :`; none where there is nothing behind the colon."""
    if not tokens or tokens[0].type != "FOR":
        return tokens
    return tokens[next((n for n, token in enumerate(tokens) if token.type == "COLON"), len(tokens)) + 1 :]


def head_of(tokens: Sequence[Token]) -> Sequence[Token]:
    """The tokens of `for each … :`, as far as it is there."""
    return tokens[: len(tokens) - len(body_of(tokens))]


def ranges_of(tokens: Sequence[Token]) -> List[Range]:
    """The parts of `r in rooms, b in carts` between `for each` and the colon; [] where they are not well formed."""
    head = head_of(tokens)[:-1]
    if [token.type for token in head[:2]] != ["FOR", "EACH"]:
        return []
    two, head = [token.type for token in head[2:3]] == ["TWO"], head[2:]
    behind_in = [False, *(token.type == "IN" for token in head)]
    kinds = ["NAME" if of and token.type in NAMES else token.type for of, token in zip(behind_in, head)]
    if not _RANGES.fullmatch(" ".join(kinds)):
        return []
    if two:
        robots = kinds[1] == "ROBOTS"
        return [Range((head[2], head[4]), head[1], True) if robots else Range((head[1], head[3]), head[5])]
    found = []
    for number, (token, behind) in enumerate(zip(head, [*head[1:], *head[:1]])):
        if kinds[number] == "ROBOT":
            found.append(Range((behind,), token, True))
        elif behind.type == "IN":
            found.append(Range((token,), head[number + 2]))
    return found


def variables_of(tokens: Sequence[Token]) -> FrozenSet[str]:
    """The variables of a statement that is for each of a group, also where its head is not well formed."""
    head = head_of(tokens)
    pairs = zip(head, head[1:])
    return frozenset(str(token) for before, token in pairs if token.type == "WORD" and before.type != "IN")


def behind_of(tokens: Sequence[Token]) -> bool:
    """True where the last word is the `of` behind a name or a quantifier, which a name has to follow."""
    kinds = [token.type for token in tokens[1:][-2:]]  # the first word begins the statement: of is an agent behind it
    return kinds[1:] == ["OF"] and kinds[0] in ("NAME", *NAMES)


def around_of(tokens: Sequence[Token]) -> Iterator[Token]:
    """The words before and behind each `of` that makes a name, or stands behind a quantifier."""
    for before, token, behind in zip(tokens, tokens[1:], tokens[2:]):
        if token.type == "OF" and before.type != "NUMBER":
            yield from (before, behind)


def without_owners(tokens: Sequence[Token]) -> List[Token]:
    """The tokens without `of r` behind names."""
    pairs = zip(tokens[1:], tokens[2:])
    of = [False, False, *(token.type == "OF" and before.type in ("NAME", *NAMES) for before, token in pairs)]
    return [token for token, is_of, behind in zip(tokens, of, [False, *of]) if not is_of and not behind]
