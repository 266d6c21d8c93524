"""Games without the pauses of the environment: where agents may call at any time, games are far smaller.

An agent that pauses a time unit after each call has a clock that only keeps it from calling (`tga.pauses`). A strategy
may win without relying on it: it is solved and proven for agents that call as often as they like. There a call that
changes nothing is no move, and makes no command stale. Where that game is not won, nothing is known. Conversely, what
the environment wins with a single call of each agent is lost.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Optional

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT
from pursue_gen.solving.found import Found
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.pauses import acting_at_most, pauses

_FEW = 30_000_000
"""The work that is spent on whether few calls are enough for the environment, about a second. Not measured."""

_FIRST, _PART = 0.02, 0.25
"""The parts of a budget for the game as it is, before others are tried, and for each of these. Not measured."""


def verdict_with(
    game: Network,
    objective: Objective,
    reaction: Fraction,
    work: int,
    options: SolveOptions,
    without_pauses: bool = False,
) -> Optional[Verdict]:
    """The verdict, if it takes no more than so much work."""
    limits = replace(options.limits, work=work, states=max(3000, work // 40))
    how = options.engine, limits, options.progress
    try:
        return solve(game, objective, reaction, *how, without_pauses=without_pauses)
    except LimitHit:
        return None


def won_without_pauses(
    game: Network, objective: Objective, reaction: Fraction, work: int, options: SolveOptions, states: int = LIMIT
) -> Optional[Found]:
    """A proven strategy that leaves the clocks of pauses out; None where so much work finds none, or there are none.

    `states`: the most symbolic states of each look of the checker.
    """
    start = options.limits.now()
    if not pauses(game):
        return None
    verdict = verdict_with(game, objective, reaction, work, options, without_pauses=True)
    if verdict is None or verdict.strategy is None:
        return None
    how = reaction, verdict.ranks, options.since(start)
    try:
        proven = prove(game, objective, verdict.strategy, *how, states=states, otherwise=verdict.cautious)
    except (NotProven, LimitHit):
        return None
    return Found(proven, verdict.stats)


def lost_to_few_calls(game: Network, objective: Objective, reaction: Fraction, options: SolveOptions) -> bool:
    """True if the environment wins even if each agent with pauses calls once at most; False: nothing is known."""
    if not pauses(game):
        return False
    verdict = verdict_with(acting_at_most(game, objective, 1), objective, reaction, _FEW, options)
    return verdict is not None and not verdict.won


def verdict_of(budget: Budget, game: Network, objective: Objective, reaction: Fraction, share: float = 1.0) -> Verdict:
    """The verdict of `budget.verdict`; where agents rest between calls, of a game without rests, or with few calls,
    where that decides it sooner. Raises LimitHit where that share of what is left is too little."""
    if pauses(game):
        few = acting_at_most(game, objective, 1)
        for network, part, free in ((game, _FIRST, False), (game, _PART, True), (few, _PART, False)):
            try:
                verdict = budget.verdict(network, objective, reaction, share * part, without_pauses=free)
            except LimitHit:
                continue
            if (network is game and not free) or verdict.won is free:
                return verdict
    return budget.verdict(game, objective, reaction, share)
