"""What a part of a network may notice of the rest: automata that are hidden, and may be anywhere, with any clocks.

One automaton stands for all of them. In its only location it can do at any time what any of them can ever do to the
part: send what is received there, set its variables, reset its clocks. It never has to, and stops no time. Variables
that the part does not have may have any value: what tests them may happen, or not. So the environment can do all that
it can in the network, and more: what is won against it is won (Ehlers, Mattmüller, Peter, "Combining symbolic
representations for solving timed games", 2010).

Who receives only if a hidden variable is so does it by a move of that automaton: right after the one that is received,
where somebody in the part sends it. The move is not its own: nobody at the bound of an invariant may rely on it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Iterator, Optional, Sequence, Tuple

from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Location, Network, Sync, Test

HIDDEN = "_hidden"
"""The automaton that stands for the hidden ones, and its only location."""


def with_hidden(network: Network, part: Network) -> Network:
    """The part of the network, and what the rest may do to it; the part itself where that is nothing.

    The automaton that stands for the others is the last, where there is one. See `why_not_hidden` and
    `is_loosened` for what cannot be had so.
    """
    hidden = dict.fromkeys(_all_seen(network, part))
    kept = []
    for automaton in part.automata:
        loosened = tuple(_loosened(network, part, network.automaton(automaton.name), automaton))
        hidden.update(dict.fromkeys(told for _, told in loosened if told is not None))
        edges = dict.fromkeys((*automaton.edges, *(edge for edge, _ in loosened)))
        kept.append(replace(automaton, edges=tuple(edges)) if loosened else automaton)
    if hidden:
        kept.append(Automaton(HIDDEN, (Location(HIDDEN),), HIDDEN, tuple(hidden)))
    elif tuple(kept) == part.automata:
        return part
    sent = {edge.channel for edge in hidden if edge.channel is not None}
    channels = [channel for channel in network.channels if channel in sent or channel in part.channels]
    channels += sorted(sent.difference(channels))
    return replace(part, automata=tuple(kept), channels=tuple(channels))


def has_hidden(network: Network) -> bool:
    """True if an automaton of the network stands for hidden ones."""
    return network.automata[-1].name == HIDDEN


def why_not_hidden(automaton: Automaton, part: Network) -> str:
    """Why an automaton cannot be hidden from the part; "" if it can: what it does when it receives must not matter."""
    variables, clocks = {name for name, _ in part.variables}, set(part.clocks)
    for edge in automaton.edges:
        if edge.received is None:
            continue
        if not edge.controllable and edge.received in part.senders:
            return f"takes {edge.received} out of the controller's hands"
        if not clocks.isdisjoint(edge.resets) or any(name in variables for name, _ in edge.assign):
            return f"changes something that matters when it receives {edge.received}"
    return ""


def is_loosened(edge: Edge, automaton: Automaton, kept: Automaton) -> bool:
    """True for an edge that the part does not have, because of a hidden variable, and whose tests of that may be left
    out: what the controller does must not depend on them, nor which of several edges is taken; no invariant may oblige
    anybody to take it, nor forbid where it leads. `kept`: the automaton in the part."""
    if edge.received is None:
        return not edge.controllable and edge.source not in automaton.stays
    stay = automaton.stays.get(edge.target, ())
    rival = any(other.sync == edge.sync and other.source == edge.source for other in kept.edges)
    return edge.controllable and not rival and {bound.clock for bound in stay}.issubset(edge.resets)


def _all_seen(network: Network, part: Network) -> Iterator[Edge]:
    """What the part sees of the hidden automata."""
    kept = {automaton.name for automaton in part.automata}
    variables, clocks = {name for name, _ in part.variables}, set(part.clocks)
    for name, edge in network.edges:
        if name not in kept and edge.received is None:
            sync = edge.sync if edge.sent in part.receivers else None
            resets = tuple(clock for clock in edge.resets if clock in clocks)
            seen = Edge(HIDDEN, HIDDEN, _tests(edge, variables), sync, _assigned(edge, variables), resets, False)
            if sync is not None or seen.assign or resets:
                yield seen


def _loosened(
    network: Network, part: Network, automaton: Automaton, kept: Automaton
) -> Iterator[Tuple[Edge, Optional[Edge]]]:
    """The edges of an automaton that the part does not have, as moves of the environment: tests of hidden variables may
    hold. Each comes with the hidden edge that makes the automaton take it; None: it takes it by itself."""
    variables, there = {name for name, _ in part.variables}, {a.name for a in part.automata}
    known = set(kept.edges)
    for edge in automaton.edges:
        if edge in known or variables.issuperset(edge.variables) or not is_loosened(edge, automaton, kept):
            continue
        guard = _tests(edge, variables, tuple(bound for bound in edge.guard.clocks if bound.clock in part.clocks))
        resets = tuple(clock for clock in edge.resets if clock in part.clocks)
        loose = replace(edge, guard=guard, assign=_assigned(edge, variables), resets=resets)
        if edge.received is None:
            yield loose, None
        elif loose.assign or loose.resets or loose.source != loose.target:
            for sender, its in network.senders.get(edge.received, ()):
                after = _right_after(network, loose, its if sender in there else None, variables, part.clocks)
                channel = "_".join([HIDDEN, automaton.name, *(bound.clock for bound in after.clocks)])
                told = Edge(HIDDEN, HIDDEN, Guard(after.clocks), Sync(channel, sends=True), controllable=False)
                yield replace(loose, guard=Guard(integers=after.integers), sync=Sync(channel, sends=False)), told


def _right_after(
    network: Network, edge: Edge, sent: Optional[Edge], variables: AbstractSet[str], clocks: Sequence[str]
) -> Guard:
    """When an edge that receives may be taken later: at once after the one that is `sent` in the part, else at any time
    at which it may hold what the edge tests."""
    with_it = [e for _, e in network.edges if edge.received in (e.sent, e.received)]
    changed = {name for other in with_it for name, _ in other.assign}
    tests = tuple(clause for clause in edge.guard.integers if not any(test.variable in changed for test in clause))
    if sent is None:
        return Guard(integers=tests)
    others = {name for other in with_it if other.sync != sent.sync for name, _ in other.assign}
    values = tuple((Test(name, value),) for name, value in sent.assign if name in variables - others)
    now = tuple(ClockBound(clock, "<=", 0) for clock in sent.resets if clock in clocks)
    return Guard(now, (*tests, *values))


def _tests(edge: Edge, variables: AbstractSet[str], clocks: Tuple[ClockBound, ...] = ()) -> Guard:
    """The edge's tests of these variables; what may hold for another one is no test."""
    known = (clause for clause in edge.guard.integers if all(test.variable in variables for test in clause))
    return Guard(clocks, tuple(dict.fromkeys(known)))


def _assigned(edge: Edge, variables: AbstractSet[str]) -> Tuple[Tuple[str, int], ...]:
    return tuple((name, value) for name, value in edge.assign if name in variables)
