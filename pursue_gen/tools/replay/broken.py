"""What of an objective is broken in a recorded state: two robots are where one may be, and nobody has marked it."""

from __future__ import annotations

from typing import Dict, List, Mapping, Tuple

from pursue_gen.tga.network import Edge, Network, Objective, Test


class Broken:
    """The edges by which objectives become broken without anybody's doing, by the first test of each."""

    def __init__(self, network: Network, objective: Objective) -> None:
        self._edges: Dict[Test, List[Tuple[str, Edge]]] = {}
        bad = set(objective.bad)
        for name, edge in network.edges:
            clauses = edge.guard.integers
            if (name, edge.target) in bad and edge.sync is None and clauses and not edge.guard.clocks:
                for test in clauses[0]:
                    self._edges.setdefault(test, []).append((name, edge))

    def of(self, locations: Mapping[str, str], values: Mapping[str, int]) -> str:
        """The automaton of an objective that is broken in a state; "" where none is, or it is marked already."""
        for item in values.items():
            for name, edge in self._edges.get(Test(*item), ()):
                if locations.get(name) == edge.source and edge.guard.holds(values):
                    return name
        return ""
