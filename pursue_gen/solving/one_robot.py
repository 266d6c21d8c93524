"""Promises that only one robot can keep, and that it cannot keep together: their game is small, as no other robot is in
it. With fewer promises the controller has less to do, so a loss of these is a loss of all. What several robots are to
avoid, each of them has to avoid for its part."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from typing import Sequence, Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.freer import asking_only, punctual, standing, with_one_walk, without_others, without_turns
from pursue_gen.solving.lost_promises import only_promises, watched
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.subgoals import commanded_agents
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.cone import cone_of_influence
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.network import Kind, Network, Objective
from pursue_gen.tga.pauses import acting_at_most

_WORK = 200_000_000, 100_000_000
"""The work that is spent on all games, and on one of them."""

_STATE = 2_000
"""A discrete state of one of them costs as much as so much work."""


def lost_for_one(
    network: Network, objective: Objective, reaction: Fraction, options: SolveOptions, work: Sequence[int] = _WORK
) -> Tuple[Objective, ...]:
    """Promises that only one robot can keep and that it cannot keep together, as few as are found; () where so much
    work for all games, and for one of them, finds none."""
    in_all, most = work
    limits = replace(options.limits, work=in_all, states=in_all // _STATE)
    budget = Budget(limits, options.progress, options.engine)
    robots = commanded_agents(network)
    for robot in robots:
        others = frozenset(robots) - {robot}
        alone = without_others(network, objective.bad, others)
        owned = [place for place in objective.bad if _able(alone, objective, place) == (robot,)]
        for size in dict.fromkeys((2, len(owned))) if owned else ():
            for some in combinations(owned, size):
                wanted = Objective(Kind.SAFETY, bad=some)
                game = _game(alone, objective, wanted)
                walks = tuple(with_one_walk(game, watched(wanted)))
                parts = [acting_at_most(walk, wanted, 1) for walk in walks]
                parts += [cone_of_influence(punctual(walk, robot), wanted) for walk in (standing(game), *walks)]
                parts.append(acting_at_most(game, wanted, 1))
                if any(_is_lost(part, wanted, reaction, budget, most) for part in parts):
                    return (wanted,)
                if budget.used_up:
                    return ()
    return ()


def _is_lost(game: Network, wanted: Objective, reaction: Fraction, budget: Budget, most: int) -> bool:
    """True if it is known to be lost. Few moves of the environment are enough as a rule: searches take turns."""
    try:
        return not budget.verdict(game, wanted, reaction, min(1.0, most / max(1.0, budget.work)), first=0).won
    except LimitHit:
        return False


def _able(network: Network, objective: Objective, place: Place) -> Tuple[str, ...]:
    """The robots that can do something about what is to be avoided there."""
    wanted = Objective(Kind.SAFETY, bad=(place,))
    return tuple(commanded_agents(_game(network, objective, wanted)))


def _game(network: Network, objective: Objective, wanted: Objective) -> Network:
    """The game of these promises, in which nobody asks for anything else, and turns of other things are no matter."""
    game = only_promises(network, objective, wanted)
    watching = watched(wanted)
    return cone_of_influence(without_turns(asking_only(game, watching), watching), wanted)
