"""Conditions in conjunctive normal form, over what each agent may be at and each state may be.

A variable is an agent, whose values are its positions, a state, or the load of an agent. A clause holds if for one of
its variables the value is among those that the clause lists. Positions of different agents are taken to be independent
of each other.
"""

from __future__ import annotations

from itertools import combinations, product
from math import comb
from typing import Callable, Dict, FrozenSet, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Tuple

from pursue_gen.language.behaviour import places_of
from pursue_gen.language.conditions import (
    AllOf,
    AnyOf,
    At,
    AtMostOf,
    Atom,
    Condition,
    Doing,
    Has,
    Holds,
    Not,
    OnWay,
    Who,
    names_in,
)
from pursue_gen.language.loads import Carrier, carriers
from pursue_gen.language.scenario import Agent, Event, Scenario
from pursue_gen.language.symbols import Role

MOST_CLAUSES = 200
"""A condition with more of them is refused: guards would be as long, and nobody could read them."""


class Value(NamedTuple):
    """What a variable may be: ("at", POI, ""), ("doing", POI, event), ("way", from, to), ("is", "true", ""),
    ("load", its number, "")."""

    kind: str
    where: str
    what: str = ""

    @property
    def is_work(self) -> bool:
        """True for an agent that is busy."""
        return self.kind == "doing"

    @property
    def is_way(self) -> bool:
        """True for an agent that is between two places."""
        return self.kind == "way"

    @property
    def ahead(self) -> Value:
        """What becomes of it without anything new: who is on the way arrives, who is busy ends."""
        if self.is_way:
            return Value("at", self.what)
        return Value("at", self.where) if self.is_work else self


TRUE, FALSE = Value("is", "true"), Value("is", "false")
UNKNOWN = Value("is", "unknown")
"""A state is one of the two, and nobody knows which: no clause lists this value but those of what may be so."""

Values = FrozenSet[Value]
Clause = Mapping[str, Values]
"""From a variable, an agent's or a state's name, to the values with which the clause holds."""

Clauses = Tuple[Clause, ...]
NEVER: Clauses = ({},)
"""What never holds; no clause at all always holds."""


class TooMany(Exception):
    """A condition has more than MOST_CLAUSES clauses."""


class Domains:
    """The values that the variables of a scenario may have."""

    def __init__(self, scenario: Scenario) -> None:
        self._agents = {agent.name: agent for agent in scenario.agents}
        self._states = frozenset(state.name for state in scenario.states)
        self.unknown = tuple(state.name for state in scenario.states if state.is_found_out)
        """The states that are not known at first."""
        self.somewhere = frozenset(agent.name for agent in scenario.agents if agent.is_somewhere)
        """The agents of whom it is not known at first where they start."""
        self._events = {event.name: event for event in scenario.events}
        self._scenario, self._places = scenario, places_of(scenario)
        self._found: Dict[str, Values] = {}
        self.loads: Dict[str, Carrier] = {Role.LOAD(one.agent.name): one for one in carriers(scenario)}
        """The variables of loads, and whose they are."""

    def of(self, variable: str) -> Values:
        """All values of an agent or a state; the empty set for a name that is neither."""
        if variable not in self._found:
            self._found[variable] = frozenset(self._values(variable))
        return self._found[variable]

    def ever(self, variable: str) -> Values:
        """The same, and that it is not known, where that may be."""
        known = variable not in self.unknown and variable not in self.somewhere
        return self.of(variable) if known else self.of(variable) | {UNKNOWN}

    def among(self, who: Who) -> Tuple[str, ...]:
        """The agents that are meant, in the order of their declaration."""
        if who.agent is not None:
            return (who.agent.name,)
        return tuple(name for name, agent in self._agents.items() if agent.is_robot or not who.robots)

    def literals(self, atom: Atom) -> Dict[str, Values]:
        """With which values an atom holds: one of these variables has one of its values. No empty sets."""
        if isinstance(atom, Holds):
            values = self.of(atom.state.name) & {TRUE if atom.value else FALSE}
            return {atom.state.name: values} if values else {}
        found = {}
        if isinstance(atom, Has):
            return dict(self._with(atom))
        for name in self.among(atom.who):
            values = frozenset(value for value in self.of(name) if _is(value, atom))
            if values:
                found[name] = values
        return found

    def _with(self, atom: Has) -> Iterator[Tuple[str, Values]]:
        """The variables of loads, and the loads of which the thing is a part."""
        for variable in map(Role.LOAD, self.among(atom.who)):
            carrier, thing = self.loads.get(variable), atom.thing.name
            if carrier is not None and thing in carrier.names:
                at = carrier.names.index(thing)
                numbers = (number for number, load in enumerate(carrier.loads) if load[at])
                yield variable, frozenset(Value("load", str(number)) for number in numbers)

    def counted(self, condition: AtMostOf) -> Dict[str, Values]:
        """Who is counted, with the values with which it is. No empty sets."""
        found: Dict[str, Values] = {}
        for atom in condition.parts:
            for name, values in self.literals(atom).items():
                found[name] = found.get(name, frozenset()) | values
        return found

    def _values(self, variable: str) -> Iterable[Value]:
        if variable in self._states:
            return (TRUE, FALSE)
        if variable in self.loads:
            return (Value("load", str(number)) for number in range(len(self.loads[variable].loads)))
        agent = self._agents.get(variable)
        if agent is None:
            return ()
        places = self._places[variable]
        found = [Value("at", poi) for poi in places]
        if agent.mobile is not None:
            ways = (way for one in self._scenario.ways_of(variable) for way in one.directions)
            found += [Value("way", a, b) for a, b in ways if a in places]
        for event in self._lasting(agent):
            at = places if event.location is None else places & {event.location.name}
            found += [Value("doing", poi, event.name) for poi in at]
        return found

    def _lasting(self, agent: Agent) -> List[Event]:
        """The events with which the agent may be busy."""
        able = [self._events[ref.name] for ref in agent.can_do if ref.name in self._events]
        able += [self._events[ref.name] for ref in agent.reacts_to if ref.name in self._events]
        doing = {ref.name for ref in agent.can_do}
        return [event for event in able if event.duration is not None and (event.name in doing or event.is_shared)]


