"""In which order a robot drives all ways so many times with few drives more: as an Eulerian trail, where there is one.

The next way is chosen where the robot is (Fleury's rule): one from whose end all that is left can still be driven
without a drive more. So a way that is given up, or a robot that is somewhere else, needs no new plan.
"""

from __future__ import annotations

from collections import deque
from typing import Collection, Deque, Dict, Iterable, List, Mapping, Optional, Tuple

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
            reached = {way[1], *_routes(way[1], rest if ways is None else ways)}
            if all(each[0] in reached for each in rest):
                return way
    return here[0] if here else towards(place, {way[0] for way in wanted}, usable)


def towards(place: str, goals: Collection[str], ways: Iterable[Way]) -> Optional[Way]:
    """The first way of a shortest route to one of the goals, which are elsewhere; None where there is no route."""
    return next((way for there, way in _routes(place, ways).items() if there in goals), None)


def _routes(place: str, ways: Iterable[Way]) -> Dict[str, Way]:
    """The other places that can be reached from there on these ways, the nearest first, and the first way to each."""
    from_each: Dict[str, List[str]] = {}
    for a, b in ways:
        from_each.setdefault(a, []).append(b)
    first: Dict[str, Way] = {}
    open_: Deque[str] = deque([place])
    while open_:
        here = open_.popleft()
        for there in from_each.get(here, ()):
            if there not in first and there != place:
                first[there] = first.get(here, (here, there))
                open_.append(there)
    return first
