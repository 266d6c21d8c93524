"""Robots that change places: single moves, one after the other, each into a place that holds nobody else.

Four ways to find them. *In time*: one robot after the other gets the quickest way that leaves those of the robots
before it alone (prioritized planning over safe intervals: Phillips and Likhachev, "SIPP", ICRA 2011), in several
orders. *Crowded* (`crowds`): all robots at once, with a search in where they are. *One by one*: each robot goes to its
place with whoever is there and one more robot that makes way, while all others stand still; that takes longer, and
finds ways where there is hardly a free place. *Together*: of few robots all moves are looked at. What these find is
made quicker: each robot gets the quickest way around all others. All is done with counted work, so that the same moves
are found on every machine.
"""

from __future__ import annotations

import heapq
from collections import deque
from itertools import count
from typing import (
    Deque,
    Dict,
    Iterator,
    List,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Set,
    Tuple,
    TypeVar,
)

from pursue_gen.language.numbers import Number
from pursue_gen.solving.crowds import LITTLE, MORE, crowded_routes
from pursue_gen.solving.distances import backwards, distances_to
from pursue_gen.solving.floors import Floor, Move

Node = TypeVar("Node")
Step = TypeVar("Step")

_ORDERS = 24
"""So many orders of robots are tried. Not measured."""

_STEPS = 60_000
"""So many steps of the search in time, and of that one by one, at most. Not measured."""

_AGAIN = 4
"""So often ways are looked for again around those of all others. Not measured."""

_FEW = 4
"""So many robots are few. Not measured."""

_GAP = 1
"""So much later than a robot has set off from a place another one sets off for it: nobody does at the same instant, so
that no robots wait for each other in a circle."""

_NEVER = 1 << 60


def routes(floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str]) -> Optional[List[Move]]:
    """Moves after which each of the robots is where it is wanted; robots that are wanted nowhere make way. None where
    none are found with little work."""
    found = _InTime(floor, at, wanted).found()
    if found is not None:
        return found
    found = crowded_routes(floor, at, wanted, LITTLE) or _OneByOne(floor, at, wanted).found()
    found = found or crowded_routes(floor, at, wanted, MORE)
    if found is None and len(at) <= _FEW:
        found = _OneByOne(floor, at, wanted).together()
    return None if found is None else _InTime(floor, at, wanted).sooner(found)


# In time --------------------------------------------------------------------------------------------------------------


class _Timed(NamedTuple):
    time: int
    move: Move


class _InTime:
    def __init__(self, floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str]) -> None:
        self._floor, self._at, self._wanted, self._left = floor, at, wanted, _STEPS

    def found(self) -> Optional[List[Move]]:
        """The quickest moves of all orders."""
        best: Optional[Tuple[int, List[Move]]] = None
        for order in self._orders():
            timed = self._in_order(order)
            if timed is not None:
                last = max((each.time + self._takes(each.move) for each in timed), default=0)
                if best is None or last < best[0]:
                    best = last, [each.move for each in sorted(timed)]
            if self._left <= 0:
                break
        return None if best is None else best[1]

    def _takes(self, move: Move) -> int:
        return self._floor.ways[move.robot][move.origin][move.target]

    def _far(self, name: str, to: str) -> Dict[str, Number]:
        """How long a robot takes at most to a place, from each place from which a way leads there."""
        return distances_to([to], backwards(self._floor.ways[name]))

    def _orders(self) -> Iterator[List[str]]:
        """Those with the longest ways first, then orders in which somebody else is first."""
        far = {name: self._far(name, place) for name, place in self._wanted.items()}
        length = {name: far[name].get(self._at[name], _NEVER) if name in far else -1 for name in self._at}
        first = sorted(self._at, key=lambda name: -length[name])
        yield first
        for turn in range(1, _ORDERS):
            k = turn % len(first)
            some = [*first[k:], *first[:k]]
            yield some if turn < len(first) else some[::-1]

    def _in_order(self, order: Sequence[str]) -> Optional[List[_Timed]]:
        taken: Dict[str, List[Tuple[int, int]]] = {}
        timed: List[_Timed] = []
        for name in order:
            way = self._way(name, taken)
            if way is None:
                return None
            self._take(name, way, taken)
            timed += way
        return timed

    def _take(self, name: str, way: Sequence[_Timed], taken: Dict[str, List[Tuple[int, int]]]) -> None:
        """Adds the times in which a robot has places on its way."""
        here, since = self._at[name], 0
        for each in way:
            taken.setdefault(here, []).append((since, each.time + _GAP))
            here, since = each.move.target, each.time
        taken.setdefault(here, []).append((since, _NEVER))

    def sooner(self, moves: Sequence[Move]) -> List[Move]:
        """Moves that do the same, without those that are not needed: one robot after the other, the last first, gets
        the quickest way around all others, as often as that helps."""
        ways = self._timed(moves)
        for _ in range(_AGAIN):
            before = dict(ways)
            for name in sorted(ways, key=lambda name: -self._last(ways[name])):
                taken: Dict[str, List[Tuple[int, int]]] = {}
                for other in ways:
                    if other != name:
                        self._take(other, ways[other], taken)
                way = self._way(name, taken)
                if way is not None and (self._last(way), len(way)) < (self._last(ways[name]), len(ways[name])):
                    ways[name] = way
            if ways == before:
                break
        return [each.move for each in sorted(each for way in ways.values() for each in way)]

    def _last(self, way: Sequence[_Timed]) -> int:
        """When a robot has come to the end of its way."""
        return way[-1].time + self._takes(way[-1].move) if way else 0

    def _timed(self, moves: Sequence[Move]) -> Dict[str, List[_Timed]]:
        """For each robot its moves, each as soon as it may be."""
        ways: Dict[str, List[_Timed]] = {name: [] for name in self._at}
        left: Dict[str, int] = {}
        for move in moves:
            time = max(self._last(ways[move.robot]), left.get(move.target, 0))
            ways[move.robot].append(_Timed(time, move))
            if move.origin in self._floor.single:
                left[move.origin] = time + _GAP
        return ways

    def _way(self, name: str, taken: Mapping[str, List[Tuple[int, int]]]) -> Optional[List[_Timed]]:
        """The quickest way of a robot that is at no place while others have it."""
        ways, wanted = self._floor.ways[name], self._wanted.get(name)
        far = {} if wanted is None else self._far(name, wanted)
        intervals = {place: self._intervals(place, taken) for place in ways}
        start = self._at[name]
        if not intervals[start] or intervals[start][0][0] > 0:
            return None
        # Of a place and an interval the earliest arrival counts.
        ticket = count()
        queue: List[Tuple[Number, int, int, str, int]] = [(far.get(start, 0), next(ticket), 0, start, 0)]
        came: Dict[Tuple[str, int], Optional[Tuple[Tuple[str, int], _Timed]]] = {(start, 0): None}
        closed: Set[Tuple[str, int]] = set()
        while queue:
            _, _, time, place, k = heapq.heappop(queue)
            if (place, k) in closed:
                continue
            closed.add((place, k))
            self._left -= 1
            until = intervals[place][k][1]
            if place == (wanted or place) and until == _NEVER:
                return _path(came, (place, k))
            if self._left <= 0:
                return None
            for target, takes in ways[place].items():
                for number, (begin, end) in enumerate(intervals[target]):
                    leave = max(time, begin)
                    if leave >= until or leave + takes >= end or (target, number) in closed:
                        continue
                    if wanted is not None and target not in far:
                        continue
                    known = came.get((target, number))
                    if known is not None and known[1].time + self._takes(known[1].move) <= leave + takes:
                        continue
                    came[target, number] = (place, k), _Timed(leave, Move(name, place, target))
                    rest = leave + takes + far.get(target, 0)
                    heapq.heappush(queue, (rest, next(ticket), leave + takes, target, number))
        return None

    def _intervals(self, place: str, taken: Mapping[str, List[Tuple[int, int]]]) -> List[Tuple[int, int]]:
        """The times in which nobody has a place."""
        found, begin = [], 0
        for since, until in sorted(taken.get(place, ())) if place in self._floor.single else ():
            if begin < since:
                found.append((begin, since))
            begin = max(begin, until)
        return [*found, (begin, _NEVER)] if begin < _NEVER else found