def _is(value: Value, atom: Atom) -> bool:
    """Does an atom about an agent hold with this value?"""
    if isinstance(atom, At):
        return not value.is_way and value.where == atom.place.name
    if isinstance(atom, OnWay):
        return value.is_way and atom.includes(value.where, value.what)
    return isinstance(atom, Doing) and value.is_work and value.what == atom.event.name


def clauses_of(condition: Condition, domains: Domains, value: bool = True) -> Clauses:
    """The clauses of a condition, or with `value` False of its negation. Raises TooMany.

    Exact: no clause at all if and only if it always holds. That it never holds is seen in its negation.
    """
    if isinstance(condition, Not):
        return clauses_of(condition.part, domains, not value)
    if isinstance(condition, (AllOf, AnyOf)):
        parts = [clauses_of(part, domains, value) for part in condition.parts]
        return all_of(parts, domains) if isinstance(condition, AllOf) is value else any_of(parts, domains)
    if isinstance(condition, AtMostOf):
        counted = domains.counted(condition)
        size = condition.most + 1 if value else len(counted) - condition.most
        if size <= 0:
            return NEVER
        if comb(len(counted), size) > MOST_CLAUSES:
            raise TooMany
        some = combinations(counted.items(), size)
        return simplified([{n: v if not value else domains.of(n) - v for n, v in one} for one in some], domains)
    literals = domains.literals(condition)
    if value:
        return simplified([literals], domains)
    return simplified([{name: domains.of(name) - values} for name, values in literals.items()], domains)


def all_of(parts: Iterable[Clauses], domains: Domains) -> Clauses:
    """The clauses of a conjunction. Raises TooMany."""
    return simplified([clause for part in parts for clause in part], domains)


def any_of(parts: Iterable[Clauses], domains: Domains) -> Clauses:
    """The clauses of a disjunction. Raises TooMany."""
    found: Clauses = NEVER
    for part in parts:
        if len(found) * len(part) > MOST_CLAUSES * MOST_CLAUSES:
            raise TooMany
        found = simplified([_either(one, other) for one, other in product(found, part)], domains)
    return found


def possibly(clauses: Clauses, domains: Domains) -> Clauses:
    """Clauses for what may hold, as far as it is known: for some values of the states that are not known. Exact, as two
    clauses that a state cannot both satisfy leave what the rest of one of them says. Raises TooMany."""
    found = list(clauses)
    for name in domains.unknown:
        with_true, with_false = ([c for c in found if c.get(name) == frozenset((v,))] for v in (TRUE, FALSE))
        for pair in product(with_true, with_false):
            rest = _either(*pair)
            found.append({other: values for other, values in rest.items() if other != name})
    found = list(simplified(found, domains))
    return tuple(
        {name: values | {UNKNOWN} if name in domains.unknown else values for name, values in clause.items()}
        for clause in found
    )


