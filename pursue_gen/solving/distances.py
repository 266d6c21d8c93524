"""How far it is to places, over ways that take time."""

from __future__ import annotations

import heapq
from typing import Dict, Iterable, List, Mapping, Sequence, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Automaton, Network


def distances_to(places: Iterable[str], back: Mapping[str, Sequence[Tuple[str, Number]]]) -> Dict[str, Number]:
    """The least time to one of these places, from each place from which ways lead there (Dijkstra 1959).

    `back`: for each place those before it, with the time from there.
    """
    found: Dict[str, Number] = {}
    waiting: List[Tuple[Number, str]] = [(0, place) for place in places]
    heapq.heapify(waiting)
    while waiting:
        far, place = heapq.heappop(waiting)
        if place not in found:
            found[place] = far
            for origin, takes in back.get(place, ()):
                heapq.heappush(waiting, (far + takes, origin))
    return found


def times_to(places: Iterable[str], automaton: Automaton) -> Dict[str, Number]:
    """The least time to one of these locations, from each from which edges lead there; each takes as long as its
    source may be stayed in."""
    longest = {each.name: max((bound.bound for bound in each.invariant), default=0) for each in automaton.locations}
    back: Dict[str, List[Tuple[str, Number]]] = {}
    for edge in automaton.edges:
        back.setdefault(edge.target, []).append((edge.source, longest[edge.source]))
    return distances_to(places, back)


def time_to_help(network: Network, robot: str, promise: Place) -> Number:
    """The least time in which the robot comes to where it does what the promise waits for, or is not where what is to
    be avoided asks for it."""
    watching, automaton = network.automaton(promise[0]), network.automaton(robot)
    waiting = {place.name for place in watching.locations if place.invariant}
    edges = [edge for edge in watching.edges if not waiting or edge.source in waiting]
    heard = {edge.sync.channel for edge in edges if edge.sync is not None}
    asked = {(test.variable, test.value) for edge in edges for clause in edge.guard.integers for test in clause}
    named = {name for name, _ in asked}
    there = {
        edge.target
        for edge in automaton.edges
        if (edge.sync is not None and edge.sync.channel in heard)
        or any(name in named and ((name, value) in asked) == bool(waiting) for name, value in edge.assign)
    }
    return times_to(there, automaton).get(automaton.initial, 0)
