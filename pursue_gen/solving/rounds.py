"""Rounds of several robots through places that each have to be visited again and again: who visits what, and when.

The longest time that a place waits for its visit, as a part of its period, is to be as short as possible (a travelling
salesman's problem with several salesmen, whose longest way counts). The places in the order of a walk through a least
spanning tree are cut into parts of about the same length; then single places are moved within a round, and up to three
in a row from the round that takes longest to others, as long as that helps. It is a heuristic: nothing says that there
is no better way.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import permutations
from typing import Callable, Dict, FrozenSet, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple, TypeVar

Node = TypeVar("Node")

Time = float
_NEVER = float("inf")

_ROUNDING = 1e-6
"""Sums of so many times are not off by more: what is a hair too late is not said to be so."""

_STEPS = 400_000
"""So many places of rounds are looked at. Measured on patrols of 12 to 140 places."""

_GIVEN = (1, 2, 3)
"""So many visits in a row may go from one robot to another. Measured on the same scenarios."""

_TREES = 20
"""So many spanning trees show whether visits are too late. Measured on a patrol of six rooms by two robots."""

_ORDERS = 24
"""So many ways to give the parts of the walk to the robots are tried. Not measured."""


@dataclass(frozen=True)
class Robot:
    """A robot: how long it takes at most from any place to any other one, by their names, its rest before each move
    included; where it starts; how long it stays at a place at most before it goes on."""

    start: str
    times: Mapping[str, Mapping[str, Time]]
    stay: Time

    def time(self, a: str, b: str) -> Time:
        """From one place to another; 0 to the same."""
        return 0.0 if a == b else self.times.get(a, {}).get(b, _NEVER)


@dataclass(frozen=True)
class Visit:
    """What has to be visited: where that is, who can do it (numbers of robots), and the period."""

    place: str
    robots: FrozenSet[int]
    period: Time


Round = Tuple[int, ...]
"""Numbers of visits in the order of a robot's round; the first one is its first."""


class RoundCost(NamedTuple):
    """Of a round the longest time that a visit waits, as a part of its period; how long once around takes, and how long
    it takes from the start until all visits have been made."""

    part: Time
    length: Time
    first: Time


def rounds(robots: Sequence[Robot], visits: Sequence[Visit], enough: Time = 0.0) -> Optional[Tuple[Round, ...]]:
    """A round for each robot, so that each visit is in one; None where somebody can visit none of these places.

    `enough`: where no visit waits longer than this part of its period, nothing better is looked for.
    """
    if any(not visit.robots for visit in visits):
        return None
    return _RoundsSearch(robots, visits, enough).found()


def cost(robot: Robot, visits: Sequence[Visit], some: Round) -> RoundCost:
    """What a round costs that begins with its first visit."""
    if not some:
        return RoundCost(0.0, 0.0, 0.0)
    length, longest = 0.0, robot.time(robot.start, visits[some[0]].place)
    period = min(visits[k].period for k in some)
    for k, following in zip(some, (*some[1:], some[0])):
        step = robot.time(visits[k].place, visits[following].place)
        length += step
    longest += length - robot.time(visits[some[-1]].place, visits[some[0]].place)
    return RoundCost(max(longest, length - robot.stay) / period, length, longest)


def least_wait(robots: Sequence[Robot], visits: Sequence[Visit]) -> Time:
    """A time for which some visit waits at least, whoever goes where.

    While a place waits longest all are visited, each robot on a way through some of them: with as many ways as robots
    they are no shorter than a least spanning tree without its longest branches, one fewer than there are robots. A
    robot may set off on its way at once.
    """
    first, *others = dict.fromkeys(visit.place for visit in visits)
    near = {place: _least_time(robots, first, place) for place in others}
    branches = _branches(near, partial(_least_time, robots))
    kept = sorted(branches)[: max(0, len(branches) + 1 - len(robots))]
    return max(0.0, sum(kept) / len(robots) - max(robot.stay for robot in robots))


