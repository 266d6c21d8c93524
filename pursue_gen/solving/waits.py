"""How much longer than it has to a robot stays at the stops of its tour, so that it goes round as seldom as it may.

While it waits at one place of its round all others wait for it. So of few places it waits at each as long as at any
other: then each waits for one wait less than there are. Of many places that makes little difference, and it waits where
it has been everywhere, once in each round. What is left it waits there as well, and before it sets off at the start.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Dict, FrozenSet, Iterator, List, Mapping, Sequence

from pursue_gen.solving.gaps import course
from pursue_gen.solving.rounds import Round
from pursue_gen.solving.walkers import Patrol, Walker
from pursue_gen.tga.tours import Tour

_FEW = 6
"""A robot waits at each of so many places. Measured on lab scenario 35."""


@dataclass(frozen=True)
class _Room:
    """For how long a place may wait beside the ways, while the robot comes to these stops."""

    stops: FrozenSet[int]
    time: Fraction


def stays_of(walker: Walker, patrol: Patrol, tour: Tour, mine: Round, part: Fraction) -> Mapping[int, Fraction]:
    """By number of a stop how much longer than it has to a robot stays there, in whole units of the patrol, so that no
    place waits longer than this part of its period, where that can be."""
    rooms = list(_rooms(walker, patrol, tour, mine, part))
    last = len(walker.stops([tour.stops[0], *(patrol.visits[k].place for k in mine)]))
    places = {patrol.visits[k].place for k in mine}
    each = [n for n in range(tour.again, len(tour.stops)) if tour.stops[n] in places] if len(places) <= _FEW else []
    stays: Dict[int, Fraction] = {}
    for stops in (each, [last], [0]):
        time = _shared(rooms, stays, stops) // patrol.unit * patrol.unit
        stays.update((stop, stays.get(stop, Fraction(0)) + time) for stop in stops)
    return stays


def _shared(rooms: Sequence[_Room], stays: Mapping[int, Fraction], stops: Sequence[int]) -> Fraction:
    """How much longer the robot may stay at each of these stops."""
    found: List[Fraction] = []
    for room in rooms:
        count = sum(stop in room.stops for stop in stops)
        if count:
            found.append((room.time - sum(time for stop, time in stays.items() if stop in room.stops)) / count)
    return max(Fraction(0), min(found, default=Fraction(0)))


def _rooms(walker: Walker, patrol: Patrol, tour: Tour, mine: Round, part: Fraction) -> Iterator[_Room]:
    comes = course(walker, patrol, tour)
    for k in dict.fromkeys(mine):
        allowed, place = part * Fraction(patrol.duties[k].deadline), patrol.visits[k].place
        visits = [n for n, (stop, _) in enumerate(comes) if tour.stops[stop] == place]
        yield _Room(frozenset(stop for stop, _ in comes[: visits[0]]), allowed - comes[visits[0]][1])
        for before, after in zip(visits, visits[1:]):
            gap = comes[after][1] - comes[before][1] - walker.stay
            yield _Room(frozenset(stop for stop, _ in comes[before + 1 : after]), allowed - gap)
