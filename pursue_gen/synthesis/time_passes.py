"""Whether an automaton that nobody commands lets time pass: invariants stop time for all."""

from __future__ import annotations

from typing import Dict, Set, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Location, Network


def lets_time_pass(automaton: Automaton, network: Network) -> bool:
    """True if the environment can let time pass for ever, wherever the automaton has come to without commands.

    At each bound of an invariant there is an edge of the environment that leads away whatever the variables are, and
    each new stay may last a time unit: the clock of the bound is reset on all ways into it.
    """
    bounded = {location.name: location for location in automaton.locations if location.invariant}
    here = bounded.get(automaton.initial)
    if here is not None and network.start and not (
        _starts_within(network, here) and may_be_left(automaton, here, network, from_start=True)
    ):
        return False
    return all(may_be_left(automaton, bounded[name], network) for name in _reached(automaton, network) & {*bounded})


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
        if not edge.controllable or not is_own(edge) or (edge.sync is not None and edge.sync.channel in others):
            onward.setdefault(edge.source, set()).add(edge.target)
    found, pending = {automaton.initial}, [automaton.initial]
    while pending:
        new = onward.get(pending.pop(), set()) - found
        found |= new
        pending += new
    return found


def may_be_left(automaton: Automaton, location: Location, network: Network, from_start: bool = False) -> bool:
    """True if the environment can lead the automaton away at the bound of that location, whatever the variables are,
    and each new stay there may last a time unit; `from_start`: also where it has been there from the network's start,
    at which clocks may differ."""
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
        and is_own(edge)
        and not edge.guard.integers
        and all(
            _holds_at(test, bound) if test.clock == bound.clock else
            not from_start and _has_passed(test, bound, automaton, location, network)
            for test in edge.guard.clocks
        )
        for edge in automaton.edges
    )


def is_own(edge: Edge) -> bool:
    """True for an edge that is taken without anybody's sending."""
    return edge.sync is None or edge.sync.sends


def _holds_at(test: ClockBound, bound: ClockBound) -> bool:
    """True if a guard's test of the clock of a bound is true when the clock is at the bound."""
    value, limit = bound.bound, test.bound
    outcomes = {
        "<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit, "==": value == limit
    }
    return outcomes.get(test.op, False)


def _has_passed(
    test: ClockBound, bound: ClockBound, automaton: Automaton, location: Location, network: Network
) -> bool:
    """True if a guard's test of another clock is true when the clock of the bound, 0 at the beginning of the stay, is
    at the bound: at least as much has passed since that clock was reset, unless a move during the stay resets it, and
    such a move comes in time."""
    if test.op not in (">", ">=") or bound.bound <= test.bound:
        return False
    if any(test.clock in e.resets for a in network.automata if a is not automaton for e in a.edges):
        return False
    loops = (edge for edge in automaton.edges if edge.source == edge.target == location.name)
    alone = (e for e in loops if test.clock in e.resets and bound.clock not in e.resets and not _never(e, network))
    latest = bound.bound - test.bound
    return all(any(b.clock == bound.clock and b.op == "<" and b.bound <= latest for b in e.guard.clocks) for e in alone)


def _never(edge: Edge, network: Network) -> bool:
    """True for an edge that needs values which its variables never have."""
    changed = {name for automaton in network.automata for other in automaton.edges for name, _ in other.assign}
    first = dict(network.variables)
    return any(
        all(test.variable not in changed and first.get(test.variable) != test.value for test in clause)
        for clause in edge.guard.integers
    )


def _starts_within(network: Network, location: Location) -> bool:
    """True if the clocks at the start are within the invariant of the location."""
    tops: Tuple[Tuple[str, Number], ...] = tuple((bound.clock, bound.bound) for bound in location.invariant)
    return all(
        any(c.left == clock and c.right is None and c.bound <= top for c in network.start) for clock, top in tops
    )
