"""A quicker strategy than the first one, within a fixed budget of work: the default of `solve` and `ws`.

Where the first strategy may take much longer than the lower bound, the game is solved in the order of time (`soonest`).
Where that is too much work, games with a deadline are solved (`deadlines`): at first without a reaction delay, which is
a smaller game. What its strategy needs says which moves to keep to; with those alone the game with the delay is small,
too. Every win is a win of the whole game, in which it is proven.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Iterator, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, error
from pursue_gen.language.numbers import at_most, decimal_text
from pursue_gen.outcomes import LimitHit, TooSlow
from pursue_gen.proof.checker import pruned, verify
from pursue_gen.proof.worst_case import with_counter
from pursue_gen.solving import soonest
from pursue_gen.solving.deadlines import (
    STATES,
    Moves,
    better,
    in_time,
    in_units,
    keeping_to,
    moves_of,
    proven_in_time,
    tried,
)
from pursue_gen.solving.least_time import Faster, Guarantee, bounds, unscaled
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.solution import Solution, guaranteed
from pursue_gen.synthesis.budget import Budget

WORK = 40_000_000
"""The work of the search, a few seconds at most: the same on every machine. Measured on catch the thief and drug
delivery."""

_DISCRETE_STATES = 30_000
"""The most discrete states of its games with few clocks: larger ones take long, whatever work is counted. Measured on
20 officers who chase a thief."""

_DISCRETE_STATES_OF_BOUND = 100_000
"""Those of the one game that gives a lower bound. Measured on the same scenarios."""

_PROMPT, _PROMPT_GAME, _DELAYED_GAME = 0.6, 5_000_000, 8_000_000
"""Games with a deadline: the part of the work for those without a reaction delay, and that of each without and with.
Measured on catch the thief and drug delivery."""

_CLOCKS = 8
"""In games of more clocks each piece of work takes longer: they get less of it. Not measured."""

_HARD = 20_000_000
"""A game that took more work than this has none left for games with a deadline, which are larger. Measured on CT3b."""

_MANY = 2 * _DISCRETE_STATES
"""Nor has one of so many discrete states: games with a deadline have about as many. Measured on a chase through a ring
of 150 places."""

_ENOUGH = Fraction(11, 10)
"""A strategy that takes no longer than this part of the lower bound is quick. Not measured."""

_DELAYED = tuple((Fraction(n, 20), late) for n, late in ((21, 2), (21, 1), (22, 1), (24, 1)))
"""What is tried with a reaction delay: parts of the deadline that is kept without, and of the delay (some to spare)."""

_PRECISION = Fraction(21, 20)
"""The search for a deadline ends where the shortest won is so close to the longest not won. Not measured."""

_UNDECIDED = 2
"""So many undecided games in a row end the search while no deadline is known to be kept. Not measured."""

_NOT_WITHIN = "SYN023"


def quick(won: Solution, options: SolveOptions) -> Solution:
    """The solution of a reach game with its guarantee, and with a quicker strategy where one is found and proven.

    Of the options limits, engine and progress count. A limit that somebody has set ends the search.
    """
    start, options = options.limits.now(), replace(options, limits=options.limits.chosen)
    known = guaranteed(won, STATES, options.limits)
    stats = won.stats
    hard = stats is not None and (stats.work > _HARD or stats.discrete_states > _MANY)
    if hard or won.strategy.in_parts or (known.worst is not None and known.worst <= _ENOUGH * known.least):
        return replace(won, guarantee=known)
    scale = min(1.0, (_CLOCKS / (len(won.part.clocks) + 1)) ** 3)
    budget = _budget(options.since(start), WORK, _DISCRETE_STATES, scale)
    work = int(soonest.GAME * scale)
    first = soonest.prompt(won, budget, work)
    if first is not None:
        found = soonest.soonest(won, known, first, budget, work, options.since(start))
        if found is None and known.worst is not None and first.worst * soonest.MUCH > known.worst:
            found = replace(won, guarantee=known)
        if found is not None:
            return _bounded(found, options.since(start), scale) if first.easy else found
    found, decided = _in_less_time(won, known, scale, options.since(start), in_vain=first is None)
    return _bounded(found, options.since(start), scale) if first is None and decided else found


def _budget(options: SolveOptions, work: int, states: int, scale: float) -> Budget:
    """A budget of that part of the work, for games of that part of the states."""
    limits = replace(options.limits, work=int(work * scale), states=int(states * scale))
    return Budget(limits, options.progress, options.engine, whole=options.whole)


def _bounded(won: Solution, options: SolveOptions, scale: float) -> Solution:
    """The solution with a better lower bound, where a game with a deadline gives one, without a reaction delay."""
    known = won.guarantee
    if known is None or known.worst is None:
        return won
    budget = _budget(options, _PROMPT_GAME, _DISCRETE_STATES_OF_BOUND, scale)
    for part in (_PRECISION, _ENOUGH):
        deadline = Fraction(int(known.worst / part))
        if deadline <= known.least:
            return won
        faster, decided = tried(with_counter(won.part), won.objective, Fraction(0), deadline, budget, _PROMPT_GAME)
        if not decided:
            return won
        if faster is None:
            return replace(won, guarantee=replace(known, least=deadline))
    return won


def _in_less_time(
    won: Solution, known: Guarantee, scale: float, options: SolveOptions, in_vain: bool
) -> Tuple[Solution, bool]:
    """The solution with a strategy for a deadline that is much shorter than what the one at hand takes, or with that,
    and whether games with a deadline are decided with so much work.

    `scale`: the part of the work that games of so many clocks get; `in_vain`: a game was tried, and nothing was found.
    """
    start, budget = options.limits.now(), _budget(options, WORK, _DISCRETE_STATES, scale)
    least, kept, moves, decided = _prompt(won, known, budget.split(_PROMPT), int(_PROMPT_GAME * scale), in_vain)
    known = replace(known, least=max(known.least, least))
    if kept is None:
        return replace(won, guarantee=known), decided
    some = with_counter(keeping_to(won.part, moves))
    for part, late in _DELAYED:
        deadline = in_units(kept * part, won)
        if known.worst is not None and deadline >= known.worst:
            break
        if late > 1 and not won.reaction:
            continue
        faster, _ = tried(some, won.objective, won.reaction * late, deadline, budget, int(_DELAYED_GAME * scale))
        found = None if faster is None else better(won, known, faster, options.since(start))
        if found is not None:
            return found, decided
    return replace(won, guarantee=known), decided


def within(won: Solution, deadline: Fraction, options: SolveOptions) -> Solution:
    """The solution of a reach game with a strategy that comes to the goal within so many time units.

    Raises TooSlow where there is none, LimitHit where that is not decided within the limits.
    """
    start = options.limits.now()
    found = quick(won, options)
    known = found.guarantee
    assert known is not None
    if known.worst is None or known.worst > deadline:
        faster = None
        if deadline >= known.least:
            budget = Budget(options.since(start).in_one_piece, options.progress, options.engine, whole=options.whole)
            faster = in_time(with_counter(won.part), won.objective, won.reaction, deadline, budget)
            known = replace(known, least=max(known.least, deadline))
        if faster is None:
            raise TooSlow([_too_short(deadline, known)])
        found = proven_in_time(won, faster, options.since(start))
    return replace(found, within=deadline)


def _too_short(deadline: Fraction, known: Guarantee) -> Diagnostic:
    message = f"the goal cannot be guaranteed within {decimal_text(deadline)} time units"
    if known.worst is None:
        hint = "it can be reached, but how long that takes at worst was not found out; leave out --within"
    else:
        hint = f"it can be guaranteed within {at_most(known.worst)}: --within {at_most(known.worst)}, or leave it out"
    return error(_NOT_WITHIN, message, hint=hint)


def _prompt(
    won: Solution, known: Guarantee, budget: Budget, work: int, in_vain: bool
) -> Tuple[Fraction, Optional[Fraction], Moves, bool]:
    """A lower bound, a deadline that is kept where commands take effect at once, the moves that this needs, and whether
    the games were decided.

    The deadline is None where none was found that is much shorter than what the strategy at hand takes.
    """
    network, now = with_counter(won.part), Fraction(0)
    search = _Bisection(int(bounds(won.part, won.objective, now).least), known.worst, int(in_vain))
    best: Optional[Faster] = None
    for deadline in search.deadlines():
        if budget.used_up or not search.is_easy:
            break
        faster, decided = tried(network, won.objective, now, Fraction(deadline), budget, work)
        best = faster or best
        search.answer(deadline, faster is not None, decided)
    if best is None:
        return Fraction(search.least), None, frozenset(), search.is_easy
    try:
        report = verify(best.game, won.objective, best.strategy, now, STATES, None, best.ranks, budget.for_proofs)
    except LimitHit:
        return Fraction(search.least), None, frozenset(), search.is_easy
    if not report.ok:
        return Fraction(search.least), None, frozenset(), search.is_easy
    strategy = unscaled(pruned(best.strategy, report), network, best.fine)
    return Fraction(search.least), best.kept, moves_of(strategy), search.is_easy


@dataclass
class _Bisection:
    """Integer deadlines to try: `least` and what is below is lost; `floor` and below is lost, or not decided.

    `undecided`: so many games in a row were not decided.
    """

    least: int
    high: Optional[Fraction]
    undecided: int

    def __post_init__(self) -> None:
        self.floor = self.least
        self._any_won = False

    @property
    def is_easy(self) -> bool:
        """False once deadlines are not decided though longer ones were tried: so it goes on as a rule."""
        return self._any_won or self.undecided < _UNDECIDED

    def deadlines(self) -> Iterator[int]:
        """The next one to try, until `high` is close to `floor`."""
        while self.high is None or self.high > _PRECISION * self.floor:
            at = 2 * self.floor + 1 if self.high is None else int(self.floor + self.high) // 2
            if at <= self.floor:
                return
            yield at

    def answer(self, deadline: int, won: bool, decided: bool) -> None:
        """Takes in what became of the deadline."""
        self._any_won = self._any_won or won
        self.undecided = 0 if decided else self.undecided + 1
        if won:
            self.high = Fraction(deadline)
            return
        self.floor = deadline
        self.least = deadline if decided else self.least
