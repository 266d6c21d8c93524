"""Which moves of some agents may help a promise: those that may change what it watches, and what these need."""

from __future__ import annotations

from typing import AbstractSet, Iterable, List, Set, Tuple

from pursue_gen.language.symbols import Role
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Network


def useful(network: Network, team: AbstractSet[str], places: Iterable[Place]) -> Set[Tuple[str, Edge]]:
    """The edges of these agents that may matter for whether the places are reached, each with its agent's name, and all
    edges of automata that are no agents.

    Leaving out the other edges can miss a win, but what it finds is a strategy of the real game.
    """
    watching = {name for name, _ in places}
    others = [a for a in network.automata if not is_agent(a)]
    search = _UseSearch([a for a in network.automata if a.name in team], others)
    search.need(edge for automaton in network.automata if automaton.name in watching for edge in automaton.edges)
    while search.grow():
        pass
    return search.found


class _UseSearch:
    """What is needed; it only grows."""

    def __init__(self, team: List[Automaton], others: List[Automaton]) -> None:
        self._team, self._others = team, others
        self._channels: Set[str] = set()
        self._variables: Set[str] = set()
        self.found = {(automaton.name, edge) for automaton in others for edge in automaton.edges}
        for automaton in team:
            for edge in automaton.edges:
                if edge.enters is Role.WAY or edge.leaves is Role.WAY:
                    self.found.add((automaton.name, edge))
                    self._variables.update(edge.tested)

    def need(self, edges: Iterable[Edge]) -> None:
        """Take in what these edges receive, and which variables they test or set."""
        for edge in edges:
            self._variables.update(edge.variables)
            if edge.channel is not None:
                self._channels.add(edge.channel)

    def grow(self) -> bool:
        """Take in what may change that, by one step more; False if that is nothing."""
        before = len(self._channels), len(self._variables), len(self.found)
        for automaton in self._others:
            self.need(e for e in automaton.edges if any(name in self._variables for name, _ in e.assign))
        for automaton in self._team:
            own = [edge for name, edge in self.found if name == automaton.name]
            ends = {edge.source for edge in own if edge.leaves is Role.WORK}
            tested = {name for edge in own for name in edge.tested}
            new = [edge for edge in automaton.edges if self._matters(edge, ends) or _charges(edge, tested)]
            self.found.update((automaton.name, edge) for edge in new)
            self._variables.update(name for edge in new for name in edge.tested)
        return before != (len(self._channels), len(self._variables), len(self.found))

    def _matters(self, edge: Edge, begun: AbstractSet[str]) -> bool:
        """True for an edge that changes what is needed, or begins what an edge from one of these locations ends."""
        return edge.sent in self._channels or (edge.source != edge.target and edge.target in begun)


def _charges(edge: Edge, tested: AbstractSet[str]) -> bool:
    """True for the end of an action that sets what the agent's own edges test: the level of its battery."""
    return edge.leaves is Role.WORK and any(name in tested for name, _ in edge.assign)
