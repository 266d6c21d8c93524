"""Automata of a strategy that say how far a robot is on its tour: where it is does not tell where it goes next.

A tour is a way around, over and over, perhaps behind a way to where that begins. Its automaton follows the movements
that its robot is commanded; another movement than the next one breaks it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Set, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.tga.network import Automaton, Edge, Location, Network, Sync
from pursue_gen.tga.part import beside

OFF = Role.OFF()
"""The location in which a robot has left its tour: it is one to avoid, as those where a promise is broken."""


@dataclass(frozen=True)
class Tour:
    """The places that a robot comes to one after the other, from where it starts; behind the last one it goes on to
    the one with the number `again` (from 0), or stays there, if that is their number."""

    robot: str
    stops: Tuple[str, ...]
    again: int = 0

    @property
    def name(self) -> str:
        """Its automaton's name."""
        return Role.TOUR(self.robot)

    def at(self, stop: int) -> str:
        """The location in which the robot is at this stop (from 0), or on its way there."""
        return Role.STOP(stop + 1, len(self.stops))

    def after(self, stop: int) -> Optional[int]:
        """The number of the stop behind this one; None where it stays."""
        following = stop + 1 if stop + 1 < len(self.stops) else self.again
        return following if following < len(self.stops) else None


def with_tours(network: Network, tours: Iterable[Tour]) -> Network:
    """The network with the automata of these tours behind its own; one that is there already, or that cannot be (see
    `tour_automaton`), is left out."""
    for tour in tours:
        network = beside(network, tour_automaton(network, tour))
    return network


def tour_automaton(network: Network, tour: Tour) -> Optional[Automaton]:
    """The automaton of a tour. None where its name is taken, in the middle of a play, where the robot does not start at
    the first stop, or does not move by commands from each stop to the next."""
    robot = next((automaton for automaton in network.automata if automaton.name == tour.robot), None)
    if network.start or robot is None or tour.name in network.names or not 0 <= tour.again <= len(tour.stops):
        return None
    if not tour.stops or robot.initial != tour.stops[0]:
        return None
    edges: List[Edge] = []
    ways = ways_of(robot)
    for stop, place in enumerate(tour.stops):
        after = tour.after(stop)
        following = "" if after is None else tour.stops[after]
        if after is not None and following not in ways.get(place, {}):
            return None
        for other, edge in ways.get(place, {}).items():
            target = OFF if after is None or other != following else tour.at(after)
            edges.append(Edge(tour.at(stop), target, sync=Sync(edge.sent or "", sends=False)))
    stops = tuple(Location(tour.at(stop)) for stop in range(len(tour.stops)))
    return Automaton(tour.name, (*stops, Location(OFF)), tour.at(0), tuple(edges))


def ways_of(robot: Automaton) -> Dict[str, Dict[str, Edge]]:
    """By place, and by the next place, the edge on which a robot sets off for it by a command; none where there are
    several."""
    ends = ends_of(robot)
    ways: Dict[str, Dict[str, Edge]] = {}
    several: Set[Tuple[str, str]] = set()
    for edge in robot.edges:
        if edge.sent is None or edge.enters is not Role.WAY or edge.leaves is Role.WAY:
            continue
        for place in ends.get(edge.target, set()):
            if place in ways.setdefault(edge.source, {}) or len(ends[edge.target]) > 1:
                several.add((edge.source, place))
            ways[edge.source][place] = edge
    for source, place in several:
        ways[source].pop(place, None)
    return ways


def ends_of(robot: Automaton) -> Dict[str, Set[str]]:
    """Where each location of a robot leads; what is done on the way leads nowhere."""
    ends: Dict[str, Set[str]] = {}
    for edge in robot.edges:
        if edge.source != edge.target:
            ends.setdefault(edge.source, set()).add(edge.target)
    return ends
