"""Batteries by time: an automaton for each, which sees when its robot is at the charger, and when it is full again."""

from __future__ import annotations

from typing import Iterator, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import AT_RISK, CHARGING, EMPTY, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Agent, Endurance, Scenario
from pursue_gen.language.symbols import Role, role_of
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Sync


def charge_clocks(scenario: Scenario) -> Tuple[str, ...]:
    """The clocks of how long robots have been at their chargers."""
    return tuple(names.charge_clock(number) for number, _ in batteries_in(scenario.safety))


def endurance_automaton(endurance: Endurance, around: Surroundings, number: int) -> Automaton:
    """`battery A lasts T, charges in C at p`: idle while A is at p and full; charging until it has been there for C;
    at risk while it is away.

    The clock of the deadline counts since A has left full. One that leaves before it is full has the deadline that it
    came with; once that has passed, to leave is to lose.
    """
    if endurance.parts > 1:
        return _in_parts(endurance, around.scenario, number)
    scenario = around.scenario
    clock, charge = names.safety_clock(number), names.charge_clock(number)
    edges: List[Edge] = []
    for sync, comes in _passing(endurance, scenario):
        if comes:
            edges.append(Edge(AT_RISK, CHARGING, sync=sync, resets=(charge,)))
        else:
            edges.append(Edge(IDLE, AT_RISK, sync=sync, resets=(clock,)))
            edges += [Edge(CHARGING, AT_RISK, sync=sync), Edge(EMPTY, LOSE, sync=sync)]
    lasts, charged = exact(endurance.lasts), exact(endurance.charge)
    full, late = Guard((ClockBound(charge, ">=", charged),)), Guard((ClockBound(clock, ">=", lasts),))
    edges += [Edge(place, IDLE, full, controllable=False) for place in (CHARGING, EMPTY)]
    edges += [Edge(CHARGING, EMPTY, late, controllable=False), Edge(AT_RISK, LOSE)]
    in_time, until_full = ClockBound(clock, "<=", lasts), ClockBound(charge, "<=", charged)
    locations = (
        Location(IDLE),
        Location(LOSE),
        Location(AT_RISK, (in_time,)),
        Location(CHARGING, (until_full, in_time)),
        Location(EMPTY, (until_full,)),
    )
    first = IDLE if _begins_there(endurance, scenario) else AT_RISK
    return Automaton(names.safety_objective(number), locations, first, tuple(edges))


def _in_parts(endurance: Endurance, scenario: Scenario, number: int) -> Automaton:
    """`battery A lasts T, charges in C in N parts at p`: the same, but each C/N at p adds a part that lasts T/N.

    It never counts on more than there is, of a battery that is charged evenly: A, which has left p with k parts or
    more, is back after b with k T/N - b or more. Of this whole parts are counted, when the first further part is done
    (C/N after that b), and nothing of what A charges beyond a part. One that leaves before a part is done has the clock
    and the parts that it came with, as if it had been away.
    """
    clock, charge = names.safety_clock(number), names.charge_clock(number)
    count, lasts, needs = endurance.parts, endurance.part, endurance.part_charge
    passing = tuple(_passing(endurance, scenario))
    done, until_done = ClockBound(charge, ">=", needs), ClockBound(charge, "<=", needs)
    has = [names.charged_to(level) if level < count else IDLE for level in range(count + 1)]
    locations = [Location(IDLE), Location(LOSE)]
    edges: List[Edge] = []
    for level in range(1, count + 1):
        left, came, empty = names.left_with(level), names.came_with(level), names.came_too_late(level)
        in_time = ClockBound(clock, "<=", exact(level * lasts))
        late = Guard((ClockBound(clock, ">=", in_time.bound),))
        locations += [Location(left, (in_time,)), Location(came, (until_done, in_time)), Location(empty, (until_done,))]
        for sync, comes in passing:
            if comes:
                edges.append(Edge(left, came, sync=sync, resets=(charge,)))
            else:
                edges.append(Edge(has[level], left, sync=sync, resets=(clock,)))
                edges += [Edge(came, left, sync=sync), Edge(empty, LOSE, sync=sync)]
        for used in range(1, level + 1):
            more = ClockBound(clock, ">", exact((used - 1) * lasts + needs))
            at_most = ClockBound(clock, "<=", exact(used * lasts + needs))
            guard = Guard((done, *([more] if used > 1 else []), *([at_most] if used < level else [])))
            edges += [Edge(at, has[level - used + 1], guard, None, (), (charge,), False) for at in (came, empty)]
        if level < count:
            locations.append(Location(has[level], (until_done,)))
            edges.append(Edge(has[level], has[level + 1], Guard((done,)), resets=(charge,), controllable=False))
        edges += [Edge(came, empty, late, controllable=False), Edge(left, LOSE)]
    first = IDLE if _begins_there(endurance, scenario) else names.left_with(count)
    return Automaton(names.safety_objective(number), tuple(locations), first, tuple(edges))


def _passing(endurance: Endurance, scenario: Scenario) -> Iterator[Tuple[Sync, bool]]:
    """How the robot is heard coming to its charger (True), and leaving it."""
    agent, dock = robot_of(endurance, scenario), endurance.dock.name
    for a, b in scenario.movements(agent):
        if b == dock:
            yield Sync(names.arrival(agent.name, a, b), sends=False), True
        if a == dock:
            yield Sync(names.movement(agent.name, a, b), sends=False), False


def _begins_there(endurance: Endurance, scenario: Scenario) -> bool:
    return robot_of(endurance, scenario).location.name == endurance.dock.name


def is_battery(automaton: Automaton) -> bool:
    """True for the automaton of a battery by time."""
    return any(role_of(place) in (Role.CHARGING, Role.CAME) for place in automaton.stays)


def robot_of(endurance: Endurance, scenario: Scenario) -> Agent:
    """The robot whose battery it is."""
    return next(agent for agent in scenario.agents if agent.name == endurance.agent.name)
