"""How far it is to places, over ways that take time."""

from __future__ import annotations

import heapq
from typing import Dict, Iterable, List, Mapping, Sequence, Tuple

from pursue_gen.language.numbers import Number


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
