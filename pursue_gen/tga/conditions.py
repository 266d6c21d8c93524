"""Conditions as guards: tests of agents' positions, of what they are busy with, and of states. And what moves change of
these values: what has to hold before a move so that a condition holds after it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.clauses import (
    FALSE,
    NEVER,
    TRUE,
    UNKNOWN,
    Clause,
    Clauses,
    Domains,
    Value,
    clauses_of,
    given,
    possibly,
    simplified,
)
from pursue_gen.language.conditions import AllOf, AnyOf, AtMostOf, Condition, Doing, Not, atoms
from pursue_gen.language.scenario import Connection, Scenario
from pursue_gen.tga.network import Clause as Tests
from pursue_gen.tga.network import Test
from pursue_gen.tga.positions import Positions

_NUMBERS = {FALSE: 0, TRUE: 1, UNKNOWN: names.UNKNOWN_VALUE}
"""By what a state is, the value of its variable."""


class Conditions:
    """The conditions of a scenario as guards over the variables of its network.

    An agent's position says where it is at work, not at what. Where a condition has to tell two events apart that the
    agent can do at one place, one more variable says what it is busy with: 0, or the number of event and place.

    Of what depends on states that are not known yet, agents that are controlled begin what they may begin whatever
    these are; the others begin what they may for some of their values, as nobody knows what keeps them from it.
    """

    def __init__(self, scenario: Scenario, positions: Positions) -> None:
        self.domains = Domains(scenario)
        self._positions = positions
        self._states = frozenset(state.name for state in scenario.states)
        self._controlled = frozenset(agent.name for agent in scenario.agents if agent.controllable)
        self._work = dict(self._numbers(scenario))
        self._ways: Dict[Tuple[str, str], List[Tuple[Connection, Clauses]]] = {}
        for connection in scenario.connections:
            only_if = connection.only_if
            clauses = () if only_if is None else clauses_of(only_if, self.domains)
            for way in connection.directions:
                self._ways.setdefault(way, []).append((connection, clauses))
        self._events = {
            event.name: clauses_of(event.only_if, self.domains)
            for event in scenario.events
            if event.only_if is not None
        }

    def setting_off(self, agent: str, a: str, b: str) -> Optional[Tuple[Tests, ...]]:
        """What has to hold when the agent sets off from a to b; None: that it cannot."""
        clauses = next((those for way, those in self._ways.get((a, b), ()) if way.admits(agent)), ())
        return self._guard(self._for(agent, clauses), agent, Value("at", a))

    def beginning(self, event: str, agent: str, where: Value) -> Optional[Tuple[Tests, ...]]:
        """What has to hold when the agent, which is there, does or begins the event; None: that it cannot."""
        return self._guard(self._for(agent, self._events.get(event, ())), agent, where)

    def having(self, state: str, value: bool, agent: str) -> Tests:
        """What has to hold when the agent does what needs this value of a state."""
        unknown = state in self.domains.unknown and agent not in self._controlled
        variable = names.state_value(state)
        return (Test(variable, int(value)), *([Test(variable, names.UNKNOWN_VALUE)] if unknown else []))

    def ways_to_hold(self, condition: Condition) -> Tuple[Tuple[Tests, ...], ...]:
        """Guards of which one holds if and only if the condition does, or may; none for one that never does."""
        found = (possibly(clauses, self.domains) for clauses in _alternatives(condition, self.domains))
        return tuple(self.tests(clauses) for clauses in found if clauses != NEVER)

    def _for(self, agent: str, clauses: Clauses) -> Clauses:
        """What has to hold for the agent: what it knows, or what may be so."""
        return clauses if agent in self._controlled else possibly(clauses, self.domains)

    def _guard(self, clauses: Clauses, agent: str, where: Value) -> Optional[Tuple[Tests, ...]]:
        rest = given(clauses, agent, where)
        return None if rest is None else self.tests(rest)

    def tests(self, clauses: Clauses) -> Tuple[Tests, ...]:
        """Clauses as the guards of edges have them. What never holds is an empty clause."""
        return tuple(self._test(clause) for clause in clauses)

    def variables(self) -> Tuple[Tuple[str, int], ...]:
        """The variables that say what agents are busy with, in the order of the agents."""
        return tuple((names.busy_with(agent), 0) for agent in self._work)

    def begins(self, agent: str, event: str, poi: str) -> Tuple[Tuple[str, int], ...]:
        """What is set when the agent begins to be busy with an event at a POI."""
        number = self._work.get(agent, {}).get(Value("doing", poi, event))
        return () if number is None else ((names.busy_with(agent), number),)

    def ends(self, agent: str) -> Tuple[Tuple[str, int], ...]:
        """What is set when it no longer is."""
        return ((names.busy_with(agent), 0),) if agent in self._work else ()

    def _numbers(self, scenario: Scenario) -> List[Tuple[str, Mapping[Value, int]]]:
        wanted: Dict[str, FrozenSet[str]] = {}
        for condition, _ in scenario.conditions():
            for atom in atoms(condition):
                if isinstance(atom, Doing):
                    for name in self.domains.literals(atom):
                        wanted[name] = wanted.get(name, frozenset()) | {atom.event.name}
        found: List[Tuple[str, Mapping[Value, int]]] = []
        for agent in scenario.agents:
            events = wanted.get(agent.name, frozenset())
            work = [value for value in sorted(self.domains.of(agent.name)) if value.is_work]
            if any(one.where == two.where and one.what in events and one != two for one in work for two in work):
                found.append((agent.name, {value: number for number, value in enumerate(work, start=1)}))
        return found

    def _test(self, clause: Clause) -> Tests:
        return tuple(test for variable, values in clause.items() for test in self._tests_of(variable, values))

    def _tests_of(self, variable: str, values: FrozenSet[Value]) -> List[Test]:
        if variable in self._states:
            return [Test(names.state_value(variable), _NUMBERS[value]) for value in sorted(values)]
        if variable in self.domains.loads:
            load = names.load(self.domains.loads[variable].agent.name)
            return [Test(load, int(value.where)) for value in sorted(values)]
        domain, position = self.domains.of(variable), names.agent_position(variable)
        tests: Dict[Test, None] = {}
        for value in sorted(values):
            alike = {other for other in domain if other[:2] == value[:2]} if value.is_work else {value}
            if alike <= values:
                tests[Test(position, self._code(value))] = None
            else:
                tests[Test(names.busy_with(variable), self._work[variable][value])] = None
        return list(tests)

    def _code(self, value: Value) -> int:
        if value == UNKNOWN:
            return names.NOWHERE
        if value.is_way:
            return self._positions.going(value.where, value.what)
        return self._positions.doing(value.where) if value.is_work else self._positions.at(value.where)


def _alternatives(condition: Condition, domains: Domains) -> Iterator[Clauses]:
    """The parts of a disjunction, else the condition alone: guards of parts are smaller than that of the whole."""
    negated = condition.part if isinstance(condition, Not) else None
    if isinstance(condition, AnyOf):
        yield from (clauses_of(part, domains) for part in condition.parts)
    elif isinstance(negated, AllOf):
        for part in negated.parts:
            yield from _crowded(part, domains) if isinstance(part, AtMostOf) else [clauses_of(part, domains, False)]
    elif isinstance(negated, AtMostOf):
        for some in combinations(domains.counted(negated).items(), negated.most + 1):
            yield simplified([{name: values} for name, values in some], domains)
    else:
        yield clauses_of(condition, domains)


def _crowded(room: AtMostOf, domains: Domains) -> Iterator[Clauses]:
    """The ways in which more are in one of many rooms than it holds. Where it holds one: somebody, and one of those
    behind, as that takes the fewest edges, which an observer looks at after every event."""
    counted = list(domains.counted(room).items())
    if room.most != 1:
        yield from _alternatives(Not(room), domains)
        return
    for k, (name, values) in enumerate(counted[:-1], start=1):
        yield simplified([{name: values}, dict(counted[k:])], domains)


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
