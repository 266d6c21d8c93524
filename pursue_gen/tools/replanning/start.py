"""The network of a game with the state of a mission as its initial state."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import permutations
from math import ceil
from typing import AbstractSet, Dict, Iterator, List, Mapping, Optional, Tuple, TypeVar

from pursue_gen.language.network_names import agent_clock, agent_position, going
from pursue_gen.tga.assumptions import without_broken
from pursue_gen.tga.network import Automaton, ClockBound, Constraint, Edge, Guard, Network, with_controllability
from pursue_gen.tga.scale import common_denominator, least_common_multiple
from pursue_gen.tools.replanning.out_of_service import without_commands
from pursue_gen.tools.replanning.request import Request, wrong

T = TypeVar("T")

_FINEST = 10
"""The grid of clock values has at least so many points in a time unit. Not measured."""


def network_from(network: Network, request: Request, told_apart: bool = False) -> Network:
    """The network in the state of the request, `ahead` time units later, without the moves that cannot be relied on.

    Whoever is excused gets no command where it is and ends what it does at any time or never; whoever is there longer
    than the model allows may stay, but who is awaited not for ever; who is turning may be back too early; nobody is
    sent along a blocked way, and nothing to robots out of service. `told_apart`: also clocks that are above all that
    the network compares them with. Raises PursueError (exit status 2) for a place that the network does not have.
    """
    locations, values, clocks = _place(network, request)
    agents = {*(agent.name for agent in request.scenario.agents), *request.scenario.facts}
    automata = []
    for automaton in network.automata:
        automaton = without_broken(automaton, values)
        here = locations[automaton.name]
        moved = replace(automaton, initial=here, home=automaton.home or automaton.initial)
        if automaton.name in request.excused:
            moved = _idle(_unbounded(moved, here), here, clocks)
        elif automaton.name in agents and passed_bounds(automaton, here, clocks):
            moved = _awaited(moved, here, clocks, request) or _unbounded(moved, here)
        if automaton.name in request.turning:
            moved = _idle(moved, here, clocks)
        automata.append(_without_ways(moved, request) if automaton.name in agents else moved)
    positions = (agent_position(name) for name in request.excused if _shares(network, name))
    absent = {(position, values[position]) for position in positions if position in values}
    automata = [_without_company(automaton, absent) for automaton in automata]
    serving = without_commands(automata, request.scenario, request.out_of_service)
    there = replace(network, automata=serving, variables=tuple(values.items()))
    reaction = request.rules.reaction
    grid = least_common_multiple((_FINEST, common_denominator([reaction, *there.times])))
    compared = {name: value + ceil(reaction) for name, value in there.largest.items()}  # commands take effect late
    beyond = {name: Fraction(value + 1) for name, value in (clocks if told_apart else compared).items()}
    start = around(_spread(region(clocks, beyond, grid), request.spread, grid), Fraction(0), request.window)
    return replace(there, start=(*start, *_within_invariants(there, clocks)) if request.window else start)


def _spread(
    start: Tuple[Constraint, ...], spread: Mapping[str, Mapping[str, Fraction]], grid: int
) -> Tuple[Constraint, ...]:
    """The clock values that differ from those of a region by what they may (see `Request`), rounded up to the grid: a
    game whose times have many digits is too large for a solver; no value is below 0."""
    found = []
    for each in start:
        one, other = (spread.get(clock or "", {}) for clock in (each.left, each.right))
        alone = {**{key: one[key] for key in one.keys() - other}, **{key: other[key] for key in other.keys() - one}}
        wider = replace(each, bound=each.bound + Fraction(ceil(sum(alone.values()) * grid), grid))
        below = alone and each.left is None and wider.bound >= 0
        found.append(Constraint(None, each.right, Fraction(0), False) if below else wider)
    return tuple(found)


def _within_invariants(network: Network, clocks: Mapping[str, Fraction]) -> Iterator[Constraint]:
    """That no clock is above the invariants that hold for these values in the initial locations: a plan that comes into
    force later does so before an event that is due."""
    for automaton in network.automata:
        for location in automaton.locations:
            if location.name == automaton.initial:
                for bound in location.invariant:
                    if _holds(bound, clocks):
                        yield Constraint(bound.clock, None, Fraction(bound.bound), bound.op == "<")


def start_clocks(network: Network, request: Request) -> Dict[str, Fraction]:
    """The clocks when the plan begins; the movements of those who turn round begin then. Raises PursueError."""
    starting = {agent_clock(agent) for agent in request.turning}
    clocks = {name: _known(request.clocks, name, "clock") for name in network.clocks}
    return {name: clock if name in starting else clock + request.ahead for name, clock in clocks.items()}


def passed_bounds(automaton: Automaton, here: str, clocks: Mapping[str, Fraction]) -> Tuple[ClockBound, ...]:
    """The bounds of the location that the clocks have passed."""
    bounds = next(location.invariant for location in automaton.locations if location.name == here)
    return tuple(bound for bound in bounds if not _holds(bound, clocks))


def region(clocks: Mapping[str, Fraction], beyond: Mapping[str, Fraction], grid: int) -> Tuple[Constraint, ...]:
    """The clock values that no bound on the grid (parts of a time unit) distinguishes from these; above `beyond`
    all are equal.

    Measured clocks are not exact, and who wins from one of these points wins from all of them.
    """
    constraints: List[Constraint] = []
    far = {name for name, value in clocks.items() if value > beyond[name]}
    for left, right in permutations((None, *clocks), 2):
        if left in far or (left is not None and right in far):
            continue
        if right in far:
            constraints.append(Constraint(None, right, -beyond[right or ""], True))
            continue
        difference = (clocks[left] if left else 0) - (clocks[right] if right else Fraction(0))
        top = Fraction(ceil(difference * grid), grid)
        constraints.append(Constraint(left, right, top, strict=difference < top))
    return tuple(constraints)


def around(start: Tuple[Constraint, ...], early: Fraction, late: Fraction) -> Tuple[Constraint, ...]:
    """The clock values that a region (`region`) comes from or goes to if only time passes: so many time units before
    it, so many after it; and perhaps others."""
    more = {True: early, False: late}
    return tuple(
        each if None not in (each.left, each.right) else replace(each, bound=each.bound + more[each.left is None])
        for each in start
    )


def _place(network: Network, request: Request) -> Tuple[Dict[str, str], Dict[str, int], Dict[str, Fraction]]:
    """Locations, values and clocks of everything in the network; other names in the request are ignored."""
    for automaton in network.automata:
        here = _known(request.locations, automaton.name, "location")
        names = [location.name for location in automaton.locations]
        if here not in names:
            raise wrong(f"{automaton.name} has no location {here}", f"one of {', '.join(names)}")
    locations = {automaton.name: request.locations[automaton.name] for automaton in network.automata}
    values = {name: _known(request.values, name, "value") for name, _ in network.variables}
    return locations, values, start_clocks(network, request)


def _known(table: Mapping[str, T], name: str, what: str) -> T:
    if name not in table:
        raise wrong(f"there is no {what} of {name}", "every automaton, variable and clock of model.yaml")
    return table[name]


def _unbounded(automaton: Automaton, here: str) -> Automaton:
    """It may stay where it is for ever."""
    locations = (replace(place, invariant=()) if place.name == here else place for place in automaton.locations)
    return replace(automaton, locations=tuple(locations))


def _awaited(automaton: Automaton, here: str, clocks: Mapping[str, Fraction], request: Request) -> Optional[Automaton]:
    """It may stay where it is for as long as it is awaited; None where it is not any more when the plan begins."""
    left = request.awaited.get(automaton.name, Fraction(-1)) - request.ahead
    if left < 0:
        return None
    passed = passed_bounds(automaton, here, clocks)
    late = {bound: replace(bound, bound=ceil(clocks[bound.clock] + left)) for bound in passed}
    locations = (
        replace(place, invariant=tuple(late.get(bound, bound) for bound in place.invariant))
        if place.name == here else place for place in automaton.locations
    )  # fmt: skip
    return replace(automaton, locations=tuple(locations))


def _without_ways(automaton: Automaton, request: Request) -> Automaton:
    """The automaton without commands to begin the movements that are blocked for it."""
    ways = [way for way in request.blocked if automaton.name in (way[2:] or (automaton.name,))]
    blocked = {going(x, y) for a, b, *_ in ways for x, y in ((a, b), (b, a))}
    edges = tuple(edge for edge in automaton.edges if not (edge.controllable and edge.target in blocked))
    return replace(automaton, edges=edges)


def _idle(automaton: Automaton, here: str, clocks: Mapping[str, Fraction]) -> Automaton:
    """The automaton without commands in its location, where a movement or action may end too early."""
    edges: List[Edge] = []
    for edge in automaton.edges:
        if edge.source == here and edge.is_end:
            bounds = tuple(bound for bound in edge.guard.clocks if _holds(bound, clocks))
            edge = replace(with_controllability(edge, False), guard=Guard(bounds, edge.guard.integers))
        receives = edge.sync is not None and not edge.sync.sends  # others decide that
        if edge.source != here or receives or not edge.controllable:
            edges.append(edge)
    return replace(automaton, edges=tuple(edges))


def _shares(network: Network, name: str) -> bool:
    """True for an agent that is busy with what others do, until they end it."""
    edges = network.automaton(name).edges if any(a.name == name for a in network.automata) else ()
    return any(edge.is_end and edge.sync is not None and not edge.sync.sends for edge in edges)


def _without_company(automaton: Automaton, absent: AbstractSet[Tuple[str, int]]) -> Automaton:
    """The automaton without the events for which only those are there who would not take part in them."""
    edges: List[Edge] = []
    for edge in automaton.edges:
        if not edge.controllable or edge.sync is None or not edge.sync.sends:
            edges.append(edge)
            continue
        clauses = [tuple(t for t in clause if (t.variable, t.value) not in absent) for clause in edge.guard.integers]
        if all(clauses):
            edges.append(replace(edge, guard=Guard(edge.guard.clocks, tuple(clauses))))
    return replace(automaton, edges=tuple(edges))


def _holds(bound: ClockBound, clocks: Mapping[str, Fraction]) -> bool:
    value, limit = clocks[bound.clock], bound.bound
    return {
        "<": value < limit,
        "<=": value <= limit,
        ">": value > limit,
        ">=": value >= limit,
        "==": value == limit,
    }[bound.op]
