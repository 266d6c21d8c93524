"""The kinds of statements, in the order in which a text has them: to add one is to add its line here."""

from __future__ import annotations

from typing import Dict, FrozenSet, Mapping, Type

from pursue_gen.language.conditions import WORDS
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.statements.connect import Connection
from pursue_gen.language.statements.door import Door
from pursue_gen.language.statements.event import Event
from pursue_gen.language.statements.group import ForEach, Group
from pursue_gen.language.statements.headed import Assume, Batteries, Objective, Optional, ReachObjective
from pursue_gen.language.statements.lift import Lift
from pursue_gen.language.statements.mission import MissionEnd
from pursue_gen.language.statements.poi import Poi
from pursue_gen.language.statements.rest import Rest
from pursue_gen.language.statements.rule import Rule
from pursue_gen.language.statements.state import Dependency, State
from pursue_gen.language.statements.thing import Thing
from pursue_gen.language.statements.travel import Travel
from pursue_gen.language.statements.unit import Unit

STATEMENTS: Mapping[str, Type[StatementKind]] = {
    kind.token(): kind
    for kind in (
        Unit,
        Rest,
        Poi,
        Door,
        Lift,
        Connection,
        Thing,
        Event,
        Group,
        ForEach,
        Rule,
        State,
        Dependency,
        Agent,
        Travel,
        Batteries,
        Assume,
        Objective,
        ReachObjective,
        Optional,
        MissionEnd,
    )
}
"""The kinds of statements, by the token that begins each."""

BY_RULE: Mapping[str, Type[StatementKind]] = {kind.rule(): kind for kind in STATEMENTS.values()}
"""The same, by their rules in the grammar."""

DECLARED: Mapping[str, str] = {token: kind.declares for token, kind in STATEMENTS.items() if kind.declares}
"""The kind of thing that a statement declares, by the token that begins the statement."""

TAIL = "TAIL"
"""The token of the query that the original's tools leave behind the objective, which is no statement."""

_ALL = (*(word for kind in STATEMENTS.values() for word in kind.own_words), *WORDS)

KEYWORDS: Dict[str, str] = {word.token: word.text for word in _ALL}
"""The words of the language, by token."""

MEANINGS: Dict[str, str] = {word.token: word.meaning for word in _ALL}
"""What each word means, by token."""

VALUES: FrozenSet[str] = frozenset(("TRUE", "FALSE", "IS_TRUE", "IS_FALSE"))
"""The tokens of those of them that are values of states."""

MAY_BREAK: FrozenSet[str] = frozenset(word.token for word in _ALL if word.may_break)
"""The tokens of those of them before which a line may be broken."""

MAY_BE_NAMES: Dict[str, str] = {word.token: word.text for word in _ALL if word.may_be_name}
"""Those of the words that scenarios may use as names, by token: `human` is an agent of published scenarios, and the
others are younger than many scenarios."""

RESERVED: FrozenSet[str] = frozenset(KEYWORDS.values()) - set(MAY_BE_NAMES.values())
"""Those of them that cannot be names."""


def section_of(token: str) -> str:
    """The token of those statements among which one that begins with this token stands."""
    kind = STATEMENTS.get(token)
    return "OBJECTIVE" if token == TAIL else (kind.among if kind is not None else "") or token
