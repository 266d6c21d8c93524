"""How far it is to places, over ways that take time."""

from __future__ import annotations

import heapq
import math
from typing import Dict, Iterable, List, Mapping, Sequence, Tuple, TypeVar

from pursue_gen.language.numbers import Number
from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Automaton, Network

Far = TypeVar("Far", Number, float)


def distances_to(places: Iterable[str], back: Mapping[str, Sequence[Tuple[str, Far]]]) -> Dict[str, Far]:
    """The least time to one of these places, from each place from which ways lead there (Dijkstra 1959).

    `back`: for each place those before it, with the time from there.
    """
    found: Dict[str, Far] = {}
    waiting: List[Tuple[Far, str]] = [(0, place) for place in places]
    heapq.heapify(waiting)
    while waiting:
        far, place = heapq.heappop(waiting)
        if place not in found:
            found[place] = far
            for origin, takes in back.get(place, ()):
                heapq.heappush(waiting, (far + takes, origin))
    return found


def times_to(places: Iterable[str], automaton: Automaton) -> Dict[str, Number]:
    """How long an agent takes at most to the nearest of these places, its rests included, from where it can come there.

    It rests as long as a guard says, and is under way as long as it may; a way without an end leads nowhere.
    """
    longest = {each.name: max((bound.bound for bound in each.invariant), default=None) for each in automaton.locations}
    back: Dict[str, List[Tuple[str, Number]]] = {}
    for edge in automaton.edges:
        takes = longest[edge.source]
        if takes is None and edge.leaves is not Role.WAY:
            takes = max((bound.bound for bound in edge.guard.clocks if bound.op in (">", ">=")), default=0)
        if takes is not None:
            back.setdefault(edge.target, []).append((edge.source, takes))
    return distances_to(places, back)


def time_to_help(network: Network, robot: str, promise: Place) -> float:
    """How long the robot takes at most to where it does what the promise waits for, or is not where what is to be
    avoided asks for it; infinite where it never comes there."""
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
    return float(times_to(there, automaton).get(automaton.initial, math.inf))
