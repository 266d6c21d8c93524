"""Promises that cannot be kept even where nothing else is wanted: alone, or two of which one robot has to keep both.

With fewer promises the controller has less to do, so a loss of these is a loss of all.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Edge, Kind, Network, Objective
from pursue_gen.tga.part import part_of
from pursue_gen.tga.pauses import acting_at_most
from pursue_runtime.locations import is_movement

WORK = 60_000_000
"""The work that is spent on all games of one or two promises."""

_SHARE = 0.1
"""The part of what is left that one of them gets."""

_STATES = 20_000
"""So many discrete states it may have."""


def lost_promises(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Tuple[Place, ...]:
    """One or two of the places that a safety objective is to avoid, of which it is known that nobody can avoid them;
    () where little work finds none."""
    budget = Budget(replace(options.limits, work=WORK, states=_STATES), options.progress, options.engine)
    for size in (1, 2):
        for places in combinations(objective.bad, size):
            game, wanted = only_promises(network, objective, places), Objective(Kind.SAFETY, bad=places)
            for part in (acting_at_most(_standing(game), wanted, 1), game):
                try:
                    won = verdict_of(budget, part, wanted, reaction, _SHARE).won
                except LimitHit:
                    if budget.used_up:
                        return ()
                    continue
                if not won:
                    return places
                if part is game:
                    break
    return ()


def _standing(network: Network) -> Network:
    """The network in which agents whom nobody controls go nowhere: the environment need not begin a movement."""

    def stands(edge: Edge) -> bool:
        return edge.controllable or not is_movement(edge.target)

    automata = (replace(a, edges=tuple(filter(stands, a.edges))) for a in network.automata)
    return replace(network, automata=tuple(automata))


def only_promises(network: Network, objective: Objective, places: Tuple[Place, ...]) -> Network:
    """The network without the automata of other promises: these only watch, and time stops where they are broken."""
    others = {name for name, _ in objective.bad}.difference(name for name, _ in places)
    names = {automaton.name for automaton in network.automata} - others
    return part_of(network, names, {name for name, _ in network.variables})
