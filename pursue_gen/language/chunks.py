"""The words of a text cut into statements: without comments, at each word that begins one."""

from __future__ import annotations

from typing import Iterable, List, Sequence

from lark import Token

from pursue_gen.language.for_each import NAMES, body_of
from pursue_gen.language.kinds import MAY_BE_NAMES, STATEMENTS, TAIL
from pursue_gen.language.messages import looks_like_statement

COMMENTS = frozenset(("LINE_COMMENT", "BLOCK_COMMENT", "UNCLOSED_COMMENT"))
"""The tokens that are comments; a POSE is one, too, where it does not stand behind what may have one."""

BLANKS = COMMENTS - {"UNCLOSED_COMMENT"}
"""The comments that stand between words as blanks do."""
_SECOND = {token: [word.upper() for word in kind.second] for token, kind in STATEMENTS.items() if kind.second}
"""Statements whose first word may be a name, and the words behind the agent that they are about."""
_OPENS = frozenset(("CONTROLLABLE", "MOBILE", *MAY_BE_NAMES)) - {"LABEL"}
_ENDS = frozenset(
    (
        "WORD NUMBER NAME POSE RPAR IS_TRUE IS_FALSE TRUE FALSE "
        "COLLABORATIVE TOGETHER ONE_WAY TIMES TWICE APART CONTROLLABLE HUMAN ON_WAY ROBOT ROBOTS AGENTS "
        "SECOND MINUTE HOUR ANSWERED OPEN"
    ).split()
)
"""Tokens behind which no name can stand: one that opens the next line begins something else."""
_NAMED = ("NAME", "UNCLOSED_NAME", "COLON")
_FOLLOWED_BY = {
    "UNIT": ("SECOND", "MINUTE", "HOUR", "NUMBER"), "REST": ("NUMBER",), "MISSION": ("ENDS",),
    **dict.fromkeys(("GROUP", "THING", "DOOR", "LIFT"), _NAMED),
}  # fmt: skip
"""Words that begin a statement and may be names, and what follows them where they are none."""
_PLACED = ("POI", "DOOR", "LIFT")
"""The tokens that begin what may have a pose."""
_OF_POIS = NAMES | set("NAME LABEL FOR EXCEPT COMMA OPENS WITHIN NUMBER AT COMES TAKES TO".split())
"""What a point of interest, a door or a lift consists of, before its pose."""


def significant(tokens: Iterable[Token]) -> List[Token]:
    """The tokens without comments: a pose is none behind what may have one, on its line."""
    kept: List[Token] = []
    of_poi = False
    for token in tokens:
        if token.type in BLANKS:
            continue
        if token.type == "POSE" and not (of_poi and kept[-1].type not in _PLACED and kept[-1].line == token.line):
            continue
        of_poi = token.type in _PLACED or (of_poi and token.type in _OF_POIS)
        kept.append(token)
    return kept


def _opened(found: List[List[Token]]) -> bool:
    """True where the last statement is `optional 1` so far."""
    last = body_of(found[-1]) if found else ()
    return 1 <= len(last) <= 2 and last[0].type == "OPTIONAL"


def _awaits(chunk: Sequence[Token], token: Token, following: Sequence[Token]) -> bool:
    """True where this token goes on with a statement, whatever it begins elsewhere: behind `for each r in rooms:`, as
    `for each robot` behind the name of a rule, and as `for agv, cart` behind a place or a way."""
    if chunk[0].type == "FOR" and chunk[-1].type == "COLON":
        return not body_of(chunk)
    kinds = [one.type for one in body_of(chunk)] if token.type == "FOR" else []
    if kinds[:1] in (["POI"], ["CONNECT"]):
        return not {"EACH", "IN"} & {one.type for one in following}
    return kinds[:1] == ["RULE"] and "COLON" not in kinds


def chunks_of(tokens: List[Token]) -> List[List[Token]]:
    """The tokens cut into statements: at each word that begins one, and where a line begins like an unknown one."""
    found: List[List[Token]] = []
    for index, token in enumerate(tokens):
        opens_line = index == 0 or tokens[index - 1].line != token.line
        following = tokens[index + 1].type if index + 1 < len(tokens) else ""
        goes_on = following in _NAMED
        ended = index == 0 or tokens[index - 1].type in _ENDS
        if found and _awaits(found[-1], token, tokens[index + 1 : index + 3]):
            begins = False
        elif token.type in _SECOND:  # an event may be called so
            second = index + 2 < len(tokens) and tokens[index + 2].type in _SECOND[token.type]
            begins = goes_on or second or (opens_line and (ended or following == "WORD"))
        elif [one.type for one in tokens[max(0, index - 2) : index]] == ["FOR", "EACH"]:
            begins = False  # a rule is for each robot, or agent
        elif token.type == "OPTIONAL":  # a name may be called so; none is before a number
            begins = following == "NUMBER" or (opens_line and (ended or following in ("OBJECTIVE", "REACH_OBJECTIVE")))
        elif token.type in _FOLLOWED_BY:
            begins = following in _FOLLOWED_BY[token.type] or (opens_line and ended)
        elif token.type in ("OBJECTIVE", "REACH_OBJECTIVE") and _opened(found):
            begins = False
        elif token.type in (*STATEMENTS, TAIL):  # inside a line such a word may also stand where a name should
            begins = opens_line or goes_on or token.type in ("CONNECT", "FOR", TAIL)
        elif token.type in ("WORD", "ROBOT", "PLACE", "WAY") and opens_line and index:
            begins = goes_on or (ended and looks_like_statement(token))
        else:
            begins = opens_line and goes_on and token.type in _OPENS
        if begins or not found:
            found.append([])
        found[-1].append(token)
    return found
