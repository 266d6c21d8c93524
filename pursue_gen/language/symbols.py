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


@enum.unique
class Role(enum.Enum):
    """What a name stands for: the form of its text, and its meaning. `{}` are its parts: names, and numbers from 1.

    Called with the parts it makes the symbol.
    """

    def __init__(self, form: str, meaning: str) -> None:
        self.form, self.meaning = form, meaning

    def __call__(self, *parts: object) -> Symbol:
        return Symbol(self.form.format(*parts), self, tuple(map(str, parts)))

    NAME = "{}", "{}"  # nothing more is known of it

    AGENT = "{}", "the agent {}"
    POSITION = locations.position_variable("{}"), "the position of {}"
    CLOCK = locations.automaton_clock("{}"), "the clock of {}"
    BUSY_WITH = "W{}", "with what {} is busy"
    LEVEL = "L{}", "the level of {}'s battery"
    LOAD = "H{}", "what {} carries"
    AT = "{}", "the POI {}"
    WAY = locations.movement("{}", "{}"), "the way from {} to {}"
    WORK = locations.action("{}", "{}"), "{} in {}"
    SOMEWHERE = locations.SOMEWHERE, "it is not known where it starts"
    STARTS = "{}_starts_at_{}", "that {} starts at {}"
    SETTING_OFF = "{}_{}2{}", "{} leaving {} for {}"
    ARRIVAL = f"{{0}}_{locations.movement('{1}', '{2}')}2{{2}}", "{0} arriving at {2} from {1}"

    EVENT = "{}", "the event {}"
    END = "{}DONE", "the end of {}"
    BROKEN_OFF = "{}STOP", "that {} is broken off"
    PART_END = "{}PART", "the end of a part of {}"
    PARTS = "{}_parts", "the parts of {}"
    PARTS_DONE = "P{}_parts", "how many parts of {} are done"
    BUSY = "B{}", "that {} goes on"
    COUNT = "{}_count", "the count of {}"
    TIMES = "P{}_count", "how often {} has happened"
    RULE = "{}", "the rule {}"
    TURN = "P{}", "the position of the rule {}"
    RULE_CLOCK = locations.automaton_clock("{}"), "the clock of the rule {}"
    OWN_TURN = "P{}_{}", "the turn of {1} in the rule {0}"
    STATES = "states", "the automaton of all states"
    STATE = "{}", "the state {}"
    VALUE = "S{}", "the value of the state {}"
    FACT = "{}", "whether the state {} is known"
    FACT_CLOCK = locations.automaton_clock("{}"), "the clock of the state {}"
    FOUND = "{}_is_{}", "that the state {} is found to be {}"
    UNKNOWN = "unknown", "a state is not known"
    FINDING = locations.FINDING_OUT, "a state is being found out"
    KNOWN = "known", "a state is known"

    ORDER_DESK = "order_desk", "what people may order"
    DESK_OPEN = "order_desk_open", "whether an order is being taken"
    LISTENING = "listening", "orders may come"

    SAFETY = "obj{}", "a part of an objective"
    SAFETY_CLOCK = "Cobj{}", "a part of an objective"
    SAFETY_TURN = "P{}", "a part of an objective"
    CHARGE_CLOCK = "Ccharge{}", "a part of a battery"
    SAFETY_OLDEST = "P{}_oldest", "a part of an objective"
    SAFETY_PAUSE = "P{}_pause", "a part of an objective"
    IDLE = "idle", "nothing is due"
    AT_RISK = "atRisk", "a deadline is running"
    CHARGING = "atCharger", "a battery is being charged"
    EMPTY = "atChargerEmpty", "an empty battery is being charged"
    LEFT = "atRisk_{}", "a deadline is running: the charger was left with so many parts of a battery: {}"
    CAME = "atCharger_{}", "a battery is being charged, and no part of it done yet: {} before"
    CAME_LATE = "atChargerEmpty_{}", "an empty battery is being charged, and no part of it done yet: {} before"
    CHARGED = "charged_{}", "a battery is being charged, and has so many parts: {}"
    LOSE = "lose", "a promise is broken"
    REACH = "reachObj{}", "a part of an objective"
    REACH_CLOCK = "Creach{}", "a part of an objective"
    UNLOCKING = "reachObj{}_going_initial_location2unlocked", "a part of an objective"
    START = "initial_location", "a goal does not count yet"
    UNLOCKED = "unlocked", "a goal counts, and nothing of it is done"
    DID = "did_{}", "these events of a goal have happened: {}"
    DONE_TIMES = "did_{}_times", "the event of a goal has happened so often: {}"
    APART = "did_{}_times_apart", "the event of a goal has happened so often, and may not count yet again: {}"
    REACH_APART = "Capart{}", "a part of an objective"
    WIN = "win", "a goal is reached"
    LATE = "late", "the deadline of a goal has passed"
    ASSUMPTION = "assume{}", "a part of an assumption"
    ASSUMED_TIMES = "assume{}count", "a part of an assumption"
    ASSUMED_TIME = "Cassume{}", "a part of an assumption"
    AWAITED = "assume{}way", "a part of an assumption"

    WATCHER = "{}_for_{}", "{}, watched for {}"
    PASSAGE = f"{{}}{locations.PASSAGE}{{}}", "the order of visits to {}"
    AWAITS = f"{locations.AWAITS}{{}}_{{}}", "next is {}, visit {}"
    HAS = f"{locations.HAS}{{}}_{{}}", "taken by {}, visit {}"
    NOBODY = "awaits_nobody", "nobody comes any more"
    TOUR = "{}_tour", "the tour of {}"
    STOP = "stop_{0}", "stop {} of {}"
    OFF = "lose", "off the tour"
    DUE = "@due_{}", "whether the deadline of {} is running"

    PACKAGE = "controller_{}", "the package of {}"
    BRINGUP = "{}_bringup", "the package that starts the mission"


