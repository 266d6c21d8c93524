"""The cone of influence of an objective: the part of a network that can matter for who wins.

An automaton is left out if nothing that it does is seen by the others, however indirectly: it writes no variable that
they read, resets no clock of theirs, sends nothing that they receive, and cannot stop time. It may read and receive
whatever it likes. A variable is left out if no edge of the rest needs it: edges that stay where they are, and that set
only such variables, change nothing for the others.

What is left out cannot stop time: wherever it may be, the environment can let as much time pass as it likes. So each
play of the part is one of the network, with or without moves of what is left out, and the part is won if and only if
the network is, moves that change nothing for anybody else counted as none (see `game.JointMove`). Controllable
agents that are left out stay where they are, and those that are not make no detours.

A detour is what a robot begins at a place, ends at the same place, and nobody notices. While it lasts the robot can do
nothing else, and afterwards it rests before it can begin the next thing. Where nobody hears it, no test of others tells
it from staying, and the environment says when it ends, staying is never worse: each move that the robot has after the
detour it has then without it, and others before. So the game without the detours is won if and only if the game is, and
a strategy for it is one for the game. What a detour needs, such as a state that it depends on, then need not matter.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import AbstractSet, Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Set, Tuple

from pursue_gen.tga.ends import is_agent
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network, Objective
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


@dataclass(frozen=True)
class Detour:
    """A robot's detour: the edges that begin it, and those that end it (none where it takes no time).

    `same`: by variable the value at its place and those during the detour; None for one of which nothing is known.
    """

    begins: Tuple[Edge, ...]
    ends: Tuple[Edge, ...]
    same: Tuple[Tuple[str, Optional[FrozenSet[int]]], ...]

    @property
    def edges(self) -> Tuple[Edge, ...]:
        """All of them."""
        return (*self.begins, *self.ends)

    def is_unnoticed(self, variables: AbstractSet[str], tests: Mapping[str, AbstractSet[FrozenSet[int]]]) -> bool:
        """True if no test of these variables can tell it from staying; `tests`: by variable the sets of values for each
        of which some test holds."""
        return all(
            name not in variables
            or (values is not None and all(values <= passes or not values & passes for passes in tests.get(name, ())))
            for name, values in self.same
        )


def detours(automaton: Automaton, network: Network, objective: Objective) -> Iterator[Detour]:
    """What may be a detour of the automaton, as far as it depends on the automaton alone, and on who may take it out of
    the controller's hands."""
    named = {*objective.goal, *objective.bad}
    clocks = automaton.clocks.difference(*(other.clocks for other in network.automata if other is not automaton))
    into: Dict[str, List[Edge]] = defaultdict(list)
    out: Dict[str, List[Edge]] = defaultdict(list)
    for edge in automaton.edges:
        into[edge.target].append(edge)
        out[edge.source].append(edge)
    for here, ways in tuple(out.items()):
        if here in automaton.stays or (automaton.name, here) in named or not all(edge.is_command for edge in ways):
            continue
        hindered: Dict[FrozenSet[str], bool] = {}
        for there in dict.fromkeys(edge.target for edge in ways):
            begins = tuple(edge for edge in ways if edge.target == there)
            ends = () if there == here else tuple(out[there])
            resets = frozenset(clock for edge in (*begins, *ends) for clock in edge.resets)
            if not resets <= clocks or any(edge.sent in network.taken_over for edge in begins):
                continue
            if resets not in hindered:
                hindered[resets] = any(_is_hindered(edge, resets) for edge in ways)
            if hindered[resets]:
                continue
            if there != here and (
                (automaton.name, there) in named
                or there not in automaton.stays
                or any(edge.source != here for edge in into[there])
                or any(edge.target != here or edge.controllable or edge.received is not None for edge in ends)
                or not may_be_left(automaton, there, network)
            ):
                continue
            others = [edge for edge in into[here] if edge not in begins]
            changed = dict.fromkeys(name for edge in (*begins, *ends) for name, _ in edge.assign)
            same = tuple((name, _values(name, network, automaton, here, begins, others)) for name in changed)
            yield Detour(begins, ends if there != automaton.initial else (), same)


def _is_hindered(edge: Edge, clocks: AbstractSet[str]) -> bool:
    """True for a move that may be possible after these clocks were reset, and not without; or that keeps them."""
    return not clocks <= {*edge.resets} or any(
        bound.clock in clocks and bound.op not in (">", ">=") for bound in edge.guard.clocks
    )


