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
    if here is not None and network.start and not _starts_within(network, here):
        return False
    return all(may_be_left(automaton, bounded[name]) for name in _reached(automaton, network) if name in bounded)


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


def may_be_left(automaton: Automaton, location: Location) -> bool:
    """True if the environment can lead the automaton away at the bound of that location, whatever the variables are,
    and each new stay there may last a time unit."""
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
        and all(_holds_at(test, bound) for test in edge.guard.clocks)
        for edge in automaton.edges
    )


def is_own(edge: Edge) -> bool:
    """True for an edge that is taken without anybody's sending."""
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
