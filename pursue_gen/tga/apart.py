"""Pauses that objectives ask for: what the automata of agents do too soon.

Each has a variable: 1 since the event has ended before which there is no pause, 2 as soon as the next one has begun too
soon. Controlled agents have no edges for that; those of others make the objective's automaton lose. An automaton that
sees a pause end by itself would be as true, and games with it are some twenty times as large.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Iterable, List, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.network_names import IDLE, LOSE
from pursue_gen.language.numbers import exact
from pursue_gen.language.objectives.pause import pauses_in
from pursue_gen.language.scenario import Pause, Scenario
from pursue_gen.language.symbols import Role
from pursue_gen.tga.agents import Surroundings
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Test

_COUNTS, _TOO_SOON = 1, 2


def pause_variables(scenario: Scenario) -> Tuple[Tuple[str, int], ...]:
    """The variables of the pauses with their first values."""
    return tuple((names.safety_pause(number), 0) for number, _ in pauses_in(scenario.safety))


def apart(automaton: Automaton, scenario: Scenario) -> Automaton:
    """The automaton of an agent that keeps the pauses of a scenario, or, where nobody controls it, may break them."""
    controlled = any(agent.controllable for agent in scenario.agents if agent.name == automaton.name)
    lasting = {event.name for event in scenario.events if event.duration is not None}
    for number, pause in pauses_in(scenario.safety):
        first = pause.event.name
        ended = names.done(first) if first in lasting else names.event(first)
        automaton = automaton.with_each(lambda edge: _kept(edge, number, pause, ended, controlled))  # noqa: B023
    return automaton


def _kept(edge: Edge, number: int, pause: Pause, ended: str, controlled: bool) -> List[Edge]:
    """An agent's edge, once for each thing that the pause can be at."""
    variable, clock = names.safety_pause(number), names.safety_clock(number)
    begins, found = edge.sent == names.event(pause.following.name), [edge]
    if begins:
        late, soon = (ClockBound(clock, op, exact(pause.time)) for op in (">=", "<"))
        free = Test(variable, 0), Test(variable, _TOO_SOON)
        found = [edge.plus(free), edge.plus((Test(variable, _COUNTS),), bounds=(late,))]
    if edge.sent == ended:
        found = [each.plus(assign=((variable, _COUNTS),), resets=(clock,)) for each in found]
    elif begins:
        found = [each.plus(assign=((variable, 0),)) for each in found]
    if begins and not controlled:
        found.append(edge.plus((Test(variable, _COUNTS),), bounds=(soon,), assign=((variable, _TOO_SOON),)))
    return found


def pause_automaton(pause: Pause, around: Surroundings, number: int) -> Automaton:
    """`at_least T between e1 and e2`: it loses when e2 has begun too soon."""
    too_soon = Guard(integers=((Test(names.safety_pause(number), _TOO_SOON),),))
    edges = (Edge(IDLE, LOSE, too_soon, controllable=False),)
    return Automaton(names.safety_objective(number), (Location(IDLE), Location(LOSE)), IDLE, edges)


def without_pauses(network: Network, objectives: Iterable[str]) -> Network:
    """The network in which nobody keeps the pauses of the objectives with these automata; itself where there are none.
    """
    gone = {Role.SAFETY_PAUSE(name) for name in objectives} & {name for name, _ in network.variables}
    if not gone:
        return network

    def free(edge: Edge) -> List[Edge]:
        about = [clause for clause in edge.guard.integers if clause[0].variable in gone]
        if any(all(test.value for test in clause) for clause in about):
            return []  # one that is free says the same
        clauses = tuple(clause for clause in edge.guard.integers if clause not in about)
        assign = tuple(one for one in edge.assign if one[0] not in gone)
        return [replace(edge, guard=replace(edge.guard, integers=clauses), assign=assign)]

    kept = tuple(one for one in network.variables if one[0] not in gone)
    return replace(network.with_each(lambda a: a.with_each(free)), variables=kept)
