"""The cone of influence of an objective: the part of a network that can matter for who wins.

An automaton is left out if nothing that it does is seen by the others, however indirectly: it writes no variable that
they read, resets no clock of theirs, sends nothing that they receive, and cannot stop time. It may read and receive
whatever it likes. A variable is left out if no edge of the rest needs it: edges that stay where they are, and that set
only such variables, change nothing for the others.

What is left out cannot stop time: wherever it may be, the environment can let as much time pass as it likes. So each
play of the part is one of the network, with or without moves of what is left out, and the part is won if and only if
the network is, moves that change nothing for anybody else counted as none (see `game.JointMove`). Controllable
agents that are left out stay where they are, and those that are not make no detours (`detours`).
"""

from __future__ import annotations

from collections import defaultdict
from typing import AbstractSet, Dict, FrozenSet, Set, Tuple

from pursue_gen.synthesis.detours import Detour, detours
from pursue_gen.synthesis.time_passes import lets_time_pass
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, Edge, Network, Objective
from pursue_gen.tga.part import part_of


def cone_of_influence(network: Network, objective: Objective) -> Network:
    """The part of the network that the objective depends on; the network itself where that is all of it."""
    cone = _Cone(network, objective)
    while cone.grow():
        pass
    gone = cone.unnoticed()
    network = network.with_each(lambda a: a.with_edges(e for e in a.edges if e not in gone[a.name]))
    return part_of(network, cone.automata, cone.variables)


def out_of_reach(network: Network, objective: Objective) -> Tuple[str, ...]:
    """The agents on whom alone the objective depends, where no command changes anything for it; () where one may."""
    cone = cone_of_influence(network, objective)
    agents = [automaton for automaton in cone.automata if is_agent(automaton)]
    commanded = any(edge.controllable for automaton in agents for edge in automaton.edges)
    return () if commanded else tuple(automaton.name for automaton in agents)


class _Cone:
    """What is known to matter; it only grows."""

    def __init__(self, network: Network, objective: Objective) -> None:
        self._network = network
        self.automata = {name for name, _ in (*objective.goal, *objective.bad)}
        self.automata.intersection_update(automaton.name for automaton in network.automata)
        self.automata.update(a.name for a in network.automata if not lets_time_pass(a, network))
        self.variables: Set[str] = set()
        self._clocks: Set[str] = set()
        self._objective = objective
        self._detours: Dict[str, Tuple[Detour, ...]] = {}
        self._tests: Dict[str, AbstractSet[Tuple[str, FrozenSet[int]]]] = {}

    def grow(self) -> bool:
        """Take in what the part depends on by one step more; False if that is nothing."""
        before = len(self.automata), len(self.variables), len(self._clocks)
        received: Set[str] = set()
        sent: Set[str] = set()
        gone = self.unnoticed()
        for automaton in self._network.automata:
            if automaton.name not in self.automata:
                continue
            self._clocks |= automaton.clocks
            for edge in automaton.edges:
                if edge not in gone[automaton.name] and not self._may_go(automaton, edge):
                    self.variables.update(edge.variables)
                    if edge.channel is not None:
                        (received if edge.sent is None else sent).add(edge.channel)
        for automaton in self._network.automata:
            if automaton.name not in self.automata and any(
                self._is_seen(edge, sent, received) for edge in automaton.edges
            ):
                self.automata.add(automaton.name)
        return before != (len(self.automata), len(self.variables), len(self._clocks))

    def unnoticed(self) -> Dict[str, FrozenSet[Edge]]:
        """By automaton the edges of the detours of which nothing that matters takes notice."""
        kept = [automaton for automaton in self._network.automata if automaton.name in self.automata]
        tests: Dict[str, Set[FrozenSet[int]]] = defaultdict(set)
        for automaton in kept:
            if automaton.name not in self._tests:
                self._tests[automaton.name] = _tests_of(automaton)
            for name, values in self._tests[automaton.name]:
                tests[name].add(values)
        gone: Dict[str, FrozenSet[Edge]] = defaultdict(frozenset)
        for automaton in kept:
            if automaton.name not in self._detours:
                self._detours[automaton.name] = tuple(detours(automaton, self._network, self._objective))
            away = (one for one in self._detours[automaton.name] if one.is_unnoticed(self.variables, tests))
            unheard = (one for one in away if not self._is_heard(one, automaton.name))
            gone[automaton.name] = frozenset(edge for one in unheard for edge in one.edges)
        return gone

    def _is_heard(self, detour: Detour, robot: str) -> bool:
        """True if another automaton that matters hears that the robot's detour begins or ends."""
        return any(self._others_hear(robot, edge.channel) for edge in detour.edges if edge.channel is not None)

    def _may_go(self, automaton: Automaton, edge: Edge) -> bool:
        """True for an edge that needs a variable which does not matter, and does nothing that does."""
        if self.variables.issuperset(edge.variables) or edge.source != edge.target or edge.resets:
            return False
        if any(name in self.variables for name, _ in edge.assign):
            return False
        if edge.received is not None:
            own = (e for e in automaton.edges if e.received == edge.received and e.source == edge.source)
            return edge.controllable and not any(self.variables.issuperset(e.variables) for e in own)
        return edge.sent is None or not self._others_hear(automaton.name, edge.sent)

    def _others_hear(self, name: str, channel: str) -> bool:
        """True if another automaton that matters has a receiving edge on the channel that does not go."""
        return any(
            receiver != name and receiver in self.automata and self.variables.issuperset(edge.variables)
            for receiver, edge in self._network.receivers.get(channel, ())
        )

    def _is_seen(self, edge: Edge, sent: Set[str], received: Set[str]) -> bool:
        """True for an edge of another automaton that changes something which matters."""
        if any(name in self.variables for name, _ in edge.assign) or not self._clocks.isdisjoint(edge.resets):
            return True
        # One who receives may make the move the environment's.
        return edge.sent in received or (edge.received in sent and not edge.controllable)


def _tests_of(automaton: Automaton) -> AbstractSet[Tuple[str, FrozenSet[int]]]:
    """The variables that edges of the automaton test, with the values for each of which a test holds."""
    return {
        (name, frozenset(test.value for test in clause if test.variable == name))
        for edge in automaton.edges
        for clause in edge.guard.integers
        for name in {test.variable for test in clause}
    }