def _values(
    name: str, network: Network, automaton: Automaton, here: str, begins: Tuple[Edge, ...], others: List[Edge]
) -> Optional[FrozenSet[int]]:
    """The value of the variable at the place, and those during the detour; None if it is not always the same there."""
    if network.setters[name] != {automaton.name}:
        return None
    at_place = {dict(edge.assign).get(name) for edge in others if edge.source != here or name in edge.variables}
    if automaton.initial == here:
        at_place.add(dict(network.variables).get(name))
    if len(at_place) != 1 or None in at_place:
        return None
    values = {dict(edge.assign).get(name) for edge in begins} | at_place
    return frozenset(value for value in values if value is not None)


def lets_time_pass(automaton: Automaton, network: Network) -> bool:
    """True if the environment can let time pass for ever, wherever the automaton has come to without commands.

    At each bound of an invariant there is an edge of the environment that leads away whatever the variables are, and
    each new stay may last some time: the clock of the bound is reset on all ways into it. (There are finitely many
    bounds, so time goes on for ever.)
    """
    here = automaton.stays.get(automaton.initial, ())
    if here and network.start and not (
        _starts_within(network, here) and may_be_left(automaton, automaton.initial, network, from_start=True)
    ):
        return False
    stays = _reached(automaton, network) & automaton.stays.keys()
    return all(may_be_left(automaton, name, network) for name in stays)


def _reached(automaton: Automaton, network: Network) -> Set[str]:
    """The locations that the automaton may come to if the controller leaves it alone."""
    onward: Dict[str, Set[str]] = {}
    for edge in automaton.edges:
        if not edge.is_command or edge.sent in network.taken_over:
            onward.setdefault(edge.source, set()).add(edge.target)
    found, pending = {automaton.initial}, [automaton.initial]
    while pending:
        new = onward.get(pending.pop(), set()) - found
        found |= new
        pending += new
    return found


def may_be_left(automaton: Automaton, location: str, network: Network, from_start: bool = False) -> bool:
    """True if the environment can lead the automaton away at the bound of that location, whatever the variables are,
    and each new stay there may last some time; `from_start`: also where it has been there from the network's start,
    at which clocks may differ. Requires that the location has a bound."""
    assert location in automaton.stays
    if len(automaton.stays[location]) != 1:
        return False
    (bound,) = automaton.stays[location]
    entering = (edge for edge in automaton.edges if edge.target == location != edge.source)
    if bound.op != "<=" or bound.bound <= 0 or not all(bound.clock in edge.resets for edge in entering):
        return False
    return any(
        edge.source == location != edge.target
        and not edge.controllable
        and edge.received is None
        and not edge.guard.integers
        and all(
            _holds_at(test, bound) if test.clock == bound.clock else
            not from_start and _has_passed(test, bound, automaton, location, network)
            for test in edge.guard.clocks
        )
        for edge in automaton.edges
    )


def _holds_at(test: ClockBound, bound: ClockBound) -> bool:
    """True if a guard's test of the clock of a bound is true when the clock is at the bound."""
    value, limit = bound.bound, test.bound
    outcomes = {
        "<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit, "==": value == limit
    }
    return outcomes.get(test.op, False)


def _has_passed(test: ClockBound, bound: ClockBound, automaton: Automaton, location: str, network: Network) -> bool:
    """True if a guard's test of another clock is true when the clock of the bound, 0 at the beginning of the stay, is
    at the bound: at least as much has passed since that clock was reset, unless a move during the stay resets it, and
    such a move comes in time."""
    if test.op not in (">", ">=") or bound.bound <= test.bound:
        return False
    if any(test.clock in edge.resets for name, edge in network.edges if name != automaton.name):
        return False
    loops = (edge for edge in automaton.edges if edge.source == edge.target == location)
    alone = (e for e in loops if test.clock in e.resets and bound.clock not in e.resets and not _never(e, network))
    latest = bound.bound - test.bound
    return all(any(b.clock == bound.clock and b.op == "<" and b.bound <= latest for b in e.guard.clocks) for e in alone)


def _never(edge: Edge, network: Network) -> bool:
    """True for an edge that needs values which its variables never have."""
    first = {name: value for name, value in network.variables if not network.setters.get(name)}
    return any(all(first.get(test.variable, test.value) != test.value for test in c) for c in edge.guard.integers)


def _starts_within(network: Network, bounds: Iterable[ClockBound]) -> bool:
    """True if the clocks at the start are within these bounds."""
    start = [constraint for constraint in network.start if constraint.right is None]
    return all(any(c.left == bound.clock and c.bound <= bound.bound for c in start) for bound in bounds)
