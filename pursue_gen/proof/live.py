"""What can happen in a network while a controller gives some commands and no others.

An edge that only the controller can take, and that no command takes, is dead; so is one that receives from dead edges
alone, one that leaves a location to which no other leads, and one whose guard needs a value that no other gives. Clocks
are not looked at, nor what is so at the same time: more may seem possible than is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Dict, Iterable, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_gen.synthesis.strategy import Block
from pursue_gen.tga.network import Automaton, Edge, Guard, Network

Commanded = AbstractSet[Tuple[str, Edge]]
"""Edges that commands take, each with its automaton: those that send, or move by themselves."""

Places = Mapping[str, AbstractSet[str]]
"""For each automaton the locations in which it may be."""

Values = Mapping[str, AbstractSet[int]]
"""For each variable the values that it may have."""


def commanded(blocks: Iterable[Block]) -> Commanded:
    """The edges that the commands of these blocks take."""
    moves = (command.moves[0] for block in blocks for command in block.commands if command.moves)
    return {(move.automaton, move.edge) for move in moves}


class Extent(NamedTuple):
    """What may be: for each automaton the locations in which it may be, for each variable its values."""

    places: Places
    values: Values


def live(network: Network, commands: Commanded, begin: Optional[Extent] = None) -> Tuple[Network, Extent]:
    """The network without its dead edges, and what it may come to.

    `begin`: what may be at first; None: the initial locations and values.
    """
    taken = taken_over(network)
    free: Dict[str, Tuple[Edge, ...]] = {
        automaton.name: tuple(e for e in automaton.edges if _may_begin(automaton.name, e, commands, taken))
        for automaton in network.automata
    }
    if begin is None:
        begin = Extent({a.name: {a.initial} for a in network.automata}, {v: {first} for v, first in network.variables})
    places: Dict[str, Set[str]] = {automaton.name: set(begin.places[automaton.name]) for automaton in network.automata}
    values: Dict[str, Set[int]] = {name: set(begin.values[name]) for name, _ in network.variables}
    sent: Set[str] = set()

    def is_possible(name: str, edge: Edge) -> bool:
        if edge.source not in places[name] or not may_hold(edge.guard, values):
            return False
        return edge.sync is None or edge.sync.sends or edge.sync.channel in sent

    grown = True
    while grown:
        grown = False
        for name, edges in free.items():
            for edge in edges:
                if not is_possible(name, edge):
                    continue
                if edge.target not in places[name]:
                    places[name].add(edge.target)
                    grown = True
                if edge.sync is not None and edge.sync.sends and edge.sync.channel not in sent:
                    sent.add(edge.sync.channel)
                    grown = True
                for variable, value in edge.assign:
                    if value not in values[variable]:
                        values[variable].add(value)
                        grown = True
    automata = tuple(_with(a, (edge for edge in free[a.name] if is_possible(a.name, edge))) for a in network.automata)
    return replace(network, automata=automata), Extent(places, values)


def may_hold(guard: Guard, values: Values) -> bool:
    """True if the guard's tests of variables may be true with these values; any value where nothing is given."""
    return all(
        any(test.variable not in values or test.value in values[test.variable] for test in clause)
        for clause in guard.integers
    )


def taken_over(network: Network) -> Set[str]:
    """The channels whose moves are the environment's because of one who receives."""
    return {
        edge.sync.channel
        for automaton in network.automata
        for edge in automaton.edges
        if edge.sync is not None and not edge.sync.sends and not edge.controllable
    }


def is_controllers(edge: Edge, taken: AbstractSet[str]) -> bool:
    """True for an edge that nobody but the controller can begin; `taken`: see `taken_over`."""
    return edge.controllable and (edge.sync is None or (edge.sync.sends and edge.sync.channel not in taken))


def _may_begin(automaton: str, edge: Edge, commands: Commanded, taken: AbstractSet[str]) -> bool:
    return not is_controllers(edge, taken) or (automaton, edge) in commands


def _with(automaton: Automaton, edges: Iterable[Edge]) -> Automaton:
    kept = tuple(edges)
    return automaton if len(kept) == len(automaton.edges) else replace(automaton, edges=kept)