def _path(came: Mapping[Node, Optional[Tuple[Node, Step]]], last: Node) -> List[Step]:
    """The steps to a node; `came`: for each node the one before it, and the step from there; None for the first."""
    way: List[Step] = []
    step = came[last]
    while step is not None:
        way.append(step[1])
        step = came[step[0]]
    return way[::-1]


# One by one -----------------------------------------------------------------------------------------------------------


class _OneByOne:
    def __init__(self, floor: Floor, at: Mapping[str, str], wanted: Mapping[str, str]) -> None:
        self._floor, self._at, self._wanted, self._left = floor, dict(at), wanted, _STEPS

    def found(self) -> Optional[List[Move]]:
        """The moves of all robots."""
        moves: List[Move] = []
        for name, place in self._wanted.items():
            if self._at[name] == place:
                continue
            some = self._bring(name, place)
            if some is None:
                return None
            for move in some:
                self._at[move.robot] = move.target
            moves += some
        return moves if all(self._at[name] == place for name, place in self._wanted.items()) else None

    def together(self) -> Optional[List[Move]]:
        """The fewest moves of all robots."""
        return self._search({name: self._wanted.get(name) for name in self._at})

    def _bring(self, name: str, place: str) -> Optional[List[Move]]:
        """Brings a robot to its place; whoever is there goes where it is wanted, or to where the robot was."""
        there = [other for other, here in self._at.items() if here == place and place in self._floor.single]
        goal: Dict[str, Optional[str]] = {name: place}
        for other in there:
            wish = self._wanted.get(other)
            free = wish is not None and wish not in (place, *self._at.values())
            goal[other] = wish if free and wish is not None else self._at[name]
        others = [other for other in self._at if other not in goal]
        for helper in (None, *others):
            some = goal if helper is None else {**goal, helper: self._at[helper]}
            moves = self._search(some)
            if moves is not None or self._left <= 0:
                return moves
        return None

    def _search(self, goal: Mapping[str, Optional[str]]) -> Optional[List[Move]]:
        """The fewest moves of these robots to their goals (None: anywhere), all others standing still."""
        team = tuple(goal)
        blocked = {here for other, here in self._at.items() if other not in goal and here in self._floor.single}
        start, wanted = tuple(self._at[name] for name in team), tuple(goal.values())
        came: Dict[Tuple[str, ...], Optional[Tuple[Tuple[str, ...], Move]]] = {start: None}
        queue: Deque[Tuple[str, ...]] = deque([start])
        while queue and self._left > 0:
            here = queue.popleft()
            self._left -= 1
            if all(place in (None, there) for place, there in zip(wanted, here)):
                return _path(came, here)
            for k, name in enumerate(team):
                for target in self._floor.ways[name][here[k]]:
                    if target in blocked or (target in here and target in self._floor.single):
                        continue
                    there = (*here[:k], target, *here[k + 1 :])
                    if there not in came:
                        came[there] = here, Move(name, here[k], target)
                        queue.append(there)
        return None
