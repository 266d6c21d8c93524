"""Whether an automaton that nobody commands lets time pass: invariants stop time for all."""

from __future__ import annotations

from typing import AbstractSet, Dict, Iterable, Set

from pursue_gen.tga.network import Automaton, ClockBound, Network


def lets_time_pass(automaton: Automaton, network: Network) -> bool:
    """True if the environment can let time pass for ever, wherever the automaton has come to without commands.

    At each bound of an invariant there is an edge of the environment that leads away whatever the variables are, and
    each new stay may last a time unit: the clock of the bound is reset on all ways into it.
    """
    here = automaton.stays.get(automaton.initial, ())
    if network.start and not _starts_within(network, here):
        return False
    return all(may_be_left(automaton, name) for name in _reached(automaton, network) if name in automaton.stays)


def taken_over(network: Network) -> AbstractSet[str]:
    """The channels whose moves are the environment's because of one who receives."""
    return {edge.received for _, edge in network.edges if edge.received is not None and not edge.controllable}


def _reached(automaton: Automaton, network: Network) -> Set[str]:
    """The locations that the automaton may come to if the controller leaves it alone."""
    others = taken_over(network)
    onward: Dict[str, Set[str]] = {}
    for edge in automaton.edges:
        if not edge.is_command or edge.sent in others:
            onward.setdefault(edge.source, set()).add(edge.target)
    found, pending = {automaton.initial}, [automaton.initial]
    while pending:
        new = onward.get(pending.pop(), set()) - found
        found |= new
        pending += new
    return found


def may_be_left(automaton: Automaton, location: str) -> bool:
    """True if the environment can lead the automaton away at the bound of that location, whatever the variables are,
    and each new stay there may last a time unit. Requires that the location has a bound."""
    if len(automaton.stays[location]) != 1:
        return False
    (bound,) = automaton.stays[location]
    entering = (edge for edge in automaton.edges if edge.target == location != edge.source)
    if bound.op != "<=" or bound.bound < 1 or not all(bound.clock in edge.resets for edge in entering):
        return False
    return any(
        edge.source == location != edge.target
        and not edge.controllable
        and edge.received is None
        and not edge.guard.integers
        and all(_holds_at(test, bound) for test in edge.guard.clocks)
        for edge in automaton.edges
    )


def _holds_at(test: ClockBound, bound: ClockBound) -> bool:
    """True if a guard's test is true when the clock is at the bound."""
    value, limit = bound.bound, test.bound
    outcomes = {
        "<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit, "==": value == limit
    }
    return test.clock == bound.clock and outcomes.get(test.op, False)


def _starts_within(network: Network, bounds: Iterable[ClockBound]) -> bool:
    """True if the clocks at the start are within these bounds."""
    start = [constraint for constraint in network.start if constraint.right is None]
    return all(any(c.left == bound.clock and c.bound <= bound.bound for c in start) for bound in bounds)