def is_too_late(
    robots: Sequence[Robot], visits: Sequence[Visit], first: Sequence[Mapping[str, Time]], left: Sequence[Time]
) -> bool:
    """True if not all of these visits can be made in the times that are left, whoever goes where.

    `first`: how long each robot takes at least to each place from where it is. Those that have to be made within some
    time are made on ways of the robots, which are together no shorter than a least spanning tree of their places, and
    of one root for where the robots are.
    """
    root: Dict[int, Time] = {}
    for k, visit in enumerate(visits):
        if left[k] < _NEVER:
            root[k] = min((first[robot].get(visit.place, _NEVER) for robot in visit.robots), default=_NEVER)
    if any(time > left[k] + _ROUNDING for k, time in root.items()):
        return True
    ends = sorted({left[k] for k in root})
    for end in ends[:: -(-len(ends) // _TREES) or 1]:
        near = {k: time for k, time in root.items() if left[k] <= end}
        branches = _branches(near, lambda a, b: _least_time(robots, visits[a].place, visits[b].place))
        if sum(branches) > end * len(robots) + _ROUNDING:
            return True
    return False


def _branches(near: Mapping[Node, Time], between: Callable[[Node, Node], Time]) -> List[Time]:
    """The lengths of the branches of a least spanning tree (Prim 1957), from a root that is so `near` to each node."""
    branches: List[Time] = []
    while near:
        node = min(near, key=near.__getitem__)
        branches.append(near[node])
        near = {other: min(time, between(node, other)) for other, time in near.items() if other != node}
    return branches


def _least_time(robots: Sequence[Robot], a: str, b: str) -> Time:
    """From one of two places to the other."""
    return min(min(robot.time(a, b), robot.time(b, a)) for robot in robots)


class _RoundsSearch:
    def __init__(self, robots: Sequence[Robot], visits: Sequence[Visit], enough: Time) -> None:
        self._robots, self._visits, self._enough = robots, visits, enough
        self._steps = _STEPS

    def found(self) -> Optional[Tuple[Round, ...]]:
        """The best rounds that are found."""
        best: Optional[Tuple[Time, Tuple[Round, ...]]] = None
        walk = self._walk()
        for order in self._orders():
            some = [self._ordered(robot, part) for robot, part in enumerate(self._parts(walk, order))]
            worst = max(self._costs(some)).part
            if best is None or worst < best[0]:
                best = worst, tuple(some)
        assert best is not None
        found = self._improved(list(best[1]))
        return None if max(self._costs(found)).part == _NEVER else tuple(found)

    def _costs(self, some: Sequence[Round]) -> List[RoundCost]:
        return [self._cost(robot, each) for robot, each in enumerate(some)]

    def _cost(self, robot: int, some: Round) -> RoundCost:
        self._steps -= len(some) + 1
        return cost(self._robots[robot], self._visits, some)

    def _between(self, a: int, b: int) -> Time:
        """How long it takes from one visit to another at least."""
        either = self._visits[a].place, self._visits[b].place
        return min(robot.time(*either) for robot in self._robots)

    def _walk(self) -> List[int]:
        """All visits in the order of a walk through a least spanning tree, from one that is far from others; short
        branches first."""
        numbers = range(len(self._visits))
        root = max(numbers, key=lambda k: self._between(0, k) if self._between(0, k) < _NEVER else -1.0)
        children: Dict[int, List[int]] = {k: [] for k in numbers}
        near = {k: (self._between(root, k), root) for k in numbers if k != root}
        while near:
            k = min(near, key=lambda each: (near[each][0], each))
            children[near.pop(k)[1]].append(k)
            for other in near:
                near[other] = min(near[other], (self._between(k, other), k))
        sizes: Dict[int, int] = {}
        order: List[int] = [root]
        for k in order:
            order += children[k]
        for k in reversed(order):
            sizes[k] = 1 + sum(sizes[child] for child in children[k])
        walk, open_ones = [], [root]
        while open_ones:
            k = open_ones.pop()
            walk.append(k)
            open_ones += sorted(children[k], key=lambda child: -sizes[child])
        return walk

    def _orders(self) -> List[Tuple[int, ...]]:
        """The orders of robots along the walk that are tried."""
        numbers = range(len(self._robots))
        if len(numbers) <= 4:
            return list(permutations(numbers))[:_ORDERS]
        return [tuple(numbers), tuple(reversed(numbers))]

    def _parts(self, walk: Sequence[int], order: Sequence[int]) -> List[Round]:
        """The walk cut into a part for each robot, in this order, the longest of which is about as short as can be."""
        low, high = 0.0, max(1e-9, 2 * sum(self._between(a, b) for a, b in zip(walk, walk[1:])))
        high = min(high / min(visit.period for visit in self._visits), 1e12)
        best = self._cut(walk, order, _NEVER)
        for _ in range(20):
            middle = (low + high) / 2
            parts = self._cut(walk, order, middle)
            if sum(map(len, parts)) == len(walk):
                best, high = parts, middle
            else:
                low = middle
        return best

    def _cut(self, walk: Sequence[int], order: Sequence[int], most: Time) -> List[Round]:
        """The walk cut into parts that cost at most so much, those at its end left out where that is too little."""
        parts: List[Round] = [()] * len(self._robots)
        left = list(walk)
        for robot in order:
            mine: List[int] = []
            rest: List[int] = []
            length, period, who = 0.0, _NEVER, self._robots[robot]
            for place, k in enumerate(left):
                visit = self._visits[k]
                if robot not in visit.robots:
                    rest.append(k)
                    continue
                first, last = (self._visits[each].place for each in (mine[0], mine[-1])) if mine else (visit.place,) * 2
                longer, period = length + who.time(last, visit.place), min(period, visit.period)
                waits = max(who.time(who.start, first) + longer, longer + who.time(visit.place, first) - who.stay)
                if waits > most * period:
                    rest += left[place:]
                    break
                mine.append(k)
                length = longer
            parts[robot], left = tuple(mine), rest
        return parts

    def _ordered(self, robot: int, some: Round) -> Round:
        """The round in the order, and with the beginning, that costs least, as far as single visits that are moved,
        and parts that are turned round, help."""
        best, known = some, self._cost(robot, some)
        again = True
        while again and self._steps > 0:
            again = False
            for other in self._neighbours(best):
                found = self._cost(robot, other)
                if found < known:
                    best, known, again = other, found, True
                if again or self._steps <= 0:
                    break
        return best

    @staticmethod
    def _neighbours(some: Round) -> Iterator[Round]:
        size = len(some)
        for k in range(1, size):
            yield (*some[k:], *some[:k])
        for k in range(size):
            yield (*reversed(some[:k]), *reversed(some[k:]))
        for a in range(size):
            for b in range(a + 2, size + 1):
                if (a, b) != (0, size):
                    yield (*some[:a], *reversed(some[a:b]), *some[b:])
        for a in range(size):
            without = (*some[:a], *some[a + 1 :])
            for b in range(size):
                if b != a:
                    yield (*without[:b], some[a], *without[b:])

    def _improved(self, some: List[Round]) -> List[Round]:
        """Rounds of which the longest gives visits to others, as long as that helps."""
        costs = self._costs(some)
        while self._steps > 0 and max(costs).part > self._enough:
            worst = max(range(len(some)), key=lambda robot: costs[robot])
            found = self._given_away(some, costs, worst)
            if found is None:
                break
            for robot, new in found.items():
                some[robot] = self._ordered(robot, new)
                costs[robot] = self._cost(robot, some[robot])
        return some

    def _given_away(self, some: Sequence[Round], costs: Sequence[RoundCost], worst: int) -> Optional[Dict[int, Round]]:
        """The change that gives visits of the worst round away so that the longer of two rounds is shortest, if one
        helps."""
        best: Tuple[RoundCost, Optional[Dict[int, Round]]] = (costs[worst], None)
        mine = some[worst]
        for at, end in ((at, at + size) for size in _GIVEN for at in range(len(mine) + 1 - size)):
            given, fewer = mine[at:end], (*mine[:at], *mine[end:])
            left = self._cost(worst, fewer)
            if not left < best[0]:
                continue
            for robot in frozenset.intersection(*(self._visits[k].robots for k in given)) - {worst}:
                for place in range(len(some[robot]) + 1):
                    more = (*some[robot][:place], *given, *some[robot][place:])
                    longer = max(left, self._cost(robot, more))
                    if longer < best[0]:
                        best = longer, {worst: fewer, robot: more}
                    if self._steps <= 0:
                        return best[1]
        return best[1]
