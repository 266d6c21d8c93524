"""Events that can happen a limited number of times: an automaton counts how often each of them has begun."""

from __future__ import annotations

from typing import Iterator, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Event, Scenario
from pursue_gen.tga.network import Automaton, Edge, Location, Sync
from pursue_gen.tga.rules import Turns


def counted(scenario: Scenario) -> Iterator[Tuple[Event, int]]:
    """The events with a limit, and the limit."""
    return ((event, event.at_most) for event in scenario.events if event.at_most is not None)


def count_automaton(event: Event, most: int) -> Tuple[Automaton, Turns]:
    """The automaton that counts an event, and at which counts it can happen; like a rule that has no next round."""
    name = names.count(event.name)
    places = [f"{name}_{number}" for number in range(most + 1)]
    begins, times = Sync(names.event(event.name), sends=False), names.times(event.name)
    edges = tuple(
        Edge(before, after, sync=begins, assign=((times, number),))
        for number, (before, after) in enumerate(zip(places, places[1:]), start=1)
    )
    locations = tuple(Location(place, named=False) for place in places)
    return Automaton(name, locations, places[0], edges), {event.name: tuple(range(most))}
