"""The names of the network that a scenario becomes: one place, because the checks of the language ask which names are
taken, and the translation, plans, the observer and the controllers all meet them.
"""

from __future__ import annotations

from pursue_gen.language.scenario import Event
from pursue_gen.language.symbols import Role, Symbol
from pursue_runtime import locations

STATES = Symbol("states", Role.NAME, ("states",))
"""The automaton of all states."""

IDLE, AT_RISK, LOSE = Symbol("idle", Role.IDLE), Symbol("atRisk", Role.AT_RISK), Symbol("lose", Role.LOSE)
"""The locations of a safety objective's automaton: no duty, a deadline is running, a duty was missed."""

START, UNLOCKED = Symbol("initial_location", Role.START), Symbol("unlocked", Role.UNLOCKED)
WIN, LATE = Symbol("win", Role.WIN), Symbol("late", Role.LATE)
"""Locations of a reach objective's automaton: it does not count yet, it does, it is reached, its time is over."""

in_words = locations.in_words
"""Where an agent is, in English."""


def at(poi: str) -> Symbol:
    """The location of an agent at a POI."""
    return Symbol(poi, Role.AT, (poi,))


def going(a: str, b: str) -> Symbol:
    """The location on the way from one POI to another."""
    return Symbol(locations.movement(a, b), Role.WAY, (a, b))


def doing(event: str, poi: str) -> Symbol:
    """The location at work, by event and POI."""
    return Symbol(locations.action(event, poi), Role.WORK, (event, poi))


def did(*events: int) -> Symbol:
    """The location of a reach objective's automaton in which these of its events have happened, from 1."""
    numbers = tuple(map(str, events))
    return Symbol("_".join(("did", *numbers)), Role.DID, numbers)


def agent(name: str) -> Symbol:
    """The automaton of an agent."""
    return Symbol(name, Role.AGENT, (name,))


def rule(name: str) -> Symbol:
    """The automaton of a rule."""
    return Symbol(name, Role.RULE, (name,))


def event(name: str) -> Symbol:
    """The channel on which an event happens, or begins."""
    return Symbol(name, Role.EVENT, (name,))


def agent_clock(agent: str) -> Symbol:
    """The clock of an agent: how long since its last action or movement began or ended."""
    return Symbol(locations.automaton_clock(agent), Role.CLOCK, (agent,))


def rule_clock(rule: str) -> Symbol:
    """The clock that a rule has in the observer."""
    return Symbol(locations.automaton_clock(rule), Role.RULE_CLOCK, (rule,))


def agent_position(agent: str) -> Symbol:
    """The variable that holds where an agent is."""
    return Symbol(locations.position_variable(agent), Role.POSITION, (agent,))


def safety_objective(number: int) -> Symbol:
    """The automaton of a safety objective: `obj`, `obj2`, `obj3`, …; the number counts from 0."""
    return _numbered("obj", Role.SAFETY, number)


def reach_objective(number: int) -> Symbol:
    """The automaton of a reach objective: `reachObj`, `reachObj2`, …; the number counts from 0."""
    return _numbered("reachObj", Role.REACH, number)


def safety_clock(number: int) -> Symbol:
    """The clock of a safety objective: `Cobj`, `Cobj2`, …"""
    return _numbered("Cobj", Role.OF_OBJECTIVE, number)


def reach_clock(number: int) -> Symbol:
    """The clock of a reach objective: `Creach`, `Creach2`, …"""
    return _numbered("Creach", Role.OF_OBJECTIVE, number)


def unlocking(number: int) -> Symbol:
    """The channel on which a reach objective is unlocked, where others are with it; else that edge has none.

    It is the word that the edge has in any case.
    """
    return Symbol(f"{reach_objective(number)}_going_{START}2{UNLOCKED}", Role.OF_OBJECTIVE)


def _numbered(name: str, role: Role, number: int) -> Symbol:
    return Symbol(name if number == 0 else f"{name}{number + 1}", role, (str(number + 1),))


def rule_turn(rule: str) -> Symbol:
    """The variable that holds the number of a rule's location."""
    return Symbol(f"P{rule}", Role.TURN, (rule,))


def own_turn(rule: str, agent: str) -> Symbol:
    """The variable that holds the number of an agent's own turn in a rule."""
    return Symbol(f"P{rule}_{agent}", Role.OWN_TURN, (rule, agent))


def state(name: str) -> Symbol:
    """A state, as people call it."""
    return Symbol(name, Role.STATE, (name,))


def state_value(state: str) -> Symbol:
    """The variable that holds a state, 0 or 1."""
    return Symbol(f"S{state}", Role.VALUE, (state,))


def movement(agent: str, a: str, b: str) -> Symbol:
    """The channel on which an agent sets off from a to b."""
    return Symbol(f"{agent}_{a}2{b}", Role.SETTING_OFF, (agent, a, b))


def arrival(agent: str, a: str, b: str) -> Symbol:
    """The channel on which an agent arrives at b from a, where somebody listens to that; else that edge has none.

    It is the word that the edge has in any case.
    """
    return Symbol(f"{agent}_{locations.movement(a, b)}2{b}", Role.ARRIVAL, (agent, a, b))


def done(event: str) -> Symbol:
    """The channel on which an event with a duration ends."""
    return Symbol(f"{event}DONE", Role.END, (event,))


def busy(event: str) -> Symbol:
    """The variable that is 1 while an event goes on that several agents can do, and that its partners share."""
    return Symbol(f"B{event}", Role.BUSY, (event,))


def assumption(number: int) -> Symbol:
    """The variable of an assumption (the first has number 1): 1, or 0 in a mission in which it has been broken."""
    return Symbol(f"assume{number}", Role.ASSUMPTION, (str(number),))


def assumption_count(number: int) -> Symbol:
    """The variable that counts what the assumption limits."""
    return Symbol(f"assume{number}count", Role.OF_ASSUMPTION)


def assumption_clock(number: int) -> Symbol:
    """The clock of an assumption about times."""
    return Symbol(f"Cassume{number}", Role.OF_ASSUMPTION)


def count(event: str) -> Symbol:
    """The automaton that counts how often an event has begun that can happen so many times only."""
    return Symbol(f"{event}_count", Role.COUNT, (event,))


def times(event: str) -> Symbol:
    """The variable that holds how often an event has begun that can happen so many times only."""
    return Symbol(f"P{count(event)}", Role.TIMES, (event,))


def busy_with(agent: str) -> Symbol:
    """The variable that says with which event an agent is busy, and where."""
    return Symbol(f"W{agent}", Role.BUSY_WITH, (agent,))


def level(agent: str) -> Symbol:
    """The variable that holds the level of an agent's battery."""
    return Symbol(f"L{agent}", Role.LEVEL, (agent,))


def has_happened(of: Event) -> Symbol:
    """The channel that says that an event has happened: its end where it lasts, the event itself where it does not."""
    return event(of.name) if of.duration is None else done(of.name)
