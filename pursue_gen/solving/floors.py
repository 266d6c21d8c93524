"""Where robots move: their ways, and the places that hold one of them."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import AbstractSet, Dict, Mapping, NamedTuple, Sequence, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.tga.network import Automaton, Edge

_UNITS = 10
"""Times of ways are counted in tenths of time units."""

Ways = Mapping[str, Mapping[str, int]]
"""From each place the places to which a way leads, and how long that takes at most."""


class Move(NamedTuple):
    """A robot goes from one place to the next."""

    robot: str
    origin: str
    target: str


@dataclass(frozen=True)
class Floor:
    """For each robot its ways; `single`: the places that hold one robot at a time, from the moment at which it sets off
    for the place until it sets off from there."""

    ways: Mapping[str, Ways]
    single: AbstractSet[str]


Legs = Mapping[str, Mapping[Tuple[str, str], Edge]]
"""For each robot the edges by which it sets off, by the places from and to which it goes."""


def legs_of(robots: Sequence[Automaton]) -> Legs:
    """These of the robots."""
    found: Dict[str, Dict[Tuple[str, str], Edge]] = {}
    for robot in robots:
        ends = {edge.source: edge.target for edge in robot.edges if edge.leaves is Role.WAY and edge.is_end}
        setting_off = (edge for edge in robot.edges if edge.sets_off)
        found[robot.name] = {(e.source, ends[e.target]): e for e in setting_off if e.target in ends}
    return found


def floor_of(robots: Sequence[Automaton], legs: Legs, single: AbstractSet[str], reaction: Fraction) -> Floor:
    """Where the robots move: on each leg as long as it may take, the rest before it and a reaction included."""
    ways: Dict[str, Dict[str, Dict[str, int]]] = {}
    for robot in robots:
        own = ways[robot.name] = {place.name: {} for place in robot.locations}
        for (origin, target), edge in legs[robot.name].items():
            rest = max((bound.bound for bound in edge.guard.clocks), default=0)
            own[origin][target] = int(_UNITS * (robot.longest.get(edge.target, 0) + rest + reaction)) + 1
    return Floor(ways, single)
