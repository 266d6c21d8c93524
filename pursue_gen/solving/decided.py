"""Who wins one of many games that share a budget: changed scenarios, periods that are tried.

The exact game alone does not decide what is large; a strategy in shares or by a policy shows that it is won.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Optional

from pursue_gen.solving.efforts import EFFORTS
from pursue_gen.solving.lost_promises import promises
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.policies import won_by_policy
from pursue_gen.solving.shares import can_be_shared, won_in_shares
from pursue_gen.solving.tours_beside import won_beside_tours
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective

_GUESSED = 0.02
"""The part of what is left that a strategy by a policy may take, for several promises of one robot: a unit of its work
takes five times as long. Measured on a ward and lab 88."""


def strategy_of(
    budget: Budget, network: Network, objective: Objective, reaction: Fraction, share: float, shared: float
) -> Optional[Strategy]:
    """A strategy that wins, None where the game is lost. Raises LimitHit where that `share` of what is left of the
    budget does not decide the exact game, and there is no strategy in shares (with the part `shared` of what is left)
    or by a policy, which are tried before."""
    guess = guessed(budget, network, objective, reaction, shared)
    return guess or verdict_of(budget, network, objective, reaction, share).strategy


def guessed(
    budget: Budget, network: Network, objective: Objective, reaction: Fraction, shared: float, alone: float = _GUESSED
) -> Optional[Strategy]:
    """A strategy in shares (with the part `shared` of what is left of the budget) or by a policy (with the part
    `alone`); None where there is none, or nothing can be guessed."""
    if objective.reaches or len(promises(objective)) <= 1:
        return None
    several, how = can_be_shared(network, objective), (network, objective, reaction)
    # of seconds all that is left: a part of a person's limit would be too short even for what takes no work
    limits = replace(budget.part(shared if several else alone), seconds=budget.part().seconds)
    found = won_beside_tours(*how, SolveOptions(limits))
    if found is None and several:
        found = won_in_shares(*how, SolveOptions(limits), EFFORTS[:2])
    elif found is None:
        found = won_by_policy(*how, limits.work, SolveOptions(limits))
    budget.spend(limits.work if found is None else min(limits.work, found.stats.work))
    return None if found is None else found.strategy
