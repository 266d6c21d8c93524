"""Batteries by time: an automaton for each, which sees when its robot is at the charger, and when it is full again."""

from __future__ import annotations

from typing import Iterator, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import AT_RISK, CHARGING, EMPTY, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.scenario import Agent, Endurance, Scenario
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Sync


def batteries_by_time(scenario: Scenario) -> Iterator[Tuple[int, Endurance]]:
    """The batteries by time, each behind its number among the safety objectives."""
    return ((number, each) for number, each in enumerate(scenario.safety) if isinstance(each, Endurance))


def charge_clocks(scenario: Scenario) -> Tuple[str, ...]:
    """The clocks of how long robots have been at their chargers."""
    return tuple(names.charge_clock(number) for number, _ in batteries_by_time(scenario))


def endurance_automaton(endurance: Endurance, around: Surroundings, number: int) -> Automaton:
    """`battery A lasts T, charges in C at p`: idle while A is at p and full; charging until it has been there for C;
    at risk while it is away.

    The clock of the deadline counts since A has left full. One that leaves before it is full has the deadline that it
    came with; once that has passed, to leave is to lose.
    """
    scenario, dock = around.scenario, endurance.dock.name
    clock, charge = names.safety_clock(number), names.charge_clock(number)
    agent = robot_of(endurance, scenario)
    edges: List[Edge] = []
    for a, b in scenario.movements(agent):
        if b == dock:
            comes = Sync(names.arrival(agent.name, a, b), sends=False)
            edges.append(Edge(AT_RISK, CHARGING, sync=comes, resets=(charge,)))
        if a == dock:
            leaves = Sync(names.movement(agent.name, a, b), sends=False)
            edges.append(Edge(IDLE, AT_RISK, sync=leaves, resets=(clock,)))
            edges += [Edge(CHARGING, AT_RISK, sync=leaves), Edge(EMPTY, LOSE, sync=leaves)]
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
    first = IDLE if agent.location.name == dock else AT_RISK
    return Automaton(names.safety_objective(number), locations, first, tuple(edges))


def is_battery(automaton: Automaton) -> bool:
    """True for the automaton of a battery by time."""
    return CHARGING in automaton.stays


def robot_of(endurance: Endurance, scenario: Scenario) -> Agent:
    """The robot whose battery it is."""
    return next(agent for agent in scenario.agents if agent.name == endurance.agent.name)
