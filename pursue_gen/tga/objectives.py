"""Objectives: automata that watch, and what the controller wants of them."""

from __future__ import annotations

from itertools import combinations
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Tuple, Type

from pursue_gen.diagnostics import error
from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import IDLE, LOSE, agent_position
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.base import Breaks
from pursue_gen.language.scenario import (
    Endurance,
    Escort,
    Patrol,
    Pause,
    Reach,
    Request,
    Respond,
    Safety,
    Scenario,
    StatedObjective,
)
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.outcomes import Invalid
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.apart import pause_automaton
from pursue_gen.tga.endurance import endurance_automaton
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Objective, Sync, Test
from pursue_gen.tga.patrols import patrol_automaton
from pursue_gen.tga.requests import request_automaton
from pursue_gen.tga.responses import respond_automaton

Happened = Mapping[str, str]
"""From an event's name to the channel that says that it has happened."""


def scenario_objective(scenario: Scenario) -> Objective:
    """What the scenario's controller wants: all is achieved once nothing that people have ordered waits for its answer.
    Raises PursueError where it has no objective."""
    goal = tuple((names.reach_objective(k), names.WIN) for k, _ in enumerate(scenario.reach))
    goal += tuple(_answered(scenario)) if goal else ()
    bad = [(names.safety_objective(k), names.LOSE) for k, _ in enumerate(scenario.safety)]
    bounded = (k for k, reach in enumerate(scenario.reach) if reach.within is not None)
    bad += [(names.reach_objective(k), names.LATE) for k in bounded]
    if goal or bad:
        return Objective.of(goal, bad)
    message = f"{scenario.name} has no objective"
    raise Invalid([error("TGA012", message, hint="add a line 'objective: …' or 'reach_objective: …'")])


def _answered(scenario: Scenario) -> Iterator[Tuple[Symbol, Symbol]]:
    """Where the automata are that wait for the answers to orders when none is due."""
    orders = {event.name for event in scenario.orders}
    for k, each in enumerate(scenario.safety):
        if each.called_by in orders:
            yield names.safety_objective(k), IDLE


def stated(scenario: Scenario) -> Dict[str, StatedObjective]:
    """For the automaton of each objective what it watches, in the order of the network."""
    found: Dict[str, StatedObjective] = {names.safety_objective(k): each for k, each in enumerate(scenario.safety)}
    found.update((names.reach_objective(k), each) for k, each in enumerate(scenario.reach))
    return found


def clock_of(automaton: str) -> Symbol:
    """The clock of an objective's automaton."""
    symbol = Symbol.of(automaton)
    clock = names.safety_clock if symbol.role is Role.SAFETY else names.reach_clock
    return clock(int(symbol.parts[0]) - 1)


def unlocking(scenario: Scenario) -> Tuple[Optional[Sync], ...]:
    """For each reach objective the channel on which those with the same `after` are unlocked, all at once, so that what
    happens then counts for each of them: the first one sends. None: nobody else has its `after`."""
    times = [reach.after for reach in scenario.reach]
    firsts = [times.index(time) for time in times]
    return tuple(
        Sync(names.unlocking(first), sends=k == first) if firsts.count(first) > 1 else None
        for k, first in enumerate(firsts)
    )


def reach_automaton(reach: Reach, happened: Happened, number: int = 0, unlocking: Optional[Sync] = None) -> Automaton:
    """`do e1 and e2 after T within D`: unlocked once T has passed, won when each event has happened since then.

    A deadline is the invariant of all locations before; `late` is what remains to do when it is reached. `unlocking`:
    the channel of the first step, if others are unlocked with it. An event that has to happen several times is counted.
    """
    clock = names.reach_clock(number)
    passed = (ClockBound(clock, ">", exact(reach.after)),) if unlocking is None or unlocking.sends else ()
    limit = () if reach.within is None else (ClockBound(clock, "<=", exact(reach.within)),)
    count = len(reach.events)
    places = [Location(names.START, limit), Location(names.UNLOCKED, limit, named=False)]
    edges = [Edge(names.START, names.UNLOCKED, Guard(passed), unlocking)]
    if reach.times > 1:
        counted = _several_times(reach, happened[reach.events[0].name], names.reach_apart(number), limit)
        places, edges = [*places, *counted[0]], [*edges, *counted[1]]
    for size in range(count if reach.times == 1 else 0):
        for done in combinations(range(count), size):
            places += [Location(_done(done, count), limit)] if done else []
            for k in (k for k in range(count) if k not in done):
                sync = Sync(happened[reach.events[k].name], sends=False)
                edges.append(Edge(_done(done, count), _done((*done, k), count), sync=sync))
    late = [] if reach.within is None else [Location(names.LATE)]
    edges += [Edge(place.name, names.LATE) for place in places for _ in late]
    return Automaton(names.reach_objective(number), (*places, Location(names.WIN), *late), names.START, tuple(edges))


