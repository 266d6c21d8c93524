"""Automata of a strategy that follow the movements that robots are commanded: tours, and orders of passage.

A tour says how far a robot is on a way around, over and over, perhaps behind a way to where that begins: where it is
does not tell where it goes next. Another movement than the next one breaks it.

An order of passage says whose turn it is at a place that two robots must never be at: a robot has the place from the
moment at which it sets off for it until it sets off from there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Set, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.tga.network import Automaton, Edge, Location, Network, Sync
from pursue_gen.tga.part import beside

OFF = Role.OFF()
"""The location in which a robot has left its tour: it is one to avoid, as those where a promise is broken."""

_NOBODY = Role.NOBODY()


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
    ends = _ends(robot)
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


def _ends(robot: Automaton) -> Dict[str, Set[str]]:
    """Where each location of a robot leads; what is done on the way leads nowhere."""
    ends: Dict[str, Set[str]] = {}
    for edge in robot.edges:
        if edge.source != edge.target:
            ends.setdefault(edge.source, set()).add(edge.target)
    return ends


@dataclass(frozen=True)
class Passage:
    """The robots that are at a place, one visit after the other; first of all the one that starts there, if one does.

    At a place where several robots may be at once each has an order of its own visits. `again`: behind the last visit
    comes the first one.
    """

    place: str
    robots: Tuple[str, ...]
    again: bool = False

    @property
    def name(self) -> str:
        """Its automaton's name."""
        alone = f"_of_{self.robots[0]}" if len(set(self.robots)) == 1 else ""
        return Role.PASSAGE(self.place, alone)

    def awaits(self, visit: int) -> str:
        """The location in which the robot of this visit (from 0) may set off for the place; behind the last visit:
        the first one's, or nobody does."""
        visit = visit % len(self.robots) if self.again else visit
        return Role.AWAITS(self.robots[visit], visit + 1) if visit < len(self.robots) else _NOBODY

    def has(self, visit: int) -> str:
        """The location in which the robot of this visit is there, or on its way there."""
        return Role.HAS(self.robots[visit], visit + 1)


def with_passages(network: Network, passages: Iterable[Passage]) -> Network:
    """The network with the automata of these passages behind its own; one that is there already, or that cannot be
    (see `passage_automaton`), is left out."""
    for passage in passages:
        network = beside(network, passage_automaton(network, passage))
    return network


def passage_automaton(network: Network, passage: Passage) -> Optional[Automaton]:
    """The automaton of a passage. None where its name is taken, where a robot in it never moves to and from the place,
    or where the one that starts there is not the first."""
    robots = {automaton.name: automaton for automaton in network.automata if automaton.name in passage.robots}
    if network.start or passage.name in network.names or not passage.robots or robots.keys() != set(passage.robots):
        return None
    there = [name for name, automaton in robots.items() if automaton.initial == passage.place]
    if there and there != [passage.robots[0]]:
        return None
    ways = {name: _channels(automaton, passage.place) for name, automaton in robots.items()}
    locations: List[Location] = []
    edges: List[Edge] = []
    for visit, robot in enumerate(passage.robots):
        entering, leaving = ways[robot]
        if visit or passage.again or not there:
            locations.append(Location(passage.awaits(visit)))
            edges += _on(entering, passage.awaits(visit), passage.has(visit))
        locations.append(Location(passage.has(visit)))
        edges += _on(leaving, passage.has(visit), passage.awaits(visit + 1))
    locations += [] if passage.again else [Location(_NOBODY)]
    first = passage.has(0) if there else passage.awaits(0)
    return Automaton(passage.name, tuple(locations), first, tuple(edges))


def _on(channels: Iterable[str], source: str, target: str) -> List[Edge]:
    return [Edge(source, target, sync=Sync(channel, sends=False)) for channel in channels]


def _channels(robot: Automaton, place: str) -> Tuple[List[str], List[str]]:
    """The channels on which a robot sets off for a place, and those on which it sets off from there."""
    ends = _ends(robot)
    entering: Dict[str, None] = {}
    leaving: Dict[str, None] = {}
    for edge in robot.edges:
        if edge.sent is not None and edge.sets_off:
            if edge.source == place:
                leaving[edge.sent] = None
            elif ends.get(edge.target) == {place}:
                entering[edge.sent] = None
    return list(entering), list(leaving)