def unless_placed(clauses: Clauses, domains: Domains) -> Clauses:
    """Clauses that hold, too, where it is not known yet where one of their agents starts."""
    return tuple(
        {name: values | {UNKNOWN} if name in domains.somewhere else values for name, values in clause.items()}
        for clause in clauses
    )


def given(clauses: Clauses, variable: str, value: Value) -> Optional[Clauses]:
    """What remains to be required where the variable is known to have the value; None: it cannot hold."""
    kept = []
    for clause in clauses:
        if value in clause.get(variable, ()):
            continue
        rest = {name: values for name, values in clause.items() if name != variable}
        if not rest:
            return None
        kept.append(rest)
    return tuple(kept)


def holds_at_start(
    condition: Condition, scenario: Scenario, domains: Domains, whatever: Callable[[Iterable[object]], bool] = all
) -> bool:
    """True if a condition holds before anything has happened, whatever states are that are not known, and wherever
    agents start; with `any` if it may hold."""
    first = {agent.name: Value("at", agent.location.name) for agent in scenario.agents}
    first.update({state.name: TRUE if state.initially else FALSE for state in scenario.states})
    loads = domains.loads.items()
    first.update({variable: Value("load", str(one.loads.index(one.first))) for variable, one in loads})
    unknown = [name for _, ref in names_in(condition) for name in domains.unknown if name == ref.name]
    names = tuple(dict.fromkeys(unknown))
    some = product((TRUE, FALSE), repeat=len(names))
    placed = _placed(scenario)
    return whatever(
        _holds(condition, {**first, **there, **dict(zip(names, values))}, domains)
        for values in some
        for there in placed
    )


def _placed(scenario: Scenario) -> List[Dict[str, Value]]:
    """For each way in which agents may start that start somewhere where each of them is."""
    agents = [agent for agent in scenario.agents if agent.is_somewhere]
    places = product(*([Value("at", ref.name) for ref in agent.starts] for agent in agents))
    return [{agent.name: value for agent, value in zip(agents, some)} for some in places]


def _holds(condition: Condition, now: Mapping[str, Value], domains: Domains) -> bool:
    """True if a condition holds where all variables have these values."""
    if isinstance(condition, Not):
        return not _holds(condition.part, now, domains)
    if isinstance(condition, (AllOf, AnyOf)):
        parts = (_holds(part, now, domains) for part in condition.parts)
        return all(parts) if isinstance(condition, AllOf) else any(parts)
    if isinstance(condition, AtMostOf):
        return sum(now[name] in values for name, values in domains.counted(condition).items()) <= condition.most
    return any(now[name] in values for name, values in domains.literals(condition).items())


def _either(one: Clause, other: Clause) -> Clause:
    return {name: one.get(name, frozenset()) | other.get(name, frozenset()) for name in (*one, *other)}


def simplified(clauses: Iterable[Clause], domains: Domains) -> Clauses:
    """The same without clauses that always hold or follow from another one. Raises TooMany."""
    alone: Dict[str, Values] = {}  # what single variables have to be
    several: List[Clause] = []
    for clause in clauses:
        kept = {name: values for name, values in clause.items() if values}
        if any(values >= domains.of(name) for name, values in kept.items()):
            continue
        if not kept:
            return NEVER
        if len(kept) == 1:
            ((name, values),) = kept.items()
            alone[name] = alone.get(name, values) & values
        elif kept not in several:
            several.append(kept)
    if not all(alone.values()):
        return NEVER
    found: List[Clause] = [{name: values} for name, values in alone.items()]
    found += several
    found = [clause for k, clause in enumerate(found) if not _follows(clause, k, found)]
    if len(found) > MOST_CLAUSES:
        raise TooMany
    return tuple(found)


def _follows(clause: Clause, number: int, others: List[Clause]) -> bool:
    """Does the clause of that number follow from one of the others? Of two that are the same the first stays."""
    return any(
        all(name in clause and values <= clause[name] for name, values in other.items())
        for k, other in enumerate(others)
        if k < number or (k > number and other != clause)
    )
