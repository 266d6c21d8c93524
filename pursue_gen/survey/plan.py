"""The places of a scenario on a grid: the paths between them, what these cross, and which ways are missing."""

from __future__ import annotations

import heapq
import math
from functools import cached_property
from itertools import combinations
from typing import Dict, Iterable, List, Mapping, Optional, Tuple

from pursue_gen.drawing.ground import to_line
from pursue_gen.survey.graph import Graph
from pursue_gen.survey.grid import Point
from pursue_gen.survey.routes import Route, Routes

Pair = Tuple[str, str]

DETOUR = 1.1
"""A way is one of its own where all others between its places, together, are longer by more than this factor."""

_SURE = 1 + (DETOUR - 1) / 2
"""The same in proportion to an estimate of its length, which is a little too long."""


class Plan:
    """Places that can be reached by the centre of a robot (name → metres), and the paths between them.

    `room`: metres that the centres of two robots keep between them.
    """

    def __init__(self, graph: Graph, places: Mapping[str, Point], room: float) -> None:
        self.places = dict(places)
        self.room = room
        self._graph = graph
        self._routes = Routes(graph, list(self.places.values()))

    def route(self, a: str, b: str) -> Optional[Route]:
        """The path from one place to another; None if there is none, or one of them is not among the places. It is the
        same line in both directions."""
        known = a in self.places and b in self.places
        return self._routes.both(self.places[a], self.places[b]) if known else None

    def routes(self, pairs: Iterable[Tuple[Point, Point]], most: float) -> Routes:
        """The paths between pairs of other points of the map, those among them that the centre of a robot can be at;
        `most`: metres, more or less, that none of these paths is longer than."""
        grid = self._graph.grid
        sources = (min(pair) for pair in pairs)
        return Routes(self._graph, [point for point in sources if grid.is_free(grid.cell(*point))], most)

    def crossed(self, a: str, b: str) -> List[str]:
        """The other places at which a robot would be in the way of one that goes from a to b, in their order there."""
        route = self.route(a, b)
        if route is None:
            return []
        found = [(to_line(route.bends, at), name) for name, at in self.places.items() if name not in (a, b)]
        return [name for (apart, _), name in sorted(found, key=lambda one: one[0][1]) if apart < self.room]

    def is_joined(self, point: Point) -> bool:
        """Return True if the centre of a robot can get to a point of the map from most places."""
        grid = self._graph.grid
        if self._most is None or not grid.is_free(grid.cell(*point)):
            return self._most is None
        return math.isfinite(self._routes.estimate(self._most, point))

    @cached_property
    def _most(self) -> Optional[Point]:
        """One of the places of the largest part."""
        parts = self.parts()
        return self.places[parts[0][0]] if parts else None

    def parts(self) -> List[List[str]]:
        """The places, by what can be reached from each other; the largest part first."""
        parts: List[List[str]] = []
        for name, at in self.places.items():
            part = next((one for one in parts if math.isfinite(self._routes.estimate(self.places[one[0]], at))), None)
            if part is None:
                parts.append([name])
            else:
                part.append(name)
        return sorted(parts, key=len, reverse=True)

    def own_ways(self, known: Iterable[Pair]) -> List[Pair]:
        """The ways that are missing: each pair of places, the nearest first, unless the known ways and those that have
        been found before lead from one to the other on a path that is hardly longer.

        A way that crosses other places is missing only where there is none by way of these, either. This is the greedy
        spanner (Althöfer et al., 1993).
        """
        ways = _Ways()
        for a, b in known:
            route = self.route(a, b)
            if route is not None:
                ways.add(a, b, route.length)
        pairs = combinations(self.places, 2)
        estimates = [(self._routes.estimate(self.places[a], self.places[b]), a, b) for a, b in pairs]
        found: List[Pair] = []
        for estimate, a, b in sorted(estimates):
            if ways.lead(a, b, estimate * _SURE):
                continue
            route = self.route(a, b)
            if route is not None and not ways.lead(a, b, self._longest(a, b, route)):
                ways.add(a, b, route.length)
                found.append((a, b))
        return found

    def _longest(self, a: str, b: str, route: Route) -> float:
        """Up to what length other ways take the place of this one."""
        by = [route.length]
        for other in self.crossed(a, b):
            first, second = self.route(a, other), self.route(other, b)
            if first is not None and second is not None:
                by.append(first.length + second.length)
        return max(by) * DETOUR


class _Ways:
    """Ways with lengths, in both directions."""

    def __init__(self) -> None:
        self._from: Dict[str, Dict[str, float]] = {}

    def add(self, a: str, b: str, length: float) -> None:
        self._from.setdefault(a, {})[b] = length
        self._from.setdefault(b, {})[a] = length

    def lead(self, a: str, b: str, most: float) -> bool:
        """Return True if they lead from one place to another on a path that is no longer than `most`."""
        best, queue = {a: 0.0}, [(0.0, a)]
        while queue:
            done, here = heapq.heappop(queue)
            if here == b:
                return True
            for other, length in self._from.get(here, {}).items():
                far = done + length
                if far <= most and far < best.get(other, math.inf):
                    best[other] = far
                    heapq.heappush(queue, (far, other))
        return False
