"""Events that can happen a limited number of times, and events in parts: an automaton counts, for each of them."""

from __future__ import annotations

from typing import Iterator, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Event, Scenario
from pursue_gen.tga.network import Automaton, Edge, Location, Sync
from pursue_gen.tga.rules import Turns


def counted(scenario: Scenario) -> Iterator[Tuple[Event, int]]:
    """The events with a limit, and the limit."""
    return ((event, event.at_most) for event in scenario.events if event.at_most is not None)


def split(scenario: Scenario) -> Iterator[Tuple[Event, int]]:
    """The events in parts, and in how many."""
    return ((event, event.split) for event in scenario.events if event.split is not None)


def count_automaton(event: Event, most: int) -> Tuple[Automaton, Turns]:
    """The automaton that counts an event, and at which counts it can happen; like a rule that has no next round."""
    name = names.count(event.name)
    places = [f"{name}_{number}" for number in range(most + 1)]
    happens = names.has_happened(event) if event.split else names.event(event.name)  # a part that begins is no time
    counts, times = Sync(happens, sends=False), names.times(event.name)
    edges = tuple(
        Edge(before, after, sync=counts, assign=((times, number),))
        for number, (before, after) in enumerate(zip(places, places[1:]), start=1)
    )
    locations = tuple(Location(place, named=False) for place in places)
    return Automaton(name, locations, places[0], edges), {event.name: tuple(range(most))}


def parts_automaton(event: Event, parts: int) -> Tuple[Automaton, Turns]:
    """The automaton that counts the parts of an event that are done, and which of its ends is next at which number."""
    name, variable = names.parts(event.name), names.parts_done(event.name)
    places = [f"{name}_{number}" for number in range(parts)]
    part, last = names.part_done(event.name), names.done(event.name)
    edges = [
        Edge(before, after, sync=Sync(part, sends=False), assign=((variable, number),))
        for number, (before, after) in enumerate(zip(places, places[1:]), start=1)
    ]
    edges.append(Edge(places[-1], places[0], sync=Sync(last, sends=False), assign=((variable, 0),)))
    locations = tuple(Location(place, named=False) for place in places)
    turns: Turns = {part: tuple(range(parts - 1)), last: (parts - 1,)}
    return Automaton(name, locations, places[0], tuple(edges)), turns
