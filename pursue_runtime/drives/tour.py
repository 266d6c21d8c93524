"""In which order a robot drives all ways so many times with few drives more: as an Eulerian trail, where there is one.

The next way is chosen where the robot is (Fleury's rule): one from whose end all that is left can still be driven
without a drive more. So a way that is given up, or a robot that is somewhere else, needs no new plan.
"""

from __future__ import annotations

from collections import deque
from typing import Collection, Deque, Dict, Iterable, List, Mapping, Optional, Set, Tuple

Way = Tuple[str, str]
"""From and to."""


def next_way(place: str, left: Mapping[Way, int], usable: Collection[Way]) -> Optional[Way]:
    """The way to drive next from a place; None where nothing that is left can be reached.

    `left`: how often each way is still to be driven; `usable`: the ways that can be driven at all.
    """
    wanted = {way: count for way, count in left.items() if count > 0}
    here = [way for way in wanted if way[0] == place]
    here.sort(key=lambda way: -wanted[way])  # a tour that is broken off has driven all ways about equally often
    for ways in (None, usable):
        for way in here:
            then = {**wanted, way: wanted[way] - 1}
            rest = [each for each, count in then.items() if count > 0]
            reached = _reached(way[1], rest if ways is None else ways)
            if all(each[0] in reached for each in rest):
                return way
    return here[0] if here else towards(place, {way[0] for way in wanted}, usable)


def _reached(place: str, ways: Iterable[Way]) -> Set[str]:
    """The places that can be reached from there on these ways."""
    from_each = _by_start(ways)
    found, open_ = {place}, [place]
    while open_:
        for there in from_each.get(open_.pop(), ()):
            if there not in found:
                found.add(there)
                open_.append(there)
    return found


def towards(place: str, goals: Collection[str], ways: Iterable[Way]) -> Optional[Way]:
    """The first way of a shortest route to one of the goals, which are elsewhere; None where there is no route."""
    from_each = _by_start(ways)
    first: Dict[str, Way] = {}
    open_: Deque[str] = deque([place])
    while open_:
        here = open_.popleft()
        if here in goals and here != place:
            return first[here]
        for there in from_each.get(here, ()):
            if there not in first and there != place:
                first[there] = first.get(here, (here, there))
                open_.append(there)
    return None


def _by_start(ways: Iterable[Way]) -> Dict[str, List[str]]:
    found: Dict[str, List[str]] = {}
    for a, b in ways:
        found.setdefault(a, []).append(b)
    return found
