"""Games with a deadline: strategies that come to the goal within so many time units, and the moves that they need."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import ceil
from typing import FrozenSet, Optional, Tuple

from pursue_gen.outcomes import LimitHit, NotProven
from pursue_gen.proof.checker import LIMIT
from pursue_gen.proof.worst_case import with_counter, with_deadline, worst_case
from pursue_gen.solving.least_time import Faster, Guarantee, bounds, fastest, unscaled
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.solution import Solution, check_goal, guaranteed, solution
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Edge, Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple, scaled

STATES = 20_000
"""Symbolic states of the checker that a worst-case time may take. Not measured."""

Moves = FrozenSet[Tuple[str, Edge]]
"""Edges of agents."""


def in_units(time: Fraction, won: Solution) -> Fraction:
    """The least deadline from this time on that is a multiple of the game's unit, in which its constants and its
    reaction are integers: the bounds of the strategy are multiples, too."""
    unit = common_denominator([won.reaction, *won.part.times])
    return Fraction(ceil(time * unit), unit)


def in_time(
    network: Network, objective: Objective, reaction: Fraction, deadline: Fraction, budget: Budget, share: float = 1.0
) -> Optional[Faster]:
    """A strategy (not proven yet) that comes to the goal within so many time units; None: there is none.

    The network must count the time (see `with_counter`). Raises LimitHit where it is not decided
    with that share of what is left of the budget.
    """
    fine = least_common_multiple((deadline.denominator, reaction.denominator))
    game = with_deadline(scaled(network, fine), objective, int(deadline * fine))
    verdict = budget.verdict(game, objective, reaction * fine, share)
    if verdict.strategy is None:
        return None
    return Faster(game, fine, verdict.strategy, verdict.ranks, deadline)


def proven_in_time(won: Solution, faster: Faster, options: SolveOptions, states: int = LIMIT) -> Solution:
    """The solution with the faster strategy, proven with all moves, and what it takes at worst.

    `states`: the most symbolic states of each look of the checker. Raises PursueError as `prove` does.
    """
    counted = with_counter(won.part)
    game = with_deadline(scaled(counted, faster.fine), won.objective, int(faster.kept * faster.fine))
    delay = won.reaction * faster.fine
    proven = prove(game, won.objective, faster.strategy, delay, faster.ranks, options, states=states)
    strategy = unscaled(proven, counted, faster.fine)
    took = worst_case(counted, won.objective, strategy, won.reaction, STATES, options.limits)
    worst = faster.kept if took is None else min(took, faster.kept)
    guarantee = bounds(counted, won.objective, won.reaction, worst)
    found = won.with_strategy(strategy)
    return replace(found, network=_with_clocks_of(counted, won.network), guarantee=guarantee)


def _with_clocks_of(counted: Network, network: Network) -> Network:
    """The network with the clock that was added to a part of it."""
    added = tuple(clock for clock in counted.clocks if clock not in network.clocks)
    start = tuple(c for c in counted.start if c.left in added)
    return replace(network, clocks=(*network.clocks, *added), start=(*network.start, *start)) if added else network


def fastest_solution(network: Network, objective: Objective, rules: Rules, options: SolveOptions = DEFAULT) -> Solution:
    """As `solution`, with the proven strategy that takes the least time to the goal at worst, as far as it is found.

    Raises as `solution`, and with exit status 2 for an objective without a goal. A limit that is hit after the first
    strategy ends the search, and the best one that is proven counts.
    """
    check_goal(objective, "--optimize time")
    start, limits = options.limits.now(), options.limits.chosen
    won = solution(network, objective, rules, options)
    known = guaranteed(won, STATES, limits.since(start))
    more = replace(options, limits=limits.since(start))
    found, faster = fastest(won.part, objective, rules.reaction, known.worst, more)
    if faster is None:
        return replace(won, guarantee=found)
    try:
        fast = proven_in_time(won, faster, replace(options, limits=limits.since(start)))
    except LimitHit:
        return replace(won, guarantee=replace(found, worst=known.worst, most=known.most))
    took = fast.guarantee
    assert took is not None
    most = max(found.least, min(each.most for each in (took, found) if each.most is not None))
    return replace(fast, guarantee=replace(found, worst=took.worst, most=most))


def better(
    won: Solution, known: Guarantee, faster: Faster, options: SolveOptions, states: int = LIMIT
) -> Optional[Solution]:
    """The solution with the faster strategy; None where that is not proven in looks of so many symbolic states."""
    try:
        found = proven_in_time(won, faster, options, states)
    except (NotProven, LimitHit):
        return None
    assert found.guarantee is not None
    least = max(known.least, found.guarantee.least)
    return replace(found, guarantee=replace(found.guarantee, least=least))


def tried(
    network: Network, objective: Objective, reaction: Fraction, deadline: Fraction, budget: Budget, work: int
) -> Tuple[Optional[Faster], bool]:
    """What `in_time` finds with so much work of the budget, and whether it is decided with that."""
    try:
        return in_time(network, objective, reaction, deadline, budget, min(1.0, work / max(budget.work, 1))), True
    except LimitHit:
        return None, False


def moves_of(strategy: Strategy) -> Moves:
    """The moves that the strategy commands."""
    return frozenset((move.automaton, move.edge) for b in strategy.blocks for c in b.commands for move in c.moves)


def keeping_to(network: Network, moves: Moves) -> Network:
    """The network without the commands that are no such moves: what is won without them is won with them."""
    return network.with_each(
        lambda a: a.with_edges(edge for edge in a.edges if not edge.is_command or (a.name, edge) in moves)
    )
