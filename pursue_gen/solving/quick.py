"""A quicker strategy than the first one, within a fixed budget of work: the default of `solve` and `ws`.

Where the first strategy may take much longer than the lower bound, games with a deadline are solved (`least_time`): at
first without a reaction delay, which is a smaller game. What its strategy needs says which moves to keep to; with those
alone the game with the delay is small as well. Every win is a win of the whole game, in which it is proven.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Iterator, Optional, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.proof.checker import pruned, verify
from pursue_gen.proof.worst_case import with_counter, with_deadline, worst_case
from pursue_gen.solving.least_time import Faster, Guarantee, bounds, decimal, scaled, unscaled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.proving import prove
from pursue_gen.solving.solution import Solution, guaranteed, with_clocks_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Automaton, Edge, Network, Objective
from pursue_gen.zones.scale import least_common_multiple

WORK = 40_000_000
"""The work of the search, a few seconds at most: the same on every machine."""

_PROMPT, _PROMPT_GAME, _DELAYED_GAME = 0.6, 5_000_000, 8_000_000
"""The part of it for games without a reaction delay, and the work of each game without and with one."""

_CLOCKS = 8
"""In games of more clocks each piece of work takes longer: they get less of it."""

STATES = 8_000
"""Symbolic states of the checker that a worst-case time may take."""

_ENOUGH = Fraction(11, 10)
"""A strategy that takes no longer than this part of the lower bound is quick."""

_PRECISION = Fraction(21, 20)
"""The search for a deadline ends where the shortest that is won is so close to the longest that is not."""

_DELAYED = tuple((Fraction(n, 20), late) for n, late in ((21, 2), (21, 1), (22, 1), (24, 1)))
"""What is tried with a reaction delay: parts of the deadline that is kept without, and of the delay (some to spare)."""

_NOT_WITHIN = "SYN023"

_LIMIT_HIT = 5
"""The exit status of errors at a limit."""

_Moves = Set[Tuple[str, Edge]]


def quick(won: Solution, options: SolveOptions) -> Solution:
    """The solution of a reach game with its guarantee, and with a quicker strategy where one is found and proven.

    Of the options limits, engine and progress count. A limit that somebody has set ends the search.
    """
    start, options = time.monotonic(), replace(options, limits=options.limits.chosen)
    known = guaranteed(won, STATES, options.limits)
    if won.strategy.stages or (known.worst is not None and known.worst <= _ENOUGH * known.least):
        return replace(won, guarantee=known)
    limits = options.limits.since(start)
    scale = min(1.0, (_CLOCKS / (len(won.part.clocks) + 1)) ** 3)
    budget = Budget(replace(limits, work=int(WORK * scale)), options.progress, options.engine, whole=options.whole)
    least, kept, moves = _prompt(won, known, budget.split(_PROMPT), int(_PROMPT_GAME * scale))
    known = replace(known, least=max(known.least, least))
    if kept is None:
        return replace(won, guarantee=known)
    some = with_counter(replace(won.part, automata=_keeping_to(won.part, moves)))
    for part, late in _DELAYED:
        deadline = kept * part
        if known.worst is not None and deadline >= known.worst:
            break
        if late > 1 and not won.reaction:
            continue
        faster, _ = _tried(some, won.objective, won.reaction * late, deadline, budget, int(_DELAYED_GAME * scale))
        better = None if faster is None else _better(won, known, faster, options.since(start))
        if better is not None:
            return better
    return replace(won, guarantee=known)


def within(won: Solution, deadline: Fraction, options: SolveOptions) -> Solution:
    """The solution of a reach game with a strategy that comes to the goal within so many time units.

    Raises PursueError with exit status 4 where there is none, and with 5 where that is not decided within the limits.
    """
    start = time.monotonic()
    found = quick(won, options)
    known = found.guarantee
    assert known is not None
    if known.worst is None or known.worst > deadline:
        faster = None
        if deadline >= known.least:
            budget = Budget(options.limits.since(start), options.progress, options.engine, whole=options.whole)
            faster = in_time(with_counter(won.part), won.objective, won.reaction, deadline, budget)
            known = replace(known, least=max(known.least, deadline))
        if faster is None:
            raise PursueError([_too_short(deadline, known)], exit_status=4)
        found = proven_in_time(won, faster, options.since(start))
    return replace(found, within=deadline)


def _too_short(deadline: Fraction, known: Guarantee) -> Diagnostic:
    message = f"the goal cannot be guaranteed within {decimal(deadline)} time units"
    if known.worst is None:
        hint = "it can be reached, but how long that takes at worst was not found out; leave out --within"
    else:
        hint = f"it can be guaranteed within {decimal(known.worst)}: --within {decimal(known.worst)}, or leave it out"
    return error(_NOT_WITHIN, message, hint=hint)


def in_time(
    network: Network, objective: Objective, reaction: Fraction, deadline: Fraction, budget: Budget, share: float = 1.0
) -> Optional[Faster]:
    """A strategy (not proven yet) that comes to the goal within so many time units; None: there is none.

    The network must count the time (see `with_counter`). Raises PursueError with exit status 5 where it is not decided
    with that share of what is left of the budget.
    """
    fine = least_common_multiple((deadline.denominator, reaction.denominator))
    game = with_deadline(scaled(network, fine), objective, int(deadline * fine))
    verdict = budget.verdict(game, objective, reaction * fine, share)
    if verdict.strategy is None:
        return None
    return Faster(game, fine, verdict.strategy, verdict.ranks, deadline)


def proven_in_time(won: Solution, faster: Faster, options: SolveOptions) -> Solution:
    """The solution with the faster strategy, proven with all moves, and what it takes at worst.

    Raises PursueError as `prove` does.
    """
    counted = with_counter(won.part)
    game = with_deadline(scaled(counted, faster.fine), won.objective, int(faster.kept * faster.fine))
    delay = won.reaction * faster.fine
    proven = prove(game, won.objective, faster.strategy, delay, faster.ranks, options)
    strategy = unscaled(proven, counted, faster.fine)
    took = worst_case(counted, won.objective, strategy, won.reaction, STATES, options.limits)
    worst = faster.kept if took is None else min(took, faster.kept)
    guarantee = bounds(counted, won.objective, won.reaction, worst)
    return replace(won, network=with_clocks_of(counted, won.network), strategy=strategy, guarantee=guarantee)


def _better(won: Solution, known: Guarantee, faster: Faster, options: SolveOptions) -> Optional[Solution]:
    """The solution with the faster strategy; None where that is not proven."""
    try:
        found = proven_in_time(won, faster, options)
    except PursueError as problem:
        if problem.exit_status not in (4, _LIMIT_HIT):
            raise
        return None
    assert found.guarantee is not None
    least = max(known.least, found.guarantee.least)
    return replace(found, guarantee=replace(found.guarantee, least=least))


def _tried(
    network: Network, objective: Objective, reaction: Fraction, deadline: Fraction, budget: Budget, work: int
) -> Tuple[Optional[Faster], bool]:
    """What `in_time` finds with so much work of the budget, and whether it is decided with that."""
    try:
        return in_time(network, objective, reaction, deadline, budget, min(1.0, work / max(budget.work, 1))), True
    except PursueError as problem:
        if problem.exit_status != _LIMIT_HIT:
            raise
        return None, False


def _prompt(
    won: Solution, known: Guarantee, budget: Budget, work: int
) -> Tuple[Fraction, Optional[Fraction], _Moves]:
    """A lower bound, a deadline that is kept where commands take effect at once, and the moves that this needs.

    The deadline is None where none was found that is much shorter than what the strategy at hand takes.
    """
    network, now = with_counter(won.part), Fraction(0)
    search = _Bisection(int(bounds(won.part, won.objective, now).least), known.worst)
    best: Optional[Faster] = None
    for deadline in search.deadlines():
        if budget.used_up:
            break
        faster, decided = _tried(network, won.objective, now, Fraction(deadline), budget, work)
        best = faster or best
        search.answer(deadline, faster is not None, decided)
    if best is None:
        return Fraction(search.least), None, set()
    report = verify(best.game, won.objective, best.strategy, now, STATES, ranks=best.ranks)
    if not report.ok:
        return Fraction(search.least), None, set()
    strategy = unscaled(pruned(best.strategy, report), network, best.fine)
    return Fraction(search.least), best.kept, _moves(strategy)


@dataclass
class _Bisection:
    """Integer deadlines to try: `least` and what is below is lost; `floor` and below is lost, or not decided."""

    least: int
    high: Optional[Fraction]

    def __post_init__(self) -> None:
        self.floor = self.least

    def deadlines(self) -> Iterator[int]:
        """The next one to try, until `high` is close to `floor`."""
        while self.high is None or self.high > _PRECISION * self.floor:
            at = 2 * self.floor + 1 if self.high is None else int(self.floor + self.high) // 2
            if at <= self.floor:
                return
            yield at

    def answer(self, deadline: int, won: bool, decided: bool) -> None:
        """Takes in what became of the deadline."""
        if won:
            self.high = Fraction(deadline)
            return
        self.floor = deadline
        self.least = deadline if decided else self.least


def _moves(strategy: Strategy) -> _Moves:
    """The moves that the strategy commands."""
    return {(move.automaton, move.edge) for b in strategy.blocks for c in b.commands for move in c.moves}


def _keeping_to(network: Network, moves: _Moves) -> Tuple[Automaton, ...]:
    """The automata without the commands that are no such moves: what is won without them is won with them."""

    def kept(name: str, edge: Edge) -> bool:
        commanded = edge.controllable and (edge.sync is None or edge.sync.sends)
        return not commanded or (name, edge) in moves

    return tuple(replace(a, edges=tuple(e for e in a.edges if kept(a.name, e))) for a in network.automata)
