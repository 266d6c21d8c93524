"""Promises that only one robot can keep, and that it cannot keep together: their game is small, as no other robot is in
it. With fewer promises the controller has less to do, so a loss of these is a loss of all."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Dict, List, Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.lost_promises import only_promises
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import acting_at_most

_WORK, _STATES = 200_000_000, 100_000
"""The work that is spent on all games, and the discrete states that each may have."""

_SHARE = 0.4
"""The part of what is left that one of them gets."""


def lost_for_one(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions
) -> Tuple[Objective, ...]:
    """Promises that only one robot can keep and that it cannot keep together, as few as are found; () where so much
    work finds none."""
    budget = Budget(replace(options.limits, work=_WORK, states=_STATES), options.progress, options.engine)
    owned: Dict[str, List[Place]] = {}
    for place in objective.bad:
        wanted = Objective(Kind.SAFETY, bad=(place,))
        able = commanded_agents(cone_of_influence(only_promises(network, objective, wanted), wanted))
        if len(able) == 1:
            owned.setdefault(able[0], []).append(place)
    for places in owned.values():
        for size in dict.fromkeys((2, len(places))):
            for some in combinations(places, size):
                wanted = Objective(Kind.SAFETY, bad=some)
                game = cone_of_influence(only_promises(network, objective, wanted), wanted)
                try:
                    # The environment need not call more than once.
                    if not budget.verdict(acting_at_most(game, wanted, 1), wanted, reaction, _SHARE).won:
                        return (wanted,)
                except LimitHit:
                    if budget.used_up:
                        return ()
    return ()
