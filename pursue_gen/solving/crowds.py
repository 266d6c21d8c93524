"""Robots that change places where there is hardly room: a search over where all of them are, that always goes on from
the last place it has come to.

Lazy constraints addition (Okumura, "LaCAM", AAAI 2023): of each configuration the next one is made by priority
inheritance with backtracking (Okumura et al., "PIBT", IJCAI 2019), where a robot that is in the way of a more urgent
one goes first; where that leads back to what is known, more and more robots are told where to go. Moves come one after
the other, each into a place that holds nobody else. All is done with counted work, so that the same moves are found on
every machine.
"""

from __future__ import annotations

import random
from collections import deque
from dataclasses import dataclass, field
from typing import Deque, Dict, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.solving.distances import backwards, distances_to
from pursue_gen.solving.floors import Floor, Move

_WORK = (10_000, 20_000, 20_000, 40_000, 40_000, 80_000, 80_000, 200_000)
"""So many times a robot is asked to go somewhere, at most, in each of several searches that decide ties otherwise: one
that is stuck stays so for long. Measured on 20 robots that go to and fro in public buildings."""

LITTLE, MORE = range(3), range(3, len(_WORK))
"""The first of these searches, and the others. Measured on corridors, where all of them are in vain."""

Places = Tuple[str, ...]
"""Where each robot is, in their order."""

Told = Tuple[Tuple[int, str], ...]
"""Robots, by number, that are told where to go."""


@dataclass
class _Node:
    places: Places
    parent: Optional[_Node]
    moves: Sequence[Move]
    order: Sequence[int]
    urgent: Sequence[int]
    told: Deque[Told] = field(default_factory=lambda: deque([()]))


def crowded_routes(
    floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str], searches: Iterable[int]
) -> Optional[List[Move]]:
    """Moves after which each robot is where it is wanted; None where none are found in these
    searches."""
    for number in searches:
        moves = _Search(floor, at, wanted, number, _WORK[number]).found()
        if moves is not None:
            return moves
    return None


class _Search:
    def __init__(
        self, floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str], number: int, work: int
    ) -> None:
        self._floor, self._left = floor, work
        self._names = list(at)
        self._start = tuple(at.values())
        self._wanted = [wanted.get(name) for name in self._names]
        self._ties = random.Random(number)
        self._far: List[Dict[str, Number]] = [
            {} if place is None else distances_to([place], backwards(floor.ways[name]))
            for name, place in zip(self._names, self._wanted)
        ]

    def found(self) -> Optional[List[Move]]:
        """The moves, round by round."""
        robots = range(len(self._names))
        if any(place is not None and self._start[k] not in self._far[k] for k, place in enumerate(self._wanted)):
            return None  # that robot cannot come there
        far = [self._distance(k, self._start[k]) for k in robots]
        first = _Node(self._start, None, (), sorted(robots, key=lambda k: -far[k]), [0] * len(robots))
        known: Dict[Places, _Node] = {self._start: first}
        stack = [first]
        while stack and self._left > 0:
            node = stack[-1]
            if all(place in (None, here) for place, here in zip(self._wanted, node.places)):
                return _way_to(node)
            if not node.told:
                stack.pop()
                continue
            told = node.told.popleft()
            if len(told) < len(self._names):
                k = node.order[len(told)]
                node.told.extend((*told, (k, place)) for place in self.choices(k, node.places[k]))
            moves = _Round(self, node.places, told).moves(node.order)
            if not moves:
                continue
            after = list(node.places)
            for move in moves:
                after[self._names.index(move.robot)] = move.target
            again = known.get(tuple(after))
            if again is None:
                again = known[tuple(after)] = self._next(node, tuple(after), moves)
            stack.append(again)
        return None

    def _next(self, node: _Node, places: Places, moves: Sequence[Move]) -> _Node:
        """Those who wait the longest come first."""
        arrived = [wanted in (None, here) for wanted, here in zip(self._wanted, places)]
        urgent = [0 if done else waits + 1 for done, waits in zip(arrived, node.urgent)]
        order = sorted(range(len(places)), key=lambda k: (-urgent[k], -self._distance(k, places[k])))
        return _Node(places, node, moves, order, urgent)

    def _distance(self, k: int, place: str) -> Number:
        return 0 if self._wanted[k] is None else self._far[k][place]

    def choices(self, k: int, here: str) -> List[str]:
        """Where a robot may be after a round, what brings it nearest first."""
        ways = self._floor.ways[self._names[k]][here]
        some = [here, *(place for place in ways if self._wanted[k] is None or place in self._far[k])]
        return sorted(some, key=lambda place: (self._distance(k, place), place != here, self._ties.random()))

    def spend(self) -> bool:
        """Counts work; False where none is left."""
        self._left -= 1
        return self._left > 0

    def single(self, place: str) -> bool:
        """True where a place holds one robot."""
        return place in self._floor.single

    def name(self, k: int) -> str:
        """The name of a robot."""
        return self._names[k]


class _Round:
    """One round: each robot makes one move at most."""

    def __init__(self, search: _Search, places: Places, told: Told) -> None:
        self._search, self._told = search, dict(told)
        self._now = list(places)
        self._there = {place: k for k, place in enumerate(places) if search.single(place)}
        self._done: Set[int] = set()
        self._moves: List[Move] = []

    def moves(self, order: Sequence[int]) -> Optional[List[Move]]:
        """Its moves; None where robots cannot go where they are told."""
        for k in [*self._told, *(k for k in order if k not in self._told)]:
            if k not in self._done and not self._go(k, ()) and k in self._told:
                return None
        return self._moves if all(self._now[k] == place for k, place in self._told.items()) else None

    def _go(self, k: int, pushing: Tuple[int, ...]) -> bool:
        """Has a robot move; one that is pushed has to leave its place. False where it cannot."""
        if not self._search.spend():
            return False
        here = self._now[k]
        choices = [self._told[k]] if k in self._told else self._search.choices(k, here)
        for target in choices:
            if target == here:
                if pushing:
                    continue
                self._done.add(k)
                return True
            other = self._there.get(target)
            stays = other is not None and (other in self._done or other in pushing)
            if stays or (other is not None and not self._go(other, (*pushing, k))):
                continue
            self._move(k, target)
            return True
        if not pushing:
            self._done.add(k)
        return not pushing and k not in self._told

    def _move(self, k: int, target: str) -> None:
        here = self._now[k]
        self._moves.append(Move(self._search.name(k), here, target))
        self._there.pop(here, None)
        if self._search.single(target):
            self._there[target] = k
        self._now[k] = target
        self._done.add(k)


def _way_to(node: _Node) -> List[Move]:
    """The moves from the start to a node."""
    rounds: List[Sequence[Move]] = []
    while node.parent is not None:
        rounds.append(node.moves)
        node = node.parent
    return [move for some in reversed(rounds) for move in some]
