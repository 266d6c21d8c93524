"""Losses that need no time: an agent of the environment acts again and again at one moment, and nobody else gets to.

On a way an agent may do what takes no time as often as it likes (an edge that stays where it is and resets no clock);
at a place it has to rest in between. Where the objective can be met once that holds on ways
too, it is only such plays that prevent it, in which no time passes.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Dict, Sequence, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Network, Objective

_PAUSE_OF = "@pause_"


@dataclass(frozen=True)
class Endless:
    """An agent, and the events that it may do again and again without time passing."""

    agent: str
    events: Tuple[str, ...]


def endless(
    network: Network, objective: Objective, reaction: Fraction, budget: Budget, rest: Number = 1
) -> Tuple[Endless, ...]:
    """Whose actions without end alone prevent the objective of a lost game; empty if it is lost without them too.

    `rest`: how long agents rest at places, in time units.

    Raises LimitHit where that is not decided within the budget.
    """
    agents = _repeating(cone_of_influence(network, objective))
    if not objective.reaches or not _won_with_pauses(network, objective, reaction, tuple(agents), budget, rest):
        return ()
    needed = tuple(agents)
    for name in agents:
        fewer = tuple(other for other in needed if other != name)
        if _won_with_pauses(network, objective, reaction, fewer, budget, rest):
            needed = fewer
    return tuple(Endless(name, agents[name]) for name in needed)


def may_repeat(edge: Edge) -> bool:
    """True for an edge that the environment may take again and again without time passing."""
    own = edge.sync is None or edge.sync.sends
    return own and not edge.controllable and edge.source == edge.target and not edge.resets


def _repeating(network: Network) -> Dict[str, Tuple[str, ...]]:
    """The automata with such edges, and their channels."""
    found: Dict[str, Tuple[str, ...]] = {}
    for automaton in network.automata:
        channels = (edge.sync.channel for edge in automaton.edges if edge.sync is not None and may_repeat(edge))
        events = tuple(dict.fromkeys(channels))
        if events:
            found[automaton.name] = events
    return found


def _won_with_pauses(
    network: Network, objective: Objective, reaction: Fraction, agents: Sequence[str], budget: Budget, rest: Number
) -> bool:
    """True if the game is won where each of these agents waits before it acts again."""
    if not agents:
        return False  # it is lost as it is
    automata = tuple(_pausing(a, rest) if a.name in agents else a for a in network.automata)
    clocks = (*network.clocks, *(_PAUSE_OF + name for name in agents))
    return budget.verdict(replace(network, clocks=clocks, automata=automata), objective, reaction).won


def _pausing(automaton: Automaton, rest: Number) -> Automaton:
    clock = _PAUSE_OF + automaton.name
    bound = ClockBound(clock, ">", rest)

    def pausing(edge: Edge) -> Edge:
        guard = replace(edge.guard, clocks=(*edge.guard.clocks, bound))
        return replace(edge, guard=guard, resets=(*edge.resets, clock)) if may_repeat(edge) else edge

    return replace(automaton, edges=tuple(pausing(edge) for edge in automaton.edges))
