"""Detours: what a robot begins at a place, ends at the same place, and nobody notices.

While it lasts the robot can do nothing else, and afterwards it rests before it can begin the next thing. Where nobody
hears it, no test of others tells it from staying, and the environment says when it ends, staying is never worse: each
move that the robot has after the detour it has then without it, and others before. So the game without the detours is
won if and only if the game is, and a strategy for it is one for the game. What a detour needs, such as a state that it
depends on, then need not matter.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from typing import AbstractSet, Dict, FrozenSet, Iterator, List, Mapping, Optional, Tuple

from pursue_gen.synthesis.time_passes import may_be_left
from pursue_gen.tga.network import Automaton, Edge, Network, Objective


@dataclass(frozen=True)
class Detour:
    """A robot's detour: the edges that begin it, and those that end it (none where it takes no time).

    `same`: by variable the value at its place and those during the detour; None for one of which nothing is known.
    """

    begins: Tuple[Edge, ...]
    ends: Tuple[Edge, ...]
    same: Tuple[Tuple[str, Optional[FrozenSet[int]]], ...]

    @property
    def edges(self) -> Tuple[Edge, ...]:
        """All of them."""
        return (*self.begins, *self.ends)

    def is_unnoticed(self, variables: AbstractSet[str], tests: Mapping[str, AbstractSet[FrozenSet[int]]]) -> bool:
        """True if no test of these variables can tell it from staying; `tests`: by variable the sets of values for each
        of which some test holds."""
        return all(
            name not in variables
            or (values is not None and all(values <= passes or not values & passes for passes in tests.get(name, ())))
            for name, values in self.same
        )


def detours(automaton: Automaton, network: Network, objective: Objective) -> Iterator[Detour]:
    """What may be a detour of the automaton, as far as it depends on the automaton alone, and on who may take it out of
    the controller's hands."""
    named = {*objective.goal, *objective.bad}
    clocks = automaton.clocks.difference(*(other.clocks for other in network.automata if other is not automaton))
    into: Dict[str, List[Edge]] = defaultdict(list)
    out: Dict[str, List[Edge]] = defaultdict(list)
    for edge in automaton.edges:
        into[edge.target].append(edge)
        out[edge.source].append(edge)
    for here, ways in tuple(out.items()):
        if here in automaton.stays or (automaton.name, here) in named or not all(edge.is_command for edge in ways):
            continue
        hindered: Dict[FrozenSet[str], bool] = {}
        for there in dict.fromkeys(edge.target for edge in ways):
            begins = tuple(edge for edge in ways if edge.target == there)
            ends = () if there == here else tuple(out[there])
            resets = frozenset(clock for edge in (*begins, *ends) for clock in edge.resets)
            if not resets <= clocks or any(edge.sent in network.taken_over for edge in begins):
                continue
            if resets not in hindered:
                hindered[resets] = any(_is_hindered(edge, resets) for edge in ways)
            if hindered[resets]:
                continue
            if there != here and (
                (automaton.name, there) in named
                or there not in automaton.stays
                or any(edge.source != here for edge in into[there])
                or any(edge.target != here or edge.controllable or edge.received is not None for edge in ends)
                or not may_be_left(automaton, there, network)
            ):
                continue
            others = [edge for edge in into[here] if edge not in begins]
            changed = dict.fromkeys(name for edge in (*begins, *ends) for name, _ in edge.assign)
            same = tuple((name, _values(name, network, automaton, here, begins, others)) for name in changed)
            yield Detour(begins, ends if there != automaton.initial else (), same)


def _is_hindered(edge: Edge, clocks: AbstractSet[str]) -> bool:
    """True for a move that may be possible after these clocks were reset, and not without; or that keeps them."""
    return not clocks <= {*edge.resets} or any(
        bound.clock in clocks and bound.op not in (">", ">=") for bound in edge.guard.clocks
    )


def _values(
    name: str, network: Network, automaton: Automaton, here: str, begins: Tuple[Edge, ...], others: List[Edge]
) -> Optional[FrozenSet[int]]:
    """The value of the variable at the place, and those during the detour; None if it is not always the same there."""
    if network.setters[name] != {automaton.name}:
        return None
    at_place = {dict(edge.assign).get(name) for edge in others if edge.source != here or name in edge.variables}
    if automaton.initial == here:
        at_place.add(dict(network.variables).get(name))
    if len(at_place) != 1 or None in at_place:
        return None
    values = {dict(edge.assign).get(name) for edge in begins} | at_place
    return frozenset(value for value in values if value is not None)
