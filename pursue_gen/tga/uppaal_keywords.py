"""Names that are words of UPPAAL's models: they get another name in its files, and their own when plans are read.

The names of a scenario need not avoid these words: only the files of UPPAAL do.
"""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Dict, Mapping

from pursue_gen.tga.network import Automaton, ClockBound, Constraint, Edge, Guard, Location, Network, Sync

WORDS = frozenset(
    "chan clock bool int commit const urgent broadcast init process state guard sync assign system trans deadlock "
    "imply forall exists typedef struct rate before_update after_update meta priority progress scalar select void "
    "default switch case enum string double hybrid dynamic spawn exit branchpoint".split()
)
"""Words of UPPAAL's models that the language lets people use as names."""


def uppaal_names(network: Network) -> Dict[str, str]:
    """For each name of the network that is a word of UPPAAL the name that it gets there; no other name is like it."""
    used = {automaton.name for automaton in network.automata}
    used |= {location.name for automaton in network.automata for location in automaton.locations}
    used |= {*network.clocks, *network.channels, *(name for name, _ in network.variables)}
    names: Dict[str, str] = {}
    for word in sorted(used & WORDS):
        new = word + "_"
        while new in used:
            new += "_"
        names[word] = new
        used.add(new)
    return names


def renamed(network: Network, names: Mapping[str, str]) -> Network:
    """The network in which these names are other ones; the network itself where there are none."""
    if not names:
        return network

    def called(name: str) -> str:
        return names.get(name, name)

    return Network(
        tuple(map(called, network.clocks)),
        tuple((called(name), value) for name, value in network.variables),
        tuple(map(called, network.channels)),
        tuple(_automaton(automaton, names) for automaton in network.automata),
        tuple(_constraint(constraint, names) for constraint in network.start),
    )


def with_own_names(text: str, network: Network) -> str:
    """A plan for the network in which its own names stand in place of those that it has in UPPAAL's files."""
    for word, new in uppaal_names(network).items():
        text = re.sub(rf"\b{new}\b", word, text)
    return text


def _constraint(constraint: Constraint, names: Mapping[str, str]) -> Constraint:
    left, right = (None if name is None else names.get(name, name) for name in (constraint.left, constraint.right))
    return replace(constraint, left=left, right=right)


def _edge(edge: Edge, names: Mapping[str, str]) -> Edge:
    clauses = (
        tuple(replace(test, variable=names.get(test.variable, test.variable)) for test in clause)
        for clause in edge.guard.integers
    )
    return replace(
        edge,
        source=names.get(edge.source, edge.source),
        target=names.get(edge.target, edge.target),
        guard=Guard(tuple(_bound(bound, names) for bound in edge.guard.clocks), tuple(clauses)),
        sync=edge.sync and Sync(names.get(edge.sync.channel, edge.sync.channel), edge.sync.sends),
        assign=tuple((names.get(name, name), value) for name, value in edge.assign),
        resets=tuple(names.get(clock, clock) for clock in edge.resets),
    )


def _bound(bound: ClockBound, names: Mapping[str, str]) -> ClockBound:
    return replace(bound, clock=names.get(bound.clock, bound.clock))


def _location(location: Location, names: Mapping[str, str]) -> Location:
    invariant = tuple(_bound(bound, names) for bound in location.invariant)
    return replace(location, name=names.get(location.name, location.name), invariant=invariant)


def _automaton(automaton: Automaton, names: Mapping[str, str]) -> Automaton:
    return replace(
        automaton,
        name=names.get(automaton.name, automaton.name),
        locations=tuple(_location(location, names) for location in automaton.locations),
        initial=names.get(automaton.initial, automaton.initial),
        edges=tuple(_edge(edge, names) for edge in automaton.edges),
        home=names.get(automaton.home, automaton.home),
    )
