"""The cone of influence of an objective: the part of a network that can matter for who wins.

An automaton is left out if nothing that it does is seen by the others, however indirectly: it writes no variable that
they read, resets no clock of theirs, sends nothing that they receive, and cannot stop time. It may read and receive
whatever it likes. A variable is left out if no edge of the rest needs it: edges that stay where they are, and that set
only such variables, change nothing for the others.

What is left out cannot stop time: wherever it may be, the environment can let as much time pass as it likes. So each
play of the part is one of the network, with or without moves of what is left out, and the part is won if and only if
the network is, moves that change nothing for anybody else counted as none (see `game.JointMove`). Controllable
agents that are left out stay where they are.
"""

from __future__ import annotations

from typing import Dict, Set, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Location, Network, Objective
from pursue_gen.tga.part import part_of


def cone_of_influence(network: Network, objective: Objective) -> Network:
    """The part of the network that the objective depends on; the network itself where that is all of it."""
    cone = _Cone(network, objective)
    while cone.grow():
        pass
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
        self.automata.update(a.name for a in network.automata if not _lets_time_pass(a, network))
        self.variables: Set[str] = set()
        self._clocks: Set[str] = set()

    def grow(self) -> bool:
        """Take in what the part depends on by one step more; False if that is nothing."""
        before = len(self.automata), len(self.variables), len(self._clocks)
        received: Set[str] = set()
        sent: Set[str] = set()
        for automaton in self._network.automata:
            if automaton.name not in self.automata:
                continue
            self._clocks |= automaton.clocks
            for edge in automaton.edges:
                if not self._may_go(automaton, edge):
                    self.variables.update(edge.variables)
                    if edge.sync is not None:
                        (sent if edge.sync.sends else received).add(edge.sync.channel)
        for automaton in self._network.automata:
            if automaton.name not in self.automata and any(
                self._is_seen(edge, sent, received) for edge in automaton.edges
            ):
                self.automata.add(automaton.name)
        return before != (len(self.automata), len(self.variables), len(self._clocks))

    def _may_go(self, automaton: Automaton, edge: Edge) -> bool:
        """True for an edge that needs a variable which does not matter, and does nothing that does."""
        if self.variables.issuperset(edge.variables) or edge.source != edge.target or edge.resets:
            return False
        if any(name in self.variables for name, _ in edge.assign):
            return False
        if edge.sync is None:
            return True
        listeners = (a for a in self._network.automata if a.name in self.automata)
        if edge.sync.sends:
            return not any(self._hears(other, edge) for other in listeners if other is not automaton)
        return edge.controllable and not self._hears(automaton, edge, edge.source)

    def _hears(self, automaton: Automaton, sender: Edge, source: str = "") -> bool:
        """True if the automaton has a receiving edge on the channel of the other edge that does not go."""
        return any(
            edge.sync is not None
            and sender.sync is not None
            and not edge.sync.sends
            and edge.sync.channel == sender.sync.channel
            and source in ("", edge.source)
            and self.variables.issuperset(edge.variables)
            for edge in automaton.edges
        )

    def _is_seen(self, edge: Edge, sent: Set[str], received: Set[str]) -> bool:
        """True for an edge of another automaton that changes something which matters."""
        if any(name in self.variables for name, _ in edge.assign) or not self._clocks.isdisjoint(edge.resets):
            return True
        if edge.sync is None:
            return False
        if edge.sync.sends:
            return edge.sync.channel in received
        return edge.sync.channel in sent and not edge.controllable  # the move is the environment's because of it


def _lets_time_pass(automaton: Automaton, network: Network) -> bool:
    """True if the environment can let time pass for ever, wherever the automaton has come to without commands.

    At each bound of an invariant there is an edge of the environment that leads away whatever the variables are, and
    each new stay may last a time unit: the clock of the bound is reset on all ways into it.
    """
    bounded = {location.name: location for location in automaton.locations if location.invariant}
    here = bounded.get(automaton.initial)
    if here is not None and network.start and not _starts_within(network, here):
        return False
    return all(_may_be_left(automaton, bounded[name]) for name in _reached(automaton, network) if name in bounded)


def _reached(automaton: Automaton, network: Network) -> Set[str]:
    """The locations that the automaton may come to if the controller leaves it alone."""
    others = {
        edge.sync.channel
        for other in network.automata
        for edge in other.edges
        if edge.sync is not None and not edge.sync.sends and not edge.controllable
    }
    onward: Dict[str, Set[str]] = {}
    for edge in automaton.edges:
        if not edge.controllable or not _own(edge) or (edge.sync is not None and edge.sync.channel in others):
            onward.setdefault(edge.source, set()).add(edge.target)
    found, pending = {automaton.initial}, [automaton.initial]
    while pending:
        new = onward.get(pending.pop(), set()) - found
        found |= new
        pending += new
    return found


def _may_be_left(automaton: Automaton, location: Location) -> bool:
    if len(location.invariant) != 1:
        return False
    bound = location.invariant[0]
    entering = (edge for edge in automaton.edges if edge.target == location.name != edge.source)
    if bound.op != "<=" or bound.bound < 1 or not all(bound.clock in edge.resets for edge in entering):
        return False
    return any(
        edge.source == location.name
        and edge.target != location.name
        and not edge.controllable
        and _own(edge)
        and not edge.guard.integers
        and all(_holds_at(test, bound) for test in edge.guard.clocks)
        for edge in automaton.edges
    )


def _own(edge: Edge) -> bool:
    return edge.sync is None or edge.sync.sends


def _holds_at(test: ClockBound, bound: ClockBound) -> bool:
    """True if a guard's test is true when the clock is at the bound."""
    value, limit = bound.bound, test.bound
    outcomes = {
        "<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit, "==": value == limit
    }
    return test.clock == bound.clock and outcomes.get(test.op, False)


def _starts_within(network: Network, location: Location) -> bool:
    """True if the clocks at the start are within the invariant of the location."""
    tops: Tuple[Tuple[str, Number], ...] = tuple((bound.clock, bound.bound) for bound in location.invariant)
    return all(
        any(c.left == clock and c.right is None and c.bound <= top for c in network.start) for clock, top in tops
    )
