"""Patrols: places at which somebody has to be again and again."""

from __future__ import annotations

from typing import FrozenSet, Iterator, List, Sequence, Tuple

from pursue_gen.language.scenario import Agent, Patrol, Scenario
from pursue_gen.tga import names
from pursue_gen.tga.names import AT_RISK, IDLE, LOSE
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.positions import Positions


def awaited(scenario: Scenario) -> FrozenSet[Tuple[str, str]]:
    """The agents with the POIs to whose arrival there a patrol listens: these edges have a channel."""
    patrols = (each for each in scenario.safety if isinstance(each, Patrol))
    return frozenset((agent.name, each.place.name) for each in patrols for agent in scenario.on_patrol(each))


def arrivals(scenario: Scenario) -> Iterator[str]:
    """The channels of these arrivals, in the order of agents and ways."""
    listened = awaited(scenario)
    for agent in scenario.agents:
        for a, b in scenario.movements(agent):
            if (agent.name, b) in listened:
                yield names.arrival(agent.name, a, b)


def patrol_automaton(patrol: Patrol, scenario: Scenario, positions: Positions, number: int) -> Automaton:
    """`patrol p every T by A`: idle while A, or one of the robots, is there; else a deadline is running.

    It runs from the moment at which the last one leaves, or from the start.
    """
    clock, place, agents = names.safety_clock(number), patrol.place.name, scenario.on_patrol(patrol)
    due = Location(AT_RISK, (ClockBound(clock, "<=", patrol.every),))
    edges: List[Edge] = []
    for agent in agents:
        others = [_elsewhere(other, place, positions) for other in agents if other is not agent]
        for a, b in scenario.movements(agent):
            if b == place:
                edges.append(Edge(AT_RISK, IDLE, sync=Sync(names.arrival(agent.name, a, b), sends=False)))
            if a == place:
                left = Sync(names.movement(agent.name, a, b), sends=False)
                edges.append(Edge(IDLE, AT_RISK, Guard(integers=tuple(others)), left, resets=(clock,)))
    edges.append(Edge(AT_RISK, LOSE))
    there = any(agent.location.name == place for agent in agents)
    name = names.safety_objective(number)
    return Automaton(name, (Location(IDLE), Location(LOSE), due), IDLE if there else AT_RISK, tuple(edges))


def _elsewhere(agent: Agent, place: str, positions: Positions) -> Clause:
    """The agent is neither idle nor at work at the place."""
    codes: Sequence[int] = [
        *(code for poi in positions.pois if poi != place for code in (positions.at(poi), positions.doing(poi))),
        *positions.ways.values(),
    ]
    return tuple(Test(names.agent_position(agent.name), code) for code in dict.fromkeys(codes))