UNDER_WAY = (Role.WAY, Role.WORK, Role.FINDING, Role.SOMEWHERE)
"""The locations that are left by the end of a movement or an action, or once it is known what is being found out, or
where an agent starts: it takes time to come."""


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
        return self.role.meaning.format(*self.parts)


def role_of(name: str) -> Role:
    """What a name stands for."""
    return Symbol.of(name).role


def numbered(role: Role, number: int) -> Symbol:
    """The symbol of the part of an objective with that number, from 0; the text of the first one has no number."""
    return Symbol(role.form.format(number + 1 if number else ""), role, (str(number + 1),))


_COUNTED = Role.DONE_TIMES, Role.APART, Role.LEFT, Role.CAME, Role.CAME_LATE, Role.CHARGED
_FURTHER = "([2-9]|[1-9][0-9]+)?"
_ENDS = (Role.END, Role.BROKEN_OFF, Role.PART_END)
_READ = {role: "(.+)" for role in Role if "{" not in role.form or role in (*UNDER_WAY, *_ENDS)}
_READ.update(dict.fromkeys(_COUNTED, "([1-9][0-9]*)"))
_READ.update({Role.DID: "([1-9][0-9_]*)", Role.SAFETY: _FURTHER, Role.REACH: _FURTHER, Role.ASSUMPTION: "([0-9]+)"})
_READ[Role.AWAITED] = _READ[Role.ASSUMPTION]
_FORMS = {role: re.compile(role.form.replace("{}", part)) for role, part in _READ.items()}
"""The forms of texts that are read; no name of a scenario is like one of those with parts, but for numbers."""


@lru_cache(maxsize=1 << 14)
def _read(text: str) -> Symbol:
    for role, form in _FORMS.items():
        match = form.fullmatch(text)
        if match:
            parts = tuple(part or "1" for part in match.groups())
            return Symbol(text, role, parts if role is not Role.DID else tuple(parts[0].split("_")))
    return Role.NAME(text)
