"""Assumptions: what the automata of agents that are not controlled leave out.

Each assumption has a variable that is 1 and that no edge sets. While it is 1, guards keep the agent to what is assumed.
A mission in which an assumption has been broken goes on with 0 in it, and plans from there do not rely on it.

`assume: mechanic reaches m1 within 180 after call1`: invariants of the agent's own locations would hold at all times.
So an automaton of its own goes along with the agent from the event on until it is there, and has the invariants by
which it sets off in time. As who is at a bound has to move by itself, that automaton can send the agent on its way
there: at the last moment, as the agent could itself.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Callable, Dict, Iterator, List, Mapping, Tuple, Type, Union

from pursue_gen.language import network_names as names
from pursue_gen.language.assumption_checks import open_ways
from pursue_gen.language.assumptions.base import SHORTEST_STAY
from pursue_gen.language.assumptions.reaches import reaches_in
from pursue_gen.language.clauses import Clauses, clauses_of
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.scenario import (
    Agent,
    Assumption,
    AtMost,
    Departure,
    Every,
    InAll,
    Leaves,
    MostOpen,
    NeverAt,
    NeverHolds,
    NotBefore,
    Reaches,
    Scenario,
    Stays,
    ThereBy,
    Waits,
)
from pursue_gen.language.symbols import UNDER_WAY, Role, Symbol, role_of
from pursue_gen.tga.conditions import Change, Conditions, beginning, setting_off, states_set
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.positions import Positions
from pursue_gen.tga.requests import fewer_open


def assumed(automaton: Automaton, scenario: Scenario, conditions: Conditions) -> Automaton:
    """The automaton of an agent, kept to what the scenario assumes of it."""
    agents = [agent for agent in scenario.agents if agent.name == automaton.name]
    for number, assumption in enumerate(scenario.assumed, start=1):
        if any(map(assumption.binds, agents)):
            automaton = _KEPT[type(assumption)](automaton, number, assumption, scenario, conditions)
    return automaton


def assumption_variables(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """The variables of the assumptions with their first values."""
    found: List[Tuple[str, int]] = []
    for number, assumption in enumerate(scenario.assumed, start=1):
        found.append((names.assumption(number), 1))
        if assumption.counts:
            found.append((names.assumption_count(number), 0))
    return tuple(found)


def assumption_clocks(scenario: Scenario) -> Tuple[str, ...]:
    """The clocks of the assumptions about times."""
    numbered = enumerate(scenario.assumed, start=1)
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

    return automaton.with_locations(free)


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
        if edge.sent is None or edge.is_end:
            return [edge]
        change = Change(states_set(edge.sent, scenario))
        if edge.source != edge.target:
            change = ways.get(edge.target) or works.get(edge.target) or change
        changed = {who for who, _ in change.becomes}
        touched = tuple(clause for clause in safe if changed.intersection(clause))
        if not touched:
            return [edge]
        guard = change.guard([change.before(touched, domains)], domains)
        kept = [] if guard is None else [edge.plus(*conditions.tests(guard))]
        return [*kept, _when_broken(edge, number)] if guard != () else [edge]

    return automaton.with_each(edges)


def _at_most(automaton: Automaton, number: int, assumption: Union[AtMost, InAll], *_: object) -> Automaton:
    """Each time is counted, of whichever event; there is no edge for one time more."""
    count, counted = names.assumption_count(number), {ref.name for kind, ref in assumption.names() if kind == "event"}

    def edges(edge: Edge) -> List[Edge]:
        if edge.sent not in counted:
            return [edge]
        times = [edge.plus((Test(count, k),), assign=((count, k + 1),)) for k in range(assumption.times)]
        return [*times, _when_broken(edge, number)]

    return automaton.with_each(edges)


def _most_open(automaton: Automaton, number: int, assumption: MostOpen, scenario: Scenario, *_: object) -> Automaton:
    """There is no edge for one more than may be open."""
    fewer = fewer_open(assumption, scenario)

    def edges(edge: Edge) -> List[Edge]:
        return [edge.plus(fewer), _when_broken(edge, number)] if edge.sent == assumption.event.name else [edge]

    return automaton.with_each(edges)


def _not_before(automaton: Automaton, number: int, assumption: NotBefore, *_: object) -> Automaton:
    """A clock that nothing resets has to be past the time."""
    late = ClockBound(names.assumption_clock(number), ">", exact(assumption.time))

    def edges(edge: Edge) -> List[Edge]:
        return [edge.plus(bounds=(late,)), _when_broken(edge, number)] if edge.sent == assumption.event.name else [edge]

    return automaton.with_each(edges)


def _waits(automaton: Automaton, number: int, assumption: Waits, scenario: Scenario, *_: object) -> Automaton:
    """The first time is free; a clock runs from the end of each one to the next. What is left off has not ended."""
    count, clock = names.assumption_count(number), names.assumption_clock(number)
    first, following = assumption.event.name, assumption.following.name
    lasts = any(edge.sent == names.done(first) for edge in automaton.edges)
    may_be_left = any(names.leaves_off(event) for event in scenario.events if event.name == first)

    def edges(edge: Edge) -> List[Edge]:
        if edge.sent == names.done(first):
            return [edge.plus(resets=(clock,), assign=((count, 1),) if may_be_left else ())]
        if edge.sent not in (first, following):
            return [edge]
        begun = edge.plus(resets=(clock,)) if edge.sent == first and not lasts else edge
        counted = ((count, 1),) if edge.sent == first and not may_be_left else ()
        if edge.sent != following:
            return [begun.plus(assign=counted)]
        again = begun.plus((Test(count, 1),), bounds=(ClockBound(clock, ">=", exact(assumption.time)),))
        return [begun.plus((Test(count, 0),), assign=counted), again, _when_broken(begun, number)]

    return automaton.with_each(edges)


def _every(automaton: Automaton, number: int, assumption: Every, scenario: Scenario, *_: object) -> Automaton:
    """An invariant everywhere; what else it does begins only where it can do the event in time afterwards."""
    clock = names.assumption_clock(number)
    latest, earliest = ClockBound(clock, "<=", exact(assumption.most)), ClockBound(clock, ">=", exact(assumption.least))
    pois = {each.name for each in automaton.locations if role_of(each.name) is Role.AT}

    def edges(edge: Edge) -> List[Edge]:
        if edge.sent == assumption.event.name:
            again = edge.plus(resets=(clock,))
            return [again.plus(bounds=(earliest,)), _when_broken(again, number)]
        if edge.is_end:
            return [edge]
        lasts = 0 if edge.target in pois else automaton.longest.get(edge.target, 0)
        in_time = edge.plus(bounds=(ClockBound(clock, "<", exact(assumption.most - scenario.rest - lasts)),))
        return [in_time, _when_broken(edge, number)]

    bounded = automaton.with_locations(lambda location: replace(location, invariant=(*location.invariant, latest)))
    return bounded.with_each(edges)


def _departs(automaton: Automaton, number: int, assumption: Departure, scenario: Scenario, *_: object) -> Automaton:
    """An invariant where it stands; what it does there begins only where it can set off in time afterwards."""
    clock, (least, most) = names.assumption_clock(number), assumption.window
    latest, earliest = ClockBound(clock, "<=", exact(most)), ClockBound(clock, ">=", exact(least))
    pois = {each.name for each in automaton.locations if role_of(each.name) is Role.AT}
    places = {assumption.only_at} if assumption.only_at else pois

    def bounded(location: Location) -> Location:
        return replace(location, invariant=(*location.invariant, latest)) if location.name in places else location

    def edges(edge: Edge) -> List[Edge]:
        if edge.target in places and edge.leaves in (Role.WAY, Role.SOMEWHERE):
            return [edge.plus(resets=(clock,))]
        if edge.received is not None:
            # Whoever takes part in what another agent does is kept until that ends; its time begins anew then.
            return [edge.plus(resets=(clock,))] if edge.target in places else [edge]
        if edge.source not in places:
            return [edge]
        if edge.enters is Role.WAY:
            return [edge.plus(bounds=(earliest,)), _when_broken(edge, number)] if least > scenario.rest else [edge]
        lasts = 0 if edge.target in places else automaton.longest.get(edge.target, 0)
        in_time = edge.plus(bounds=(ClockBound(clock, "<", exact(most - scenario.rest - lasts)),))
        return [in_time, _when_broken(edge, number)]

    return automaton.with_locations(bounded).with_each(edges)


def _there_by(automaton: Automaton, number: int, assumption: ThereBy, scenario: Scenario, *_: object) -> Automaton:
    """An invariant at each other place; it begins only that from which it gets there in time afterwards."""
    clock, place = names.assumption_clock(number), assumption.place.name
    agent = next(each for each in scenario.agents if each.name == automaton.name)
    latest = assumption.latest(open_ways(scenario, agent), SHORTEST_STAY * scenario.rest)
    ends = {edge.source: edge.target for edge in automaton.edges if edge.leaves in UNDER_WAY and edge.is_end}

    def bounded(location: Location) -> Location:
        if location.name not in latest:
            return location
        return replace(location, invariant=(*location.invariant, ClockBound(clock, "<=", latest[location.name])))

    def edges(edge: Edge) -> List[Edge]:
        end = ends.get(edge.target, edge.target)
        if edge.source in ends or edge.received is not None or edge.source == end == place:
            return [edge]
        if end != place and end not in latest:
            return [_when_broken(edge, number)]
        moment = assumption.time if end == place else latest[end] - SHORTEST_STAY * scenario.rest
        in_time = ClockBound(clock, "<=", exact(moment - automaton.longest.get(edge.target, 0)))
        return [edge.plus(bounds=(in_time,)), _when_broken(edge, number)]

    return automaton.with_locations(bounded).with_each(edges)


def _reaches(automaton: Automaton, number: int, assumption: Reaches, scenario: Scenario, *_: object) -> Automaton:
    """While it is awaited it begins only that from which it gets there in time afterwards; that it sets off in time
    follows from the automaton of its way."""
    count, clock, place = names.assumption_count(number), names.assumption_clock(number), assumption.place.name
    latest, last = latest_of(assumption, scenario), frozenset(last_ways(assumption, scenario))
    ends = {edge.source: edge.target for edge in automaton.edges if edge.leaves in UNDER_WAY and edge.is_end}

    def edges(edge: Edge) -> List[Edge]:
        end = ends.get(edge.target, edge.target)
        if edge.source in ends or edge.received is not None or edge.source == end == place:
            return [edge]
        free = edge.plus((Test(count, 0),))
        if end != place and end not in latest:
            return [free, _when_broken(edge, number)]
        stay = SHORTEST_STAY * scenario.rest
        moment = assumption.in_time(end, automaton.longest.get(edge.target, 0), latest, stay)
        in_time = edge.plus((Test(count, 1),), bounds=(ClockBound(clock, "<=", moment),))
        sent = [_sent(edge, count)] if (edge.source, end) in last and edge.enters is Role.WAY else []
        return [free, in_time, _when_broken(edge, number), *sent]

    return automaton.with_each(edges)


def _sent(edge: Edge, count: str) -> Edge:
    """An edge on which the automaton of its way sends the agent, which is awaited."""
    assert edge.sync is not None
    guard = Guard(integers=((Test(count, 1),),))
    return replace(edge, guard=guard, sync=replace(edge.sync, sends=False))


def _never_at(automaton: Automaton, number: int, assumption: NeverAt, *_: object) -> Automaton:
    place = assumption.place.name
    ways = {edge.source for edge in automaton.edges if edge.target == place and edge.leaves is Role.WAY}
    return automaton.with_each(lambda edge: [_when_broken(edge, number) if edge.target in ways else edge])


def _when_broken(edge: Edge, number: int) -> Edge:
    """The edge for a mission in which the assumption has been broken."""
    return edge.plus((Test(names.assumption(number), 0),))


_KEPT: Mapping[Type[Assumption], Callable[[Automaton, int, Any, Scenario, Conditions], Automaton]] = {
    AtMost: _at_most,
    InAll: _at_most,
    NotBefore: _not_before,
    Waits: _waits,
    Every: _every,
    Leaves: _departs,
    Stays: _departs,
    Reaches: _reaches,
    ThereBy: _there_by,
    NeverAt: _never_at,
    NeverHolds: _never_holds,
    MostOpen: _most_open,
}
"""By the kind of an assumption, with its number, the automaton of an agent that keeps to it."""


def ways_awaited(scenario: Scenario, codes: Positions) -> Iterator[Automaton]:
    """An automaton for each agent that is assumed to come somewhere after an event."""
    agents = {agent.name: agent for agent in scenario.agents}
    for number, assumption in reaches_in(scenario.assumptions):
        yield _way(agents[assumption.agent.name], number, assumption, scenario, codes)


def who_awaited(automaton: str, scenario: Scenario) -> str:
    """The agent along with whom an automaton goes; "" for other automata."""
    symbol = Symbol.of(automaton)
    return dict(reaches_in(scenario.assumed))[int(symbol.parts[0])].agent.name if symbol.role is Role.AWAITED else ""


def latest_of(assumption: Reaches, scenario: Scenario) -> Dict[str, Number]:
    """How long after the event its agent sets off at the latest from each other place."""
    agent = next(each for each in scenario.agents if each.name == assumption.agent.name)
    return assumption.latest(open_ways(scenario, agent), SHORTEST_STAY * scenario.rest)


def last_ways(assumption: Reaches, scenario: Scenario) -> Iterator[Tuple[str, str]]:
    """The ways that it can still take at the last moment, one from each place: the first on the way there."""
    agent = next(each for each in scenario.agents if each.name == assumption.agent.name)
    ways, latest, stay = open_ways(scenario, agent), latest_of(assumption, scenario), SHORTEST_STAY * scenario.rest
    for here, moment in latest.items():
        ends = (b for (a, b), most in ways.items() if a == here and assumption.in_time(b, most, latest, stay) == moment)
        yield here, next(ends)


def _way(agent: Agent, number: int, assumption: Reaches, scenario: Scenario, codes: Positions) -> Automaton:
    """Not awaited, on a way, or at one of the places from which it has to set off in time."""
    name, clock, count = names.assumed_way(number), names.assumption_clock(number), names.assumption_count(number)
    latest, place, position = latest_of(assumption, scenario), assumption.place.name, names.agent_position(agent.name)
    event = next(each for each in scenario.events if each.name == assumption.event.name)
    happens = Sync(names.has_happened(event), sends=False)
    nowhere, on_way, there = f"{name}_no", f"{name}_on", {poi: f"{name}_at_{poi}" for poi in latest}
    edges: List[Edge] = []

    def begins(target: str, *here: int) -> None:
        guard = Guard(integers=(tuple(Test(position, code) for code in here),))
        edges.append(Edge(nowhere, target, guard, happens, ((count, 1),), (clock,)))

    movements = tuple(scenario.movements(agent))
    for poi in latest:
        begins(there[poi], codes.at(poi), codes.doing(poi))
    if movements:
        begins(on_way, *(codes.going(a, b) for a, b in movements))
    for a, b in movements:
        if a in there:
            edges.append(Edge(there[a], on_way, sync=Sync(names.movement(agent.name, a, b), sends=False)))
    for a, b in last_ways(assumption, scenario):
        at_last = Guard((ClockBound(clock, ">=", latest[a]),))
        sends = Sync(names.movement(agent.name, a, b), sends=True)
        edges.append(Edge(there[a], on_way, at_last, sends, controllable=False))
    for a, b in movements:
        arrives = Sync(names.arrival(agent.name, a, b), sends=False)
        if b == place:
            edges.append(Edge(on_way, nowhere, sync=arrives, assign=((count, 0),)))
        elif b in there:
            edges.append(Edge(on_way, there[b], sync=arrives))
    stays = (Location(there[poi], (ClockBound(clock, "<=", moment),)) for poi, moment in latest.items())
    return Automaton(name, (Location(nowhere), Location(on_way), *stays), nowhere, tuple(edges))
