"""Symbols: names in networks that know what they stand for.

A symbol is equal to its text, so networks, plans and files hold plain names. Who makes a name says what it stands for
(`network_names`); `Symbol.of` is the one place where that is read from a text.
"""

from __future__ import annotations

import enum
import re
from functools import lru_cache
from typing import Any, Callable, NoReturn, Tuple

from pursue_runtime import locations


class Role(enum.Enum):
    """What a name stands for, in words; `{}` are the parts of its symbol: names, and numbers from 1."""

    NAME = "{}"  # nothing more is known of it

    AGENT = "the agent {}"
    POSITION = "the position of {}"
    CLOCK = "the clock of {}"
    BUSY_WITH = "with what {} is busy"
    LEVEL = "the level of {}'s battery"
    AT = "the POI {}"
    WAY = "the way from {} to {}"
    WORK = "{} in {}"
    SETTING_OFF = "{} leaving {} for {}"
    ARRIVAL = "{0} arriving at {2} from {1}"

    EVENT = "the event {}"
    END = "the end of {}"
    BUSY = "that {} goes on"
    COUNT = "the count of {}"
    TIMES = "how often {} has happened"
    RULE = "the rule {}"
    TURN = "the position of the rule {}"
    RULE_CLOCK = "the clock of the rule {}"
    OWN_TURN = "the turn of {1} in the rule {0}"
    STATE = "the state {}"
    VALUE = "the value of the state {}"

    SAFETY = "the promise {}"
    IDLE = "nothing is due"
    AT_RISK = "a deadline is running"
    LOSE = "the promise is broken"
    REACH = "the goal {}"
    START = "the goal does not count yet"
    UNLOCKED = "the goal counts, and nothing of it is done"
    DID = "some events of the goal are done, by their numbers"
    WIN = "the goal is reached"
    LATE = "the deadline of the goal has passed"
    OF_OBJECTIVE = "a part of an objective"
    ASSUMPTION = "the assumption {}"
    OF_ASSUMPTION = "a part of an assumption"

    WATCHER = "a promise, watched for some robots"
    PASSAGE = "the order of visits to {}"
    AWAITS = "next is {}, visit {}"
    HAS = "taken by {}, visit {}"
    NOBODY = "nobody comes any more"
    TOUR = "the tour of {}"
    DUE = "whether the deadline of {} is running"

    PACKAGE = "the package of {}"
    BRINGUP = "the package that starts the mission"


class Symbol(str):
    """A name in a network: its text, what it stands for, and the names and numbers that it is made of, by which its
    statement is found in the scenario. Frozen; equal to its text, with the same hash."""

    __slots__ = ("parts", "role")
    role: Role
    parts: Tuple[str, ...]

    def __new__(cls, text: str, role: Role, parts: Tuple[str, ...] = ()) -> Symbol:
        """The symbol of a text."""
        self = super().__new__(cls, text)
        object.__setattr__(self, "role", role)
        object.__setattr__(self, "parts", parts)
        return self

    def __setattr__(self, name: str, value: object) -> NoReturn:
        raise AttributeError(f"symbols are frozen: {name} cannot be set")

    def __reduce__(self) -> Tuple[Callable[..., Symbol], Tuple[Any, ...]]:
        return Symbol, (str(self), self.role, self.parts)

    @staticmethod
    def of(name: str) -> Symbol:
        """The symbol that a name is; else what is read from its text: it comes from a file of UPPAAL or a mission."""
        return name if isinstance(name, Symbol) else _read(name)

    def called(self, text: str) -> Symbol:
        """The symbol of the same thing with another text."""
        return Symbol(text, self.role, self.parts)

    @property
    def meaning(self) -> str:
        """What it stands for, in words."""
        return self.role.value.format(*self.parts)


UNDER_WAY = (Role.WAY, Role.WORK)
"""The locations that are left by the end of a movement or an action: it takes time to come."""


def role_of(name: str) -> Role:
    """What a name stands for."""
    return Symbol.of(name).role


_FORMS = tuple(
    (role, re.compile(form))
    for role, form in (
        (Role.WAY, locations.movement("(.+?)", "(.+)")),
        (Role.WORK, locations.action("(.+)", "(.+)")),
        (Role.IDLE, "idle"),
        (Role.AT_RISK, "atRisk"),
        (Role.LOSE, "lose"),
        (Role.START, "initial_location"),
        (Role.UNLOCKED, "unlocked"),
        (Role.DID, "did_([1-9][0-9_]*)"),
        (Role.WIN, "win"),
        (Role.LATE, "late"),
        (Role.SAFETY, "obj([2-9]|[1-9][0-9]+)?"),
        (Role.REACH, "reachObj([2-9]|[1-9][0-9]+)?"),
        (Role.END, "(.+)DONE"),
        (Role.ASSUMPTION, "assume([0-9]+)"),
    )
)


@lru_cache(maxsize=1 << 14)
def _read(text: str) -> Symbol:
    for role, form in _FORMS:
        match = form.fullmatch(text)
        if match:
            parts = tuple(part or "1" for part in match.groups())
            return Symbol(text, role, parts if role is not Role.DID else tuple(parts[0].split("_")))
    return Symbol(text, Role.NAME, (text,))
