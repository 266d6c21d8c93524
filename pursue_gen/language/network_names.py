"""The names of the network that a scenario becomes: one place, because the checks of the language ask which names are
taken, and the translation, plans, the observer and the controllers all meet them.
"""

from __future__ import annotations

import re

from pursue_gen.language.scenario import Event
from pursue_runtime import locations

CLOCK_OBJECTIVE = "Cobj"
CLOCK_REACH = "Creach"
OBJECTIVE = "obj"
REACH = "reachObj"
STATES = "states"

_SAFETY, _REACH = (re.compile(rf"{name}([2-9]|[1-9][0-9]+)?") for name in (OBJECTIVE, REACH))

IDLE, AT_RISK, LOSE = "idle", "atRisk", "lose"
"""The locations of a safety objective's automaton: no duty, a deadline is running, a duty was missed."""

LATE = "late"
"""The location of a reach objective's automaton in which its deadline has passed."""

going, doing = locations.movement, locations.action
"""The location on the way from one POI to another; the location at work, by event and POI."""

is_going, is_doing, is_under_way = locations.is_movement, locations.is_action, locations.is_under_way
"""True for a location on the way, for one at work, for either: its end takes time to come."""

in_words = locations.in_words
"""Where an agent is, in English."""

automaton_clock = agent_clock = locations.automaton_clock
"""The clock of an automaton; of an agent's: how long since its last action or movement began or ended."""

agent_position = locations.position_variable
"""The variable that holds where an agent is."""


def safety_objective(number: int) -> str:
    """The automaton of a safety objective: `obj`, `obj2`, `obj3`, …; the number counts from 0."""
    return _numbered(OBJECTIVE, number)


def reach_objective(number: int) -> str:
    """The automaton of a reach objective: `reachObj`, `reachObj2`, …; the number counts from 0."""
    return _numbered(REACH, number)


def safety_clock(number: int) -> str:
    """The clock of a safety objective: `Cobj`, `Cobj2`, …"""
    return _numbered(CLOCK_OBJECTIVE, number)


def reach_clock(number: int) -> str:
    """The clock of a reach objective: `Creach`, `Creach2`, …"""
    return _numbered(CLOCK_REACH, number)


def is_safety_objective(automaton: str) -> bool:
    """True for the name of a safety objective's automaton. An agent may have it where there are not so many."""
    return _SAFETY.fullmatch(automaton) is not None


def is_reach_objective(automaton: str) -> bool:
    """True for the name of a reach objective's automaton. An agent may have it where there are not so many."""
    return _REACH.fullmatch(automaton) is not None


def unlocking(number: int) -> str:
    """The channel on which a reach objective is unlocked, where others are with it; else that edge has none.

    It is the word that the edge has in any case.
    """
    return movement(reach_objective(number), "going_initial_location", "unlocked")


def _numbered(name: str, number: int) -> str:
    return name if number == 0 else f"{name}{number + 1}"


def rule_turn(rule: str) -> str:
    """The variable that holds the number of a rule's location."""
    return f"P{rule}"


def own_turn(rule: str, agent: str) -> str:
    """The variable that holds the number of an agent's own turn in a rule."""
    return f"P{rule}_{agent}"


def state_value(state: str) -> str:
    """The variable that holds a state, 0 or 1."""
    return f"S{state}"


def movement(agent: str, a: str, b: str) -> str:
    """The channel on which an agent sets off from a to b."""
    return f"{agent}_{a}2{b}"


def arrival(agent: str, a: str, b: str) -> str:
    """The channel on which an agent arrives at b from a, where somebody listens to that; else that edge has none.

    It is the word that the edge has in any case.
    """
    return f"{agent}_{going(a, b)}2{b}"


def done(event: str) -> str:
    """The channel on which an event with a duration ends."""
    return f"{event}DONE"


def busy(event: str) -> str:
    """The variable that is 1 while an event goes on that several agents can do, and that its partners share."""
    return f"B{event}"


def assumption(number: int) -> str:
    """The variable of an assumption (the first has number 1): 1, or 0 in a mission in which it has been broken."""
    return f"assume{number}"


def is_assumption(variable: str) -> bool:
    """True for the variable of an assumption."""
    return variable.startswith("assume") and variable[len("assume") :].isdigit()


def assumption_count(number: int) -> str:
    """The variable that counts what the assumption limits."""
    return f"assume{number}count"


def assumption_clock(number: int) -> str:
    """The clock of an assumption about times."""
    return f"Cassume{number}"


def count(event: str) -> str:
    """The automaton that counts how often an event has begun that can happen so many times only."""
    return f"{event}_count"


def busy_with(agent: str) -> str:
    """The variable that says with which event an agent is busy, and where."""
    return f"W{agent}"


def level(agent: str) -> str:
    """The variable that holds the level of an agent's battery."""
    return f"L{agent}"


def has_happened(event: Event) -> str:
    """The channel that says that an event has happened: its end where it lasts, the event itself where it does not."""
    return event.name if event.duration is None else done(event.name)
