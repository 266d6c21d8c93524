"""A plan for the time in which somebody who is late is waited for: what can be done meanwhile is done.

The first strategy that wins may as well wait: it does all the rest when the late one has come. One that comes to the
goal as soon as can be guaranteed, however late that is, does the rest before.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from typing import Dict, Optional

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.worst_case import with_clock_limit, worst_case
from pursue_gen.solving.least_time import bounds
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.synthesis.limits import Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.thresholds import narrowed

_WORK = 20_000_000
"""The work of one game with a deadline: about a second. Not measured."""

_STATES = 20_000
"""The symbolic states of each look of the checker. Not measured."""


def sooner(strategy: Strategy, network: Network, objective: Objective, reaction: Fraction, limits: Limits) -> Strategy:
    """The strategy, or a proven one that comes to the goal sooner at worst: as soon as can be guaranteed in whole time
    units, as far as little work finds that. Only clocks that the network has are looked at."""
    clock = _counter(network)
    if not objective.reaches or clock is None or strategy.in_parts:
        return strategy
    worst = worst_case(network, objective, strategy, reaction, _STATES, limits)
    if worst is None:
        return strategy
    begin = next(each.bound for each in network.start if (each.left, each.right) == (clock, None))
    known: Dict[int, Strategy] = {}

    def found(deadline: int) -> bool:
        game = with_clock_limit(network, objective, clock, ceil(begin) + deadline)
        within = _within(game, objective, reaction, limits)
        known.update({} if within is None else {deadline: within})
        return within is not None

    _, least = narrowed(floor(bounds(network, objective, reaction).least), ceil(worst), found)
    return known.get(least, strategy)


def _within(game: Network, objective: Objective, reaction: Fraction, limits: Limits) -> Optional[Strategy]:
    little = replace(limits, work=_WORK)
    try:
        verdict = solve(game, objective, reaction, limits=little)
        if verdict.strategy is None:
            return None
        options = SolveOptions(little)
        return prove(game, objective, verdict.strategy, reaction, verdict.ranks, options, states=_STATES)
    except (LimitHit, NotProven):
        return None


def _counter(network: Network) -> Optional[str]:
    """A clock that no edge resets and whose value at the start is bounded; None if there is none."""
    resets = {clock for automaton in network.automata for edge in automaton.edges for clock in edge.resets}
    bounded = {each.left for each in network.start if each.right is None}
    return next((clock for clock in network.clocks if clock in bounded - resets), None)
