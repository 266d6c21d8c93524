"""Assumptions: what the automata of agents that are not controlled leave out.

Each assumption has a variable that is 1 and that no edge sets. While it is 1, guards keep the agent to what is assumed.
A mission in which an assumption has been broken goes on with 0 in it, and plans from there do not rely on it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Type

from pursue_gen.language import network_names as names
from pursue_gen.language.clauses import Clauses, clauses_of
from pursue_gen.language.numbers import exact
from pursue_gen.language.scenario import Assumption, AtMost, Leaves, NeverAt, NeverHolds, NotBefore, Scenario, Waits
from pursue_gen.language.symbols import Role
from pursue_gen.tga.agents import PAUSE
from pursue_gen.tga.changes import Change, beginning, setting_off, states_set
from pursue_gen.tga.conditions import Conditions
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Location, Test


def assumed(automaton: Automaton, scenario: Scenario, conditions: Conditions) -> Automaton:
    """The automaton of an agent, kept to what the scenario assumes of it."""
    agents = [agent for agent in scenario.agents if agent.name == automaton.name]
    for number, assumption in enumerate(scenario.assumptions, start=1):
        if any(map(assumption.binds, agents)):
            automaton = _KEPT[type(assumption)](automaton, number, assumption, scenario, conditions)
    return automaton


def assumption_variables(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """The variables of the assumptions with their first values."""
    found: List[Tuple[str, int]] = []
    for number, assumption in enumerate(scenario.assumptions, start=1):
        found.append((names.assumption(number), 1))
        if assumption.counts:
            found.append((names.assumption_count(number), 0))
    return tuple(found)


def assumption_clocks(scenario: Scenario) -> Tuple[str, ...]:
    """The clocks of the assumptions about times."""
    numbered = enumerate(scenario.assumptions, start=1)
    return tuple(names.assumption_clock(number) for number, assumption in numbered if assumption.since)


def without_broken(automaton: Automaton, values: Mapping[str, int]) -> Automaton:
    """The automaton without the invariants of assumptions whose variables are 0 among these values."""
    broken = {
        names.assumption_clock(number)
        for number in range(1, len(values) + 1)
        if values.get(names.assumption(number)) == 0
    }
    if not broken:
        return automaton

    def free(location: Location) -> Location:
        return replace(location, invariant=tuple(bound for bound in location.invariant if bound.clock not in broken))

    return replace(automaton, locations=tuple(free(location) for location in automaton.locations))


def _never_holds(
    automaton: Automaton, number: int, assumption: NeverHolds, scenario: Scenario, conditions: Conditions
) -> Automaton:
    """Nothing begins with which the condition could hold, now or when what is under way ends.

    Nobody can be kept from arriving. So whoever is on a way counts as if it were there already, too, and who is busy as
    if it were not any more: the clauses that say that the condition does not hold are about values that stay so.
    """
    domains, name = conditions.domains, automaton.name
    safe: Clauses = tuple(
        {who: frozenset(value for value in values if value.ahead in values) for who, values in clause.items()}
        for clause in clauses_of(assumption.condition, domains, False)
    )
    directions = (way for connection in scenario.connections for way in connection.directions)
    ways: Dict[str, Change] = {names.going(*way): setting_off(name, *way) for way in directions}
    works: Dict[str, Change] = {
        names.doing(value.what, value.where): beginning(name, value.what, value.where, scenario, domains)
        for value in domains.of(name)
        if value.is_work
    }

    def edges(edge: Edge) -> List[Edge]:
        if edge.sync is None or not edge.sync.sends or edge.is_end:
            return [edge]
        change = Change(states_set(edge.sync.channel, scenario))
        if edge.source != edge.target:
            change = ways.get(edge.target) or works.get(edge.target) or change
        changed = {who for who, _ in change.becomes}
        touched = tuple(clause for clause in safe if changed.intersection(clause))
        if not touched:
            return [edge]
        guard = change.guard([change.before(touched, domains)], domains)
        kept = [] if guard is None else [_where(edge, conditions.tests(guard))]
        return [*kept, _when_broken(edge, number)] if guard != () else [edge]

    return _each(automaton, edges)


def _where(edge: Edge, tests: Tuple[Clause, ...]) -> Edge:
    """The edge with these tests."""
    return replace(edge, guard=replace(edge.guard, integers=(*edge.guard.integers, *tests)))


def _at_most(automaton: Automaton, number: int, assumption: AtMost, *_: object) -> Automaton:
    """Each time is counted; there is no edge for one time more."""
    count = names.assumption_count(number)

    def edges(edge: Edge) -> List[Edge]:
        if not _sends(edge, assumption.event.name):
            return [edge]
        counted = [_with(edge, (Test(count, k),), assign=(count, k + 1)) for k in range(assumption.times)]
        return [*counted, _when_broken(edge, number)]

    return _each(automaton, edges)


def _not_before(automaton: Automaton, number: int, assumption: NotBefore, *_: object) -> Automaton:
    """A clock that nothing resets has to be past the time."""
    late = ClockBound(names.assumption_clock(number), ">", assumption.time)

    def edges(edge: Edge) -> List[Edge]:
        return [_with(edge, bound=late), _when_broken(edge, number)] if _sends(edge, assumption.event.name) else [edge]

    return _each(automaton, edges)


def _waits(automaton: Automaton, number: int, assumption: Waits, *_: object) -> Automaton:
    """The first time is free; a clock runs from the end of each one to the next."""
    count, clock, event = names.assumption_count(number), names.assumption_clock(number), assumption.event.name
    lasts = any(_sends(edge, names.done(event)) for edge in automaton.edges)

    def edges(edge: Edge) -> List[Edge]:
        if _sends(edge, names.done(event)):
            return [_with(edge, reset=clock)]
        if not _sends(edge, event):
            return [edge]
        reset = "" if lasts else clock
        again = _with(edge, (Test(count, 1),), bound=ClockBound(clock, ">=", assumption.time), reset=reset)
        first = _with(edge, (Test(count, 0),), assign=(count, 1), reset=reset)
        return [first, again, _with(_when_broken(edge, number), reset=reset)]

    return _each(automaton, edges)


def _leaves(automaton: Automaton, number: int, assumption: Leaves, *_: object) -> Automaton:
    """An invariant where it stands; what it does there begins only where it can set off in time afterwards."""
    place, clock, most = assumption.place.name, names.assumption_clock(number), assumption.time
    takes = {location.name: max((b.bound for b in location.invariant), default=0) for location in automaton.locations}
    here = ClockBound(clock, "<=", most)
    locations = tuple(
        replace(location, invariant=(*location.invariant, here)) if location.name == place else location
        for location in automaton.locations
    )

    def edges(edge: Edge) -> List[Edge]:
        if edge.target == place and edge.leaves is Role.WAY:
            return [_with(edge, reset=clock)]
        if edge.sync is not None and not edge.sync.sends:
            # Whoever takes part in what another agent does is kept until that ends; its time begins anew then.
            return [_with(edge, reset=clock)] if edge.target == place else [edge]
        if edge.source != place or edge.enters is Role.WAY:
            return [edge]
        lasts = 0 if edge.target == place else takes[edge.target]
        in_time = _with(edge, bound=ClockBound(clock, "<", exact(most - PAUSE - lasts)))
        return [in_time, _when_broken(edge, number)]

    return _each(replace(automaton, locations=locations), edges)


def _never_at(automaton: Automaton, number: int, assumption: NeverAt, *_: object) -> Automaton:
    place = assumption.place.name
    ways = {edge.source for edge in automaton.edges if edge.target == place and edge.leaves is Role.WAY}
    return _each(automaton, lambda edge: [_when_broken(edge, number) if edge.target in ways else edge])


def _each(automaton: Automaton, edges: Callable[[Edge], List[Edge]]) -> Automaton:
    """The automaton with these edges in the place of each one."""
    return replace(automaton, edges=tuple(new for edge in automaton.edges for new in edges(edge)))


def _sends(edge: Edge, channel: str) -> bool:
    return edge.sync is not None and edge.sync.sends and edge.sync.channel == channel


def _when_broken(edge: Edge, number: int) -> Edge:
    """The edge for a mission in which the assumption has been broken."""
    return _with(edge, (Test(names.assumption(number), 0),))


def _with(
    edge: Edge,
    clause: Clause = (),
    bound: Optional[ClockBound] = None,
    assign: Optional[Tuple[str, int]] = None,
    reset: str = "",
) -> Edge:
    """The edge with one more test, bound, assignment or reset."""
    guard = edge.guard
    guard = replace(guard, integers=(*guard.integers, clause)) if clause else guard
    guard = replace(guard, clocks=(*guard.clocks, bound)) if bound else guard
    return replace(
        edge,
        guard=guard,
        assign=(*edge.assign, assign) if assign else edge.assign,
        resets=(*edge.resets, reset) if reset else edge.resets,
    )


_KEPT: Mapping[Type[Assumption], Callable[[Automaton, int, Any, Scenario, Conditions], Automaton]] = {
    AtMost: _at_most,
    NotBefore: _not_before,
    Waits: _waits,
    Leaves: _leaves,
    NeverAt: _never_at,
    NeverHolds: _never_holds,
}
"""By the kind of an assumption, with its number, the automaton of an agent that keeps to it."""
