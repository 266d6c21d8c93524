"""What moves change: the values of agents and states behind a move, and what has to hold before it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, Mapping, Optional, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.clauses import FALSE, NEVER, TRUE, UNKNOWN, Clauses, Domains, Value, given, simplified
from pursue_gen.language.scenario import Scenario

Becomes = Mapping[Tuple[str, Value], Value]
"""What becomes of the value of a variable; values that are not named stay."""


@dataclass(frozen=True)
class Change:
    """What a move makes of the values of variables; `known` is a variable whose value is known before it."""

    becomes: Becomes
    known: Optional[Tuple[str, Value]] = None

    def before(self, clauses: Clauses, domains: Domains) -> Clauses:
        """What has to hold before the move so that the clauses hold after it."""
        return tuple(
            {
                name: frozenset(v for v in domains.ever(name) if self.becomes.get((name, v), v) in values)
                for name, values in clause.items()
            }
            for clause in clauses
        )

    def guard(self, parts: Iterable[Clauses], domains: Domains) -> Optional[Clauses]:
        """What is left to be tested so that all parts hold before the move; None where they cannot."""
        clauses = simplified([clause for part in parts for clause in part], domains)
        if clauses == NEVER:
            return None
        return clauses if self.known is None else given(clauses, *self.known)


def placed(agent: str, poi: str) -> Change:
    """It is said where an agent starts."""
    return Change({(agent, UNKNOWN): Value("at", poi)}, (agent, UNKNOWN))


def setting_off(agent: str, a: str, b: str) -> Change:
    """An agent sets off from a to b."""
    origin = Value("at", a)
    return Change({(agent, origin): Value("way", a, b)}, (agent, origin))


def arriving(agent: str, a: str, b: str) -> Change:
    """An agent arrives at b from a."""
    way = Value("way", a, b)
    return Change({(agent, way): Value("at", b)}, (agent, way))


def states_set(channel: str, scenario: Scenario) -> Becomes:
    """What an event, or the end of one, sets."""
    becomes: Dict[Tuple[str, Value], Value] = {}
    for state in scenario.states:
        for value, refs in ((TRUE, state.true_if), (FALSE, state.false_if)):
            if any(ref.name == channel for ref in refs):
                becomes.update(((state.name, old), value) for old in (TRUE, FALSE, UNKNOWN))
    return becomes


def found_out(state: str, value: bool) -> Change:
    """It is found out that a state is true, or false."""
    return Change({(state, UNKNOWN): TRUE if value else FALSE})


def happening(channel: str, scenario: Scenario, domains: Domains) -> Change:
    """The beginning or the end of an event, whoever does it: states, and what agents are busy with.

    As to those who are busy it is exact only where one agent alone can do the event.
    """
    becomes = dict(states_set(channel, scenario))
    for agent in scenario.agents:
        for work in domains.of(agent.name):
            if work.is_work and channel == work.what:
                becomes[agent.name, Value("at", work.where)] = work
            elif work.is_work and channel in _ends(work.what):
                becomes[agent.name, work] = Value("at", work.where)
    return Change(becomes)


def _ends(event: str) -> Tuple[str, ...]:
    """The channels on which an event may end, or be left."""
    return names.done(event), names.broken_off(event), names.part_done(event)


def beginning(agent: str, event: str, place: str, scenario: Scenario, domains: Domains) -> Change:
    """An agent does or begins an event at a place: states, and what it and those who take part are busy with."""
    becomes, here = dict(states_set(event, scenario)), Value("at", place)
    shared = {other.name for other in scenario.agents if any(ref.name == event for ref in other.reacts_to)}
    work = Value("doing", place, event)
    for name in (agent, *shared):
        if work in domains.of(name):
            becomes[name, here] = work
    return Change(becomes, (agent, here))
