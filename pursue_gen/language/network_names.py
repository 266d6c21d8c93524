"""The names of the network that a scenario becomes: one place, because the checks of the language ask which names are
taken, and the translation, plans, the observer and the controllers all meet them. Roles make names of their parts.
"""

from __future__ import annotations

from functools import partial
from typing import Tuple

from pursue_gen.language.scenario import Event
from pursue_gen.language.symbols import Role, Symbol, numbered

STATES = Role.STATES()
"""The automaton of all states."""

IDLE, AT_RISK, LOSE = Role.IDLE(), Role.AT_RISK(), Role.LOSE()
"""The locations of a safety objective's automaton: no duty, a deadline is running, a duty was missed."""

CHARGING, EMPTY = Role.CHARGING(), Role.EMPTY()
"""Locations of a battery's automaton, which is one of a safety objective: its robot is at the charger, and the battery
not full yet; and it is too late to leave before it is."""

left_with, came_with, came_too_late, charged_to = Role.LEFT, Role.CAME, Role.CAME_LATE, Role.CHARGED
"""Locations of a battery's automaton where parts of it count: its robot is away since it left the charger with so many;
it is back, and no part done yet; likewise, but too late to leave before one is; and so many are done."""

START, UNLOCKED, WIN, LATE = Role.START(), Role.UNLOCKED(), Role.WIN(), Role.LATE()
"""Locations of a reach objective's automaton: it does not count yet, it does, it is reached, its time is over."""

at, going, doing = Role.AT, Role.WAY, Role.WORK
"""The location of an agent at a POI; on the way from one to another; at work, by event and POI."""

agent, agent_position, agent_clock = Role.AGENT, Role.POSITION, Role.CLOCK
"""The automaton of an agent; where it is; how long since its last action or movement began or ended."""

busy_with, level, load = Role.BUSY_WITH, Role.LEVEL, Role.LOAD
"""The variables of an agent with which event it is busy, and where; of the level of its battery; of what it
carries."""

SOMEWHERE, starts = Role.SOMEWHERE(), Role.STARTS
"""The location of an agent of whom it is not known yet where it starts, and the channels that say that, by agent and
POI."""

NOWHERE = 0
"""The value of its position then: no place has this number, and no way."""

movement, arrival = Role.SETTING_OFF, Role.ARRIVAL
"""The channels on which an agent sets off from one POI to another, and arrives there, where somebody listens to that;
else that edge has none. It is the word that the edge has in any case."""

event, done, broken_off, part_done = Role.EVENT, Role.END, Role.BROKEN_OFF, Role.PART_END
"""The channels on which an event happens or begins, and on which one with a duration ends, is broken off, or a part of
it ends that is not the last one."""

busy = Role.BUSY
"""The variable that is 1 while an event goes on that several agents can do, and that happens once at a time."""

parts, parts_done = Role.PARTS, Role.PARTS_DONE
"""The automaton that counts how many parts of an event are done, and its variable."""

count, times = Role.COUNT, Role.TIMES
"""The automaton that counts how often an event has begun that can happen so many times only, and its variable."""

rule, rule_turn, rule_clock, own_turn = Role.RULE, Role.TURN, Role.RULE_CLOCK, Role.OWN_TURN
"""The automaton of a rule, the variable with the number of its location, its clock in the observer; the variable with
the number of an agent's own turn in a rule."""

state, state_value = Role.STATE, Role.VALUE
"""A state, as people call it, and the variable that holds it, 0 or 1; or UNKNOWN_VALUE."""

UNKNOWN_VALUE = 2
"""The value of a state's variable while it is not known which of the two it is."""

UNKNOWN, FINDING, KNOWN = Role.UNKNOWN(), Role.FINDING(), Role.KNOWN()
"""The locations of the automaton of a state that is not known at first."""

finding, finding_clock = Role.FACT, Role.FACT_CLOCK
"""This automaton, called like its state, and its clock."""


def found(name: str, value: bool) -> Symbol:
    """The channel on which it is said that a state is true, or false."""
    return Role.FOUND(name, str(value).lower())


ORDER_DESK, DESK_OPEN, LISTENING = Role.ORDER_DESK(), Role.DESK_OPEN(), Role.LISTENING()
"""The automaton of what people order, its variable, which is 1 only while an order is taken that was proven, and its
location."""

assumption, assumption_count, assumption_clock = Role.ASSUMPTION, Role.ASSUMED_TIMES, Role.ASSUMED_TIME
"""By the number of an assumption (the first has number 1): its variable, 1, or 0 in a mission in which it has been
broken; the variable that counts what it limits; its clock, if it is about times."""

assumed_way = Role.AWAITED
"""By the number of an assumption the automaton of the way of who is awaited somewhere."""

safety_objective, safety_clock = partial(numbered, Role.SAFETY), partial(numbered, Role.SAFETY_CLOCK)
"""By the number of a safety objective, from 0: its automaton, `obj`, `obj2`, …, and its clock, `Cobj`, `Cobj2`, …"""

charge_clock = partial(numbered, Role.CHARGE_CLOCK)
"""By the number of a safety objective that is a battery, its clock of how long its robot has been at the charger."""


def safety_pause(number: int) -> Symbol:
    """The variable that says whether the pause of that safety objective, from 0, counts."""
    return Role.SAFETY_PAUSE(safety_objective(number))


def safety_turn(number: int) -> Symbol:
    """The variable of that safety objective, from 0, and of those behind it in its statement: whose turn it is."""
    return Role.SAFETY_TURN(safety_objective(number))


def safety_oldest(number: int) -> Symbol:
    """The variable of the statement that begins with that safety objective: which of its requests waits longest."""
    return Role.SAFETY_OLDEST(safety_objective(number))


reach_objective, reach_clock = partial(numbered, Role.REACH), partial(numbered, Role.REACH_CLOCK)
"""By the number of a reach objective, from 0: its automaton, `reachObj`, …, and its clock, `Creach`, …"""

reach_apart = partial(numbered, Role.REACH_APART)
"""The clock of a reach objective since its event has counted last."""

unlocking = partial(numbered, Role.UNLOCKING)
"""The channel on which a reach objective is unlocked, where others are with it; else that edge has none. It is the word
that the edge has in any case."""


def did(*events: int) -> Symbol:
    """The location of a reach objective's automaton in which these of its events have happened, from 1."""
    numbers = tuple(map(str, events))
    return Symbol(Role.DID.form.format("_".join(numbers)), Role.DID, numbers)


def done_times(times: int) -> Symbol:
    """The location of a reach objective's automaton in which its event has counted so often."""
    return Role.DONE_TIMES(times)


def apart(times: int) -> Symbol:
    """The same, where it is too soon for it to count again."""
    return Role.APART(times)


def leaves_off(of: Event) -> Tuple[Symbol, ...]:
    """The channels on which an event ends that has not happened then: it is broken off, or one of its parts ends."""
    broken = (broken_off(of.name),) if of.may_stop else ()
    return broken if of.split is None else (*broken, part_done(of.name))


def has_happened(of: Event) -> Symbol:
    """The channel that says that an event has happened: its end where it lasts, the event itself where it does not."""
    return event(of.name) if of.duration is None else done(of.name)
