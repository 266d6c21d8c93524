"""Patrols: places at which somebody has to be again and again."""

from __future__ import annotations

from typing import Dict, FrozenSet, Iterator, List, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.assumptions.reaches import reaches_in
from pursue_gen.language.clauses import Domains
from pursue_gen.language.network_names import AT_RISK, IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.scenario import Agent, Patrol, Scenario
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.positions import Positions
from pursue_gen.tga.responses import awaited_by
from pursue_gen.tga.states import seen_by

_NOTHING: Tuple[Tuple[str, int], ...] = ()


def awaited(scenario: Scenario) -> FrozenSet[Tuple[str, str]]:
    """The agents with the POIs to whose arrival there somebody listens: these edges have a channel."""
    found = {(agent.name, each.place.name) for each in scenario.patrols for agent in scenario.on_patrol(each)}
    followed = {each.agent.name for _, each in reaches_in(scenario.assumptions)}
    found |= {(name, poi.name) for name in followed for poi in scenario.pois}
    found.update((each.agent.name, each.dock.name) for _, each in batteries_in(scenario.safety))
    found.update((agent.name, place) for agent, place in seen_by(scenario))
    heard = [condition for each in scenario.safety if each.breaks.condition is None for condition in each.conditions]
    if heard:
        domains = Domains(scenario)
        found.update(pair for condition in heard for pair in awaited_by(condition, scenario, domains))
    return frozenset(found)


def arrivals(scenario: Scenario) -> Iterator[str]:
    """The channels of these arrivals, in the order of agents and ways."""
    listened = awaited(scenario)
    for agent in scenario.agents:
        for a, b in scenario.movements(agent):
            if (agent.name, b) in listened:
                yield names.arrival(agent.name, a, b)


def turns(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """For each patrol in order the variable that says which of its places is next, the first being 0, and its value at
    the start."""
    found: Dict[str, int] = {}
    for patrol in (each for each in scenario.patrols if each.order):
        found.setdefault(_turn(patrol, scenario), _begun(patrol, scenario) % len(patrol.order))
    return tuple(found.items())


def _turn(patrol: Patrol, scenario: Scenario) -> str:
    """The variable of a patrol in order: it has the name of the first automaton of its statement."""
    first = next(number for number, each in enumerate(scenario.safety) if each.span == patrol.span)
    return names.safety_turn(first)


def _begun(patrol: Patrol, scenario: Scenario) -> int:
    """How many places of a patrol in order are visited at the start, one after the other, by those who stand there."""
    occupied = {agent.location.name for agent in scenario.on_patrol(patrol)}
    return next((k for k, place in enumerate(patrol.order) if place not in occupied), len(patrol.order))


def patrol_automaton(patrol: Patrol, around: Surroundings, number: int) -> Automaton:
    """`patrol p every T by A`: idle while A, or one of the robots, is there; else a deadline is running.

    It runs from the moment at which the last one leaves, or from the start. In order, an arrival counts only when it is
    the place's turn, and makes it that of the next one.
    """
    scenario, clock, place = around.scenario, names.safety_clock(number), patrol.place.name
    agents = scenario.on_patrol(patrol)
    due = Location(AT_RISK, (ClockBound(clock, "<=", exact(patrol.known_limit)),))
    there = any(agent.location.name == place for agent in agents)
    guard, assign = Guard(), _NOTHING
    if patrol.order:
        turn, k = _turn(patrol, scenario), patrol.order.index(place)
        guard, assign = Guard(integers=((Test(turn, k),),)), ((turn, (k + 1) % len(patrol.order)),)
        there = k < _begun(patrol, scenario)
    edges: List[Edge] = []
    elsewhere = {agent.name: _elsewhere(agent, place, around.positions) for agent in agents}
    for agent in agents:
        others = [clause for name, clause in elsewhere.items() if name != agent.name]
        for a, b in scenario.movements(agent):
            if b == place:
                comes = Sync(names.arrival(agent.name, a, b), sends=False)
                edges.append(Edge(AT_RISK, IDLE, guard, comes, assign))
                if patrol.order and others:  # somebody is there still, and the others have been at all other places
                    edges.append(Edge(IDLE, IDLE, guard, comes, assign))
            if a == place:
                left = Sync(names.movement(agent.name, a, b), sends=False)
                edges.append(Edge(IDLE, AT_RISK, Guard(integers=tuple(others)), left, resets=(clock,)))
    edges.append(Edge(AT_RISK, LOSE))
    name = names.safety_objective(number)
    return Automaton(name, (Location(IDLE), Location(LOSE), due), IDLE if there else AT_RISK, tuple(edges))


def _elsewhere(agent: Agent, place: str, positions: Positions) -> Clause:
    """The agent is neither idle nor at work at the place."""
    codes: Sequence[int] = [
        *(code for poi in positions.pois if poi != place for code in (positions.at(poi), positions.doing(poi))),
        *(code for way, code in positions.ways.items() if way != (place, place)),
    ]
    return tuple(Test(names.agent_position(agent.name), code) for code in dict.fromkeys(codes))
