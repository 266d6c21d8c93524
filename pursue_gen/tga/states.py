"""States: one automaton that keeps every state's variable, and one for each that is not known at first.

What is not known is decided when it is found out, by a move of the environment: until then the variable has a value of
its own, and nothing depends on which of the two it will be. So whatever the state is from the start on, a play of the
robots, who cannot know it either, is one of the network; and a strategy cannot use what they do not know yet.
"""

from __future__ import annotations

from typing import Dict, Iterator, List, Optional, Sequence, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Agent, Scenario, State
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Location, Sync

_BASE = "base"

TO_FIND_OUT = 1
"""Time units at most between what shows a state and that it is known: as much as ends of movements and actions have."""


def states_automaton(states: Sequence[State]) -> Optional[Automaton]:
    """The automaton of all states; None where no event sets one.

    An event that sets several states does so by one edge: an automaton takes one edge in a move.
    """
    assigned: Dict[str, Dict[str, int]] = {}
    for state in states:
        for value, events in ((1, state.true_if), (0, state.false_if)):
            for event in events:
                assigned.setdefault(event.name, {})[names.state_value(state.name)] = value
    edges = tuple(
        Edge(_BASE, _BASE, sync=Sync(names.event(event), sends=False), assign=tuple(values.items()))
        for event, values in assigned.items()
    )
    return Automaton(names.STATES, (Location(_BASE),), _BASE, edges) if edges else None


def first_value(state: State) -> int:
    """The value of its variable at the start."""
    return names.UNKNOWN_VALUE if state.initially is None else int(state.initially)


def seen_by(scenario: Scenario) -> Iterator[Tuple[Agent, str]]:
    """The robots with the places at which they see what a state is."""
    places = [state.seen_at.name for state in scenario.states if state.seen_at is not None]
    yield from ((agent, place) for place in places for agent in scenario.agents if agent.is_robot)


def found_channels(scenario: Scenario) -> Iterator[str]:
    """The channels on which it is said what a state is, in the order of the states."""
    for state in scenario.states:
        if state.is_found_out:
            yield from (names.found(state.name, value) for value in (True, False))


def finding_automata(scenario: Scenario) -> Iterator[Automaton]:
    """For each state that is not known at first an automaton of whether it is known."""
    return (_finding(state, scenario) for state in scenario.states if state.is_found_out)


def _finding(state: State, scenario: Scenario) -> Automaton:
    """Unknown, being found out (in the environment's hands, and no longer than TO_FIND_OUT), known. An event that sets
    the state makes it known."""
    clock, variable = names.finding_clock(state.name), names.state_value(state.name)
    events = {event.name: event for event in scenario.events}
    shows: List[str] = [names.has_happened(events[ref.name]) for ref in state.shown_by]
    there = False
    if state.seen_at is not None:
        robots = [agent for agent in scenario.agents if agent.is_robot]
        there = any(robot.location.name == state.seen_at.name for robot in robots)
        ways = ((robot, way) for robot in robots for way in scenario.movements(robot))
        shows += [names.arrival(robot.name, *way) for robot, way in ways if way[1] == state.seen_at.name]
    edges = [Edge(names.UNKNOWN, names.FINDING, sync=Sync(channel, sends=False), resets=(clock,)) for channel in shows]
    for value in (True, False):
        says, sets = Sync(names.found(state.name, value), sends=True), ((variable, int(value)),)
        edges.append(Edge(names.FINDING, names.KNOWN, sync=says, assign=sets, controllable=False))
    for ref in (*state.true_if, *state.false_if):
        happens = Sync(names.event(ref.name), sends=False)
        edges += [Edge(here, names.KNOWN, sync=happens) for here in (names.UNKNOWN, names.FINDING)]
    finding = Location(names.FINDING, (ClockBound(clock, "<=", TO_FIND_OUT),))
    places = (Location(names.UNKNOWN), finding, Location(names.KNOWN))
    return Automaton(names.finding(state.name), places, names.FINDING if there else names.UNKNOWN, tuple(edges))
