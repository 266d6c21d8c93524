"""What can happen in a network while a controller gives some commands and no others.

An edge that only the controller can take, and that no command takes, is dead; so is one that receives from dead edges
alone, one that leaves a location to which no other leads, and one whose guard needs a value that no other gives. Clocks
are not looked at, nor what is so at the same time: more may seem possible than is.
"""

from __future__ import annotations

from typing import AbstractSet, Dict, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple, Union

from pursue_gen.synthesis.strategy import Block
from pursue_gen.tga.network import Edge, Guard, Network

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


_Fact = Tuple[str, Union[str, int]]
"""An automaton and its location, a variable and its value, or "" and a channel on which somebody sends."""


class Extent(NamedTuple):
    """What may be: for each automaton the locations in which it may be, for each variable its values."""

    places: Places
    values: Values


def live(network: Network, commands: Commanded, begin: Optional[Extent] = None) -> Tuple[Network, Extent]:
    """The network without its dead edges, and what it may come to.

    `begin`: what may be at first; None: the initial locations and values.
    """
    taken = network.taken_over
    free: Dict[str, Tuple[Edge, ...]] = {
        automaton.name: tuple(e for e in automaton.edges if _may_begin(automaton.name, e, commands, taken))
        for automaton in network.automata
    }
    if begin is None:
        begin = Extent({a.name: {a.initial} for a in network.automata}, {v: {first} for v, first in network.variables})
    places: Dict[str, Set[str]] = {automaton.name: set(begin.places[automaton.name]) for automaton in network.automata}
    values: Dict[str, Set[int]] = {name: set(begin.values[name]) for name, _ in network.variables}
    sent: Set[str] = set()

    def awaited(name: str, edge: Edge) -> Sequence[_Fact]:
        """What the edge waits for, any of it; nothing where it is possible."""
        if edge.source not in places[name]:
            return [(name, edge.source)]
        if edge.received is not None and edge.received not in sent:
            return [("", edge.received)]
        clause = next((some for some in edge.guard.integers if not may_hold(Guard(integers=(some,)), values)), ())
        return [(test.variable, test.value) for test in clause]

    waiting: Dict[_Fact, List[Tuple[str, Edge]]] = {}
    pending = [(name, edge) for name, edges in free.items() for edge in edges]
    found: Set[Tuple[str, int]] = set()
    while pending:
        name, edge = pending.pop()
        number = name, id(edge)  # to look for an edge by what it says takes long
        facts = () if number in found else awaited(name, edge)
        for fact in facts:
            waiting.setdefault(fact, []).append((name, edge))
        if not facts and number not in found:
            found.add(number)
            places[name].add(edge.target)
            pending += waiting.pop((name, edge.target), ())
            if edge.sent is not None:
                sent.add(edge.sent)
                pending += waiting.pop(("", edge.sent), ())
            for variable, value in edge.assign:
                values[variable].add(value)
                pending += waiting.pop((variable, value), ())
    alive = network.with_each(lambda a: a.with_edges(edge for edge in free[a.name] if (a.name, id(edge)) in found))
    return alive, Extent(places, values)


def may_hold(guard: Guard, values: Values) -> bool:
    """True if the guard's tests of variables may be true with these values; any value where nothing is given."""
    return all(
        any(test.variable not in values or test.value in values[test.variable] for test in clause)
        for clause in guard.integers
    )


def is_controllers(edge: Edge, taken: AbstractSet[str]) -> bool:
    """True for an edge that nobody but the controller can begin; `taken`: see `Network.taken_over`."""
    return edge.is_command and edge.sent not in taken


def _may_begin(automaton: str, edge: Edge, commands: Commanded, taken: AbstractSet[str]) -> bool:
    return not is_controllers(edge, taken) or (automaton, edge) in commands
