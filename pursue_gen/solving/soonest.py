"""Quick strategies in the order of time: with all moves allowed, positions are won in the order of their time to the
goal.

First the game without a reaction delay is solved so, which is little work. Its strategy says which moves are needed,
and how soon the goal may be reached. With those moves alone the game with the delay is small as well; it is tried first
with twice the delay. Strategies in the order of time do more at the same time, and so have more cases. Therefore a game
with a slightly later deadline is tried before, which begins with few moves and may have a smaller strategy.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Mapping, Optional

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import pruned, verify
from pursue_gen.proof.worst_case import with_counter, worst_case
from pursue_gen.solving.deadlines import STATES, better, in_units, keeping_to, moves_of, tried
from pursue_gen.solving.least_time import Guarantee
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.solution import Solution, guaranteed
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.solve import Verdict
from pursue_gen.synthesis.strategy import Strategy, ZoneKey
from pursue_gen.tga.network import Network

GAME = 1_000_000
"""The work of each game. Measured on catch the thief, CT1, CT2a and CT4."""

MUCH = Fraction(21, 20)
"""A strategy that takes so many times as long is much slower. Measured on the same scenarios."""

_NEAR = Fraction(21, 20)
"""The deadline for a small strategy: so many times what another strategy takes. Measured on the same scenarios."""

_LARGER = Fraction(4, 3)
"""So many times as many commands are many more. Measured on the same scenarios."""

_PROOF = 8_000
"""Symbolic states of the checker that the proof of a strategy may take. Measured on the same scenarios."""

_EASY = 100_000
"""Where a game in the order of time took no more work, one with a deadline is easy. Measured on the same scenarios."""

_LATE = (2, 1)
"""The parts of the reaction delay of a game: with some to spare, then without. Measured on the same scenarios."""

@dataclass(frozen=True)
class Prompt:
    """A strategy where commands take effect at once: the network with the moves that it needs, what it takes, and
    whether it took little work to find."""

    network: Network
    strategy: Strategy
    ranks: Optional[Mapping[ZoneKey, int]]
    worst: Fraction
    easy: bool


def prompt(won: Solution, budget: Budget, work: int) -> Optional[Prompt]:
    """What the order of time gives without a reaction delay; None where that takes more than so much work."""
    now = Fraction(0)
    verdict = _verdict(won.part, won, now, budget, work)
    if verdict is None or verdict.strategy is None:
        return None
    try:
        how = verdict.ranks, budget.for_proofs
        report = verify(won.part, won.objective, verdict.strategy, now, STATES, None, *how)
    except LimitHit:
        return None
    if not report.ok:
        return None
    strategy = pruned(verdict.strategy, report)
    worst = worst_case(won.part, won.objective, strategy, now, STATES, budget.for_proofs)
    if worst is None:
        return None
    kept = keeping_to(won.part, moves_of(strategy))
    return Prompt(kept, verdict.strategy, verdict.ranks, worst, verdict.stats.work <= _EASY)


def soonest(
    won: Solution, known: Guarantee, first: Prompt, budget: Budget, work: int, options: SolveOptions
) -> Optional[Solution]:
    """A solution that is much quicker than what is known, as `first` is; None: none is found with so much work."""
    start = options.limits.now()

    def small(worst: Fraction) -> Optional[Solution]:
        """A proven solution for a deadline near this time that is much quicker than what is known: games with a
        deadline begin with few moves."""
        deadline = in_units(worst * _NEAR, won)
        if known.worst is not None and deadline * MUCH > known.worst:
            return None
        late = won.reaction * _LATE[0]
        faster, _ = tried(with_counter(first.network), won.objective, late, deadline, budget, work)
        return None if faster is None else better(won, known, faster, options.since(start), _PROOF)

    found = small(first.worst) if first.easy else None
    if found is not None:
        return found
    found = _in_order(won, known, first, budget, work, options.since(start))
    if found is None or found.strategy.size <= _LARGER * won.strategy.size:
        return found
    assert found.guarantee is not None and found.guarantee.worst is not None
    fewer = small(found.guarantee.worst)
    return found if fewer is None or _LARGER * fewer.strategy.size > found.strategy.size else fewer


def _in_order(
    won: Solution, known: Guarantee, first: Prompt, budget: Budget, work: int, options: SolveOptions
) -> Optional[Solution]:
    """The first proven solution that the order of time gives with the moves of `first`."""
    if not won.reaction:
        return _proven(won, known, first.strategy, first.ranks, options)
    for late in _LATE:
        verdict = _verdict(first.network, won, won.reaction * late, budget, work)
        if verdict is None:
            return None
        if verdict.strategy is not None:
            found = _proven(won, known, verdict.strategy, verdict.ranks, options)
            if found is not None:
                return found
    return None


def _verdict(network: Network, won: Solution, reaction: Fraction, budget: Budget, work: int) -> Optional[Verdict]:
    """The verdict with so much work of the budget; None where it is not decided with that."""
    share = min(1.0, work / max(budget.work, 1))
    try:
        return budget.verdict(network, won.objective, reaction, share, soonest=True)
    except LimitHit:
        return None


def _proven(
    won: Solution,
    known: Guarantee,
    strategy: Strategy,
    ranks: Optional[Mapping[ZoneKey, int]],
    options: SolveOptions,
) -> Optional[Solution]:
    """The solution with the strategy; None where that is not proven with little work, or not much quicker."""
    try:
        proven = prove(won.part, won.objective, strategy, won.reaction, ranks, options, states=_PROOF, unranked=False)
    except (NotProven, LimitHit):
        return None
    found = won.with_strategy(proven)
    guarantee = guaranteed(found, STATES, options.limits)
    if guarantee.worst is None or (known.worst is not None and guarantee.worst * MUCH > known.worst):
        return None
    return replace(found, guarantee=replace(guarantee, least=max(known.least, guarantee.least)))
