"""Strategies held against the independent checker: only what is proven is used."""

from __future__ import annotations

from fractions import Fraction
from typing import Callable, Mapping, Optional

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT, ProofReport, pruned, pruned_ranks, verify
from pursue_gen.proof.independence import named_part
from pursue_gen.proof.simplify import simplified
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.synthesis.strategy import Strategy, ZoneKey
from pursue_gen.tga.network import Network, Objective

_LITTLE = 6_000
"""A proof of so many states takes a second or two: then one in fewer zones is proven as well. Measured on EB2."""


def prove(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction,
    ranks: Optional[Mapping[ZoneKey, int]] = None,
    options: SolveOptions = DEFAULT,
    simpler: bool = True,
    states: int = LIMIT,
    otherwise: Callable[[], Optional[Strategy]] = lambda: None,
    unranked: bool = True,
    closed: bool = False,
) -> Strategy:
    """The part of the strategy that plays can reach, once the checker has found it winning (with `ranks`: sooner).

    `simpler`: in fewer zones and bounds, proven once more, where that costs little. `states`: the most symbolic states
    that each look of the checker may take. `otherwise` makes a strategy to try where this one does not win; `unranked`:
    it is looked at without ranks, too, where it is not proven with them. `closed`: as for `verify`; it is in few zones
    already. Raises NotProven with the play that breaks it; LimitHit at a limit, the checker's own one on symbolic
    states included.
    """
    start, limits, progress = options.limits.now(), options.limits, options.progress
    report = verify(
        network, objective, strategy, reaction, states, ranks=ranks, limits=limits, progress=progress, closed=closed
    )
    if not report.ok and ranks is not None and unranked:
        ranks = None
        report = verify(network, objective, strategy, reaction, states, limits=limits.since(start), progress=progress)
    another = otherwise() if not report.ok and not report.reason.startswith("limit") else None
    if another is not None:
        again = verify(network, objective, another, reaction, states, limits=limits.since(start), progress=progress)
        strategy, report = (another, again) if again.ok else (strategy, report)
    if report.reason.startswith("limit"):
        hint = "the strategy may win, but only what is proven is used; make the scenario smaller: fewer agents or POIs"
        raise LimitHit([error("SYN010", f"the strategy is not proven: {report.reason}", hint=hint)])
    if not report.ok:
        hint = "this is a fault of the strategy, not of the scenario" + play_that_shows(report)
        raise NotProven([error("SYN020", f"the strategy does not win: {report.reason}", hint=hint)])
    if ranks is not None:
        kept = pruned(strategy, report)
    else:
        kept = reached_part(network, objective, strategy, report, reaction, limits.since(start), states)
    if not simpler or closed or report.states > _LITTLE or kept.in_parts:
        return kept
    left = None if ranks is None else pruned_ranks(strategy, report, ranks)
    try:
        fewer = simplified(named_part(network, kept), kept, reaction, left, limits.since(start))
        again = verify(network, objective, fewer, reaction, 2 * _LITTLE, limits=limits.since(start), progress=progress)
    except LimitHit:
        return kept  # what is proven stays so when there is no time left to simplify it
    if not again.ok:
        return kept
    return reached_part(network, objective, fewer, again, reaction, limits.since(start), 2 * _LITTLE)


def reached_part(
    network: Network, objective: Objective, strategy: Strategy, report: ProofReport, reaction: Fraction,
    limits: Limits = NO_LIMITS, states: int = LIMIT,
) -> Strategy:  # fmt: skip
    """The part of a strategy that plays reach, by a report without ranks; the whole of it where the part is not proven.

    The part wins, too. But it compares clocks with fewer constants, so the checker extrapolates zones further, which is
    not exact where differences of clocks are compared: it may refuse the part, and whoever checks the plan would.
    """
    kept = pruned(strategy, report)
    if not objective.reaches or kept is strategy:
        return kept
    try:
        return kept if verify(network, objective, kept, reaction, states, limits=limits).ok else strategy
    except LimitHit:
        return strategy


def play_that_shows(report: ProofReport) -> str:
    """The play that breaks a strategy, as more lines of a hint; "" where no play was needed to refuse it."""
    return "; the play that shows it:" + "".join(f"\n      {step}" for step in report.play) if report.play else ""
