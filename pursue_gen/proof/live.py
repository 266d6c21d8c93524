"""What can happen in a network while a controller gives some commands and no others.

An edge that only the controller can take, and that no command takes, is dead; so is one that receives from dead edges
alone, and one that leaves a location to which no other leads. Guards are not looked at: more may seem possible than is.
"""

from __future__ import annotations

from dataclasses import replace
from typing import AbstractSet, Dict, Iterable, Mapping, Optional, Set, Tuple

from pursue_gen.synthesis.strategy import Block
from pursue_gen.tga.network import Automaton, Edge, Network

Commanded = AbstractSet[Tuple[str, Edge]]
"""Edges that commands take, each with its automaton: those that send, or move by themselves."""

Places = Mapping[str, AbstractSet[str]]
"""For each automaton the locations in which it may be."""


def commanded(blocks: Iterable[Block]) -> Commanded:
    """The edges that the commands of these blocks take."""
    moves = (command.moves[0] for block in blocks for command in block.commands)
    return {(move.automaton, move.edge) for move in moves}


def live(network: Network, commands: Commanded, begin: Optional[Places] = None) -> Tuple[Network, Places]:
    """The network without its dead edges, and where its automata may come to.

    `begin`: where they may be at first; None: in their initial locations.
    """
    taken = taken_over(network)
    free: Dict[str, Tuple[Edge, ...]] = {
        automaton.name: tuple(e for e in automaton.edges if _may_begin(automaton.name, e, commands, taken))
        for automaton in network.automata
    }
    places: Dict[str, Set[str]] = {a.name: set(begin[a.name] if begin else {a.initial}) for a in network.automata}
    sent: Set[str] = set()
    grown = True
    while grown:
        grown = False
        for name, edges in free.items():
            for edge in edges:
                if edge.source not in places[name] or not _is_possible(edge, sent):
                    continue
                if edge.target not in places[name]:
                    places[name].add(edge.target)
                    grown = True
                if edge.sync is not None and edge.sync.sends and edge.sync.channel not in sent:
                    sent.add(edge.sync.channel)
                    grown = True
    automata = tuple(_with(a, (e for e in free[a.name] if e.source in places[a.name] and _is_possible(e, sent)))
                     for a in network.automata)
    return replace(network, automata=automata), places


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


def _is_possible(edge: Edge, sent: AbstractSet[str]) -> bool:
    return edge.sync is None or edge.sync.sends or edge.sync.channel in sent


def _with(automaton: Automaton, edges: Iterable[Edge]) -> Automaton:
    kept = tuple(edges)
    return automaton if len(kept) == len(automaton.edges) else replace(automaton, edges=kept)
