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


def backwards(ways: Mapping[str, Mapping[str, Far]]) -> Dict[str, List[Tuple[str, Far]]]:
    """For each place those before it, with the time from there; `ways`: from each place that to those behind it."""
    back: Dict[str, List[Tuple[str, Far]]] = {}
    for origin, targets in ways.items():
        for target, takes in targets.items():
            back.setdefault(target, []).append((origin, takes))
    return back


def times_to(places: Iterable[str], automaton: Automaton, rests: bool = True) -> Dict[str, Number]:
    """How long an agent takes at most to the nearest of these places, with its `rests`, from where it can come there.

    It rests as long as a guard says, and is under way as long as it may, or until it can break off what it does; a way
    without an end leads nowhere.
    """
    back: Dict[str, List[Tuple[str, Number]]] = {}
    for edge in automaton.edges:
        takes = automaton.longest.get(edge.source, None if edge.leaves is Role.WAY else edge.guard.since * rests)
        takes = edge.guard.since if edge.breaks_off else takes
        if takes is not None:
            back.setdefault(edge.target, []).append((edge.source, takes))
    return distances_to(places, back)


def time_to_help(network: Network, robot: str, promise: Place) -> float:
    """How long the robot takes at most to where it does what the promise waits for, or is not where what is to be
    avoided asks for it; infinite where it never comes there."""
    watching, automaton = network.automaton(promise[0]), network.automaton(robot)
    edges = [edge for edge in watching.edges if not watching.stays or edge.source in watching.stays]
    heard = {edge.channel for edge in edges if edge.channel is not None}
    asked = {(test.variable, test.value) for edge in edges for clause in edge.guard.integers for test in clause}
    named = {name for name, _ in asked}
    there = {
        edge.target
        for edge in automaton.edges
        if (edge.channel in heard)
        or any(name in named and ((name, value) in asked) == bool(watching.stays) for name, value in edge.assign)
    }
    return float(times_to(there, automaton).get(automaton.initial, math.inf))