def _several_times(
    reach: Reach, happens: str, clock: str, limit: Tuple[ClockBound, ...]
) -> Tuple[List[Location], List[Edge]]:
    """What is behind `unlocked` where an event has to happen several times. Where it has to be apart, the controller
    makes a step once the time has passed, as it does for `after`; what comes before that step does not count."""
    places: List[Location] = []
    edges: List[Edge] = []
    here: str = names.UNLOCKED
    for times in range(1, reach.times + 1):
        counted = names.WIN if times == reach.times else names.done_times(times)
        waits = reach.apart is not None and times < reach.times
        target = names.apart(times) if waits else counted
        edges.append(Edge(here, target, sync=Sync(happens, sends=False), resets=(clock,) if waits else ()))
        if waits:
            places.append(Location(target, limit))
            edges.append(Edge(target, counted, Guard((ClockBound(clock, ">=", exact(reach.apart or 0)),))))
        places += [Location(counted, limit)] if times < reach.times else []
        here = counted
    return places, edges


def _done(events: Sequence[int], count: int) -> str:
    """The location in which so many of the events have happened, named by their numbers from 1."""
    if len(events) == count:
        return names.WIN
    return names.did(*(k + 1 for k in sorted(events))) if events else names.UNLOCKED


def safety_automaton(safety: Safety, around: Surroundings, number: int = 0) -> Automaton:
    """The automaton that goes to `lose` when the safety objective of the scenario is broken."""
    with_clock = _WITH_CLOCK.get(type(safety))
    if with_clock is not None:
        return with_clock(safety, around, number)
    name, breaks = names.safety_objective(number), safety.breaks
    broken = [] if breaks.condition is None else around.conditions.ways_to_hold(breaks.condition)
    edges = [Edge(IDLE, LOSE, Guard(integers=one), controllable=False) for one in (*broken, *_together(breaks, around))]
    if breaks.event is not None:
        happened = names.has_happened(around.event(breaks.event.name))
        edges.append(Edge(IDLE, LOSE, sync=Sync(happened, sends=False)))
    return Automaton(name, (Location(IDLE), Location(LOSE)), IDLE, tuple(edges))


def _together(breaks: Breaks, around: Surroundings) -> Iterator[Tuple[Clause, ...]]:
    """The environment may strike whenever a pair of agents shares a POI (idle or at work) or a connection, either way.

    Where the objective names a place, that POI alone counts.
    """
    positions, place = around.positions, breaks.place
    shared: List[Tuple[int, int]] = [
        (positions.at(poi), positions.doing(poi)) for poi in positions.pois if place in (None, poi)
    ]
    if place is None:
        ways = positions.ways.items()
        shared += [(code, positions.going(b, a)) for (a, b), code in ways if positions.pois[a] < positions.pois[b]]
    for codes in shared if breaks.pair else ():
        yield tuple(tuple(Test(agent_position(agent), code) for code in codes) for agent in breaks.pair)


_WITH_CLOCK: Mapping[Type[Safety], Callable[[Any, Surroundings, int], Automaton]] = {
    Respond: respond_automaton,
    Patrol: patrol_automaton,
    Endurance: endurance_automaton,
    Pause: pause_automaton,
    Escort: respond_automaton,
    Request: request_automaton,
}
"""What makes the automata in which time runs, for each kind of objective that has one."""
