"""Automata of a strategy that say whose turn it is at a place: orders of passage.

Where two robots must never be at one place they pass it in an order. Its automaton follows the movements that they are
commanded: a robot has the place from the moment at which it sets off for it until it sets off from there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, List, Optional, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.tga.network import Automaton, Edge, Location, Network, Sync
from pursue_gen.tga.part import beside
from pursue_gen.tga.tours import ends_of

_NOBODY = Role.NOBODY()


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
    ends = ends_of(robot)
    entering: Dict[str, None] = {}
    leaving: Dict[str, None] = {}
    for edge in robot.edges:
        if edge.sent is not None and edge.sets_off:
            if edge.source == place:
                leaving[edge.sent] = None
            elif ends.get(edge.target) == {place}:
                entering[edge.sent] = None
    return list(entering), list(leaving)
