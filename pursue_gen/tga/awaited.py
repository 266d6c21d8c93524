"""`assume: mechanic reaches m1 within 180 after call1`: automata that see who is awaited, and where that agent is.

Invariants of the agent's own locations would hold at all times. So an automaton of its own goes along with the agent
from the event on until it is there, and has the invariants by which it sets off in time. As who is at a bound has to
move by itself, that automaton can send the agent on its way there: at the last moment, as the agent could itself.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.assumption_checks import open_ways
from pursue_gen.language.assumptions.base import SHORTEST_STAY
from pursue_gen.language.assumptions.reaches import reaches_in
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Agent, Reaches, Scenario
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.positions import Positions


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
