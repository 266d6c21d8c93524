"""Whether an automaton that nobody commands lets time pass: invariants stop time for all."""

from __future__ import annotations

from typing import Dict, Iterable, Set

from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network


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
