"""What a part of a network may notice of the rest: automata that are hidden, and may be anywhere, with any clocks.

One automaton stands for all of them. In its only location it can do at any time what any of them can ever do to the
part: send what is received there, set its variables, reset its clocks. It never has to, and stops no time. Variables
that the part does not have may have any value: what tests them may happen, or not. So the environment can do all that
it can in the network, and more: what is won against it is won (Ehlers, Mattmüller, Peter, "Combining symbolic
representations for solving timed games", 2010).

Who receives only if a hidden variable is so does it by a move of the environment: right after the one that is received,
where somebody in the part sends it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Dict, Iterator, List, Optional, Sequence, Tuple

from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Network, Test
from pursue_gen.tga.part import variables_of

HIDDEN = "_hidden"
"""The automaton that stands for the hidden ones, and its only location."""


def with_hidden(network: Network, part: Network) -> Network:
    """The part of the network, and what the rest may do to it; the part itself where that is nothing.

    The automaton that stands for the others is the last, where there is one. See `why_not_hidden` and
    `is_loosened` for what cannot be had so.
    """
    loosened = {a.name: tuple(_loosened(network, part, network.automaton(a.name), a)) for a in part.automata}
    kept = tuple(replace(a, edges=(*a.edges, *loosened[a.name])) if loosened[a.name] else a for a in part.automata)
    hidden = tuple(dict.fromkeys(_all_seen(network, part)))
    if hidden:
        kept = (*kept, Automaton(HIDDEN, (Location(HIDDEN),), HIDDEN, hidden))
    elif kept == part.automata:
        return part
    sent = {edge.sync.channel for edge in hidden if edge.sync is not None}
    channels = tuple(channel for channel in network.channels if channel in sent or channel in part.channels)
    return replace(part, automata=kept, channels=channels)


def why_not_hidden(automaton: Automaton, part: Network) -> str:
    """Why an automaton cannot be hidden from the part; "" if it can: what it does when it receives must not matter."""
    variables, clocks = {name for name, _ in part.variables}, set(part.clocks)
    sent = {e.sync.channel for a in part.automata for e in a.edges if e.sync is not None and e.sync.sends}
    for edge in automaton.edges:
        if edge.sync is None or edge.sync.sends:
            continue
        if not edge.controllable and edge.sync.channel in sent:
            return f"takes {edge.sync.channel} out of the controller's hands"
        if not clocks.isdisjoint(edge.resets) or any(name in variables for name, _ in edge.assign):
            return f"changes something that matters when it receives {edge.sync.channel}"
    return ""


def is_loosened(edge: Edge, automaton: Automaton, kept: Automaton) -> bool:
    """True for an edge that the part does not have, because of a hidden variable, and whose tests of that may be left
    out: what the controller does must not depend on them, nor which of several edges is taken, nor an invariant forbid
    where it leads. `kept`: the automaton in the part."""
    if edge.sync is None or edge.sync.sends:
        return not edge.controllable
    (stay,) = (location.invariant for location in automaton.locations if location.name == edge.target)
    rival = any(other.sync == edge.sync and other.source == edge.source for other in kept.edges)
    return edge.controllable and not rival and {bound.clock for bound in stay}.issubset(edge.resets)


def _all_seen(network: Network, part: Network) -> Iterator[Edge]:
    """What the part sees of the hidden automata."""
    kept = {automaton.name for automaton in part.automata}
    variables, clocks = {name for name, _ in part.variables}, set(part.clocks)
    edges = (edge for automaton in part.automata for edge in automaton.edges)
    received = {edge.sync.channel for edge in edges if edge.sync is not None and not edge.sync.sends}
    for automaton in network.automata:
        for edge in automaton.edges if automaton.name not in kept else ():
            if edge.sync is not None and not edge.sync.sends:
                continue
            sync = edge.sync if edge.sync is not None and edge.sync.channel in received else None
            resets = tuple(clock for clock in edge.resets if clock in clocks)
            seen = Edge(HIDDEN, HIDDEN, _tests(edge, variables), sync, _assigned(edge, variables), resets, False)
            if sync is not None or seen.assign or resets:
                yield seen


def _loosened(network: Network, part: Network, automaton: Automaton, kept: Automaton) -> Iterator[Edge]:
    """The edges of an automaton that the part does not have, as moves of the environment: tests of hidden variables may
    hold."""
    variables, there = {name for name, _ in part.variables}, {a.name for a in part.automata}
    found: Dict[Edge, None] = {}
    for edge in automaton.edges:
        if edge in kept.edges or variables.issuperset(variables_of(edge)) or not is_loosened(edge, automaton, kept):
            continue
        guard = _tests(edge, variables, edge.guard.clocks)
        loose = replace(edge, guard=guard, assign=_assigned(edge, variables), controllable=False)
        if edge.sync is None or edge.sync.sends:
            found[loose] = None
        elif loose.assign or loose.resets or loose.source != loose.target:
            for sender, its in _senders(network, edge.sync.channel):
                found[_right_after(network, loose, its if sender in there else None, variables, part.clocks)] = None
    return iter(found)


def _right_after(
    network: Network, edge: Edge, sent: Optional[Edge], variables: AbstractSet[str], clocks: Sequence[str]
) -> Edge:
    """The edge that receives, as a move of its own: after the one that is `sent` in the part, else at any time."""
    assert edge.sync is not None
    edges = (other for automaton in network.automata for other in automaton.edges if other.sync is not None)
    with_it = [e for e in edges if e.sync is not None and e.sync.channel == edge.sync.channel]
    changed = {name for other in with_it for name, _ in other.assign}
    reset = {clock for other in with_it for clock in other.resets}
    bounds = tuple(bound for bound in edge.guard.clocks if bound.clock not in reset)
    tests = tuple(clause for clause in edge.guard.integers if not any(test.variable in changed for test in clause))
    if sent is not None:
        others = {name for other in with_it if other.sync != sent.sync for name, _ in other.assign}
        bounds += tuple(ClockBound(clock, "<=", 0) for clock in sent.resets if clock in clocks)
        tests += tuple((Test(name, value),) for name, value in sent.assign if name in variables - others)
    return replace(edge, sync=None, guard=Guard(bounds, tests))


def _senders(network: Network, channel: str) -> List[Tuple[str, Edge]]:
    return [
        (automaton.name, edge)
        for automaton in network.automata
        for edge in automaton.edges
        if edge.sync is not None and edge.sync.sends and edge.sync.channel == channel
    ]


def _tests(edge: Edge, variables: AbstractSet[str], clocks: Tuple[ClockBound, ...] = ()) -> Guard:
    """The edge's tests of these variables; what may hold for another one is no test."""
    found: Dict[Clause, None] = {}
    for clause in edge.guard.integers:
        if all(test.variable in variables for test in clause):
            found[clause] = None
    return Guard(clocks, tuple(found))


def _assigned(edge: Edge, variables: AbstractSet[str]) -> Tuple[Tuple[str, int], ...]:
    return tuple((name, value) for name, value in edge.assign if name in variables)
