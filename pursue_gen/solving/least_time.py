"""The least worst-case time to the goal, and a strategy that keeps it (`--optimize time`).

What is looked for is v, the infimum of the times that strategies guarantee. Guards are strict in most networks, so v
itself is seldom kept, but every time above it is. Three things enclose it:

- the goal cannot be reached sooner than against a lazy environment (`least_time`): a lower bound, at once; so is v of
  the game without a reaction delay, which is smaller;
- what a strategy at hand takes at worst (`worst_case`) is an upper bound;
- the game with a deadline b, in which the goal may be entered only while a clock that nothing resets is at most b, is
  won where v < b and lost where v > b.

Let 1/k be the unit in which all constants and the reaction are integers. What wins a game is a union of zones with
integer bounds in that unit, whatever value the counting clock starts from, so winning at the start ends at an integer:
v is a multiple of 1/k. A deadline a little above such a multiple, by less than 1/k, therefore decides whether v is
at most the multiple, and a bisection over the multiples finds v itself.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Dict, Mapping, Optional, Tuple

from pursue_gen.language.numbers import Number, at_least, tenths_above, tenths_below
from pursue_gen.language.times import words_for
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.worst_case import with_counter, with_deadline
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.compile_game import compile_game
from pursue_gen.synthesis.relaxed import least_time
from pursue_gen.synthesis.strategy import Strategy, Zone, ZoneKey, with_edges, with_zones
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tga.scale import common_denominator, least_common_multiple, scaled

WORK = 600_000_000
"""The work of the search without a limit: some two minutes. Then the best strategy so far counts. Not measured."""

TOLERANCE = Fraction(1, 10)
"""A strategy that is made for a deadline keeps v and at most so many time units more. Not measured."""

_SHARE = 0.4
"""The part of what is left of the limits that one game of the search may take. Not measured."""

_NEAR = 8
"""A reaction delay that is the unit of the search costs so much or less, as a rule: once per command of a play.
Measured on catch the thief and CT4."""

@dataclass(frozen=True)
class Guarantee:
    """How long a strategy takes at worst, in time units, and v: `least` <= v <= `most` is proven.

    `worst` None: not found out, but not more than `most`. `most` None: nothing is known.
    """

    worst: Optional[Fraction]
    least: Fraction
    most: Optional[Fraction]

    @property
    def exact(self) -> bool:
        """True if v is known."""
        return self.least == self.most

    def in_words(self, unit: Optional[Number] = None) -> str:
        """A line for people, in tenths that hold. `unit`: the seconds of a time unit, where the scenario says that."""
        here = "not found out" if self.worst is None else f"at most {words_for(tenths_above(self.worst), unit)}"
        least = at_least(self.least) if unit is None else words_for(tenths_below(self.least), unit)
        return f"Time to the goal: {here}; nothing below {least} can be promised."

    def as_json(self) -> Dict[str, Any]:
        """For programs: numbers of time units; null where it was not found out."""
        return {
            "worst": None if self.worst is None else float(self.worst),
            "least": float(self.least),
            "most": None if self.most is None else float(self.most),
            "optimal": self.exact,
        }


@dataclass(frozen=True)
class Faster:
    """A strategy that wins `game`, in which the deadline is kept and the time unit is 1/`fine` (not proven yet)."""

    game: Network
    fine: int
    strategy: Strategy
    ranks: Optional[Mapping[ZoneKey, int]]
    kept: Fraction


def bounds(network: Network, objective: Objective, reaction: Fraction, worst: Optional[Fraction] = None) -> Guarantee:
    """What is known of v at once, with a strategy that takes `worst`."""
    game = compile_game(network, objective, reaction)
    least = least_time(game)
    unit, low = game.scale, 0 if least is None else least
    most = None if worst is None else Fraction(max(low, int(worst * unit)), unit)
    return Guarantee(worst, Fraction(low, unit), most)


def fastest(
    network: Network,
    objective: Objective,
    reaction: Fraction,
    known: Optional[Fraction],
    options: SolveOptions = DEFAULT,
) -> Tuple[Guarantee, Optional[Faster]]:
    """Encloses v of a reach game that is won, as closely as the limits allow (WORK where nobody has set one).

    `known`: what a strategy at hand takes at worst; of the options limits, engine and progress count. With it the
    strategy that takes v, or the best one that was found; None: the one at hand is as good.
    """
    limits, unit = options.limits, common_denominator([reaction, *network.times])
    limits = limits if limits.chosen.seconds or limits.work else replace(limits.chosen, work=WORK)
    budget = Budget(limits, options.progress, options.engine, whole=options.whole)
    first, counted = bounds(network, objective, reaction, known), with_counter(network)
    low = int(first.least * unit)
    if reaction and known is not None and not first.exact:
        # Who may be late has no advantage of it, and commands that come at once make a smaller game.
        prompt = bounds(network, objective, Fraction(0), known)
        coarse = common_denominator(network.times)
        search = _LeastTimeSearch(counted, objective, Fraction(0), budget.split(0.5))
        search.run(int(prompt.least * coarse), None if prompt.most is None else int(prompt.most * coarse))
        low = max(low, search.low * (unit // coarse))
    near = low > first.least * unit
    search = _LeastTimeSearch(counted, objective, reaction, budget)
    search.run(low, None if first.most is None else int(first.most * unit), near)
    search.leave_room()
    most = None if search.high is None else Fraction(search.high, unit)
    worst = known if search.faster is None else search.faster.kept
    return Guarantee(worst, Fraction(search.low, unit), most), search.faster


class _LeastTimeSearch:
    """The bisection: `low` <= k * v is proven, k * v <= `high` as well (None: nothing known)."""

    def __init__(self, network: Network, objective: Objective, reaction: Fraction, budget: Budget) -> None:
        self._objective, self._budget = objective, budget
        self._unit = common_denominator([reaction, *network.times])
        self._fine = least_common_multiple((2 * self._unit, TOLERANCE.denominator))
        self._network, self._reaction = scaled(network, self._fine), reaction * self._fine
        self.low = 0
        self.high: Optional[int] = None
        self.faster: Optional[Faster] = None

    def run(self, low: int, high: Optional[int], near: bool = False) -> None:
        """Narrows down what is known already, as far as the budget allows.

        The lower bound is tried first; `near`: what is not far above it, because v is likely to be there.
        """
        self.low, self.high = low, high
        floor, leap = low, _NEAR if near else 1
        while (self.high is None or floor < self.high) and not self._budget.used_up:
            at = floor + leap - 1
            at = at if self.high is None else min(at, (floor + self.high) // 2)
            won = self._won(at)
            if won:
                self.high = at
            else:
                floor = at + 1  # perhaps not decided: then nothing is lost for sure, but larger ones are decided sooner
                self.low = self.low if won is None else floor
            leap = 2 * max(leap, self._unit) if self.high is None or near else self.high

    def leave_room(self) -> None:
        """Makes the strategy that was found anew, for v and the whole tolerance: its windows are wider."""
        deadline = 0 if self.high is None else self.high * self._fine // self._unit + int(TOLERANCE * self._fine)
        if self.faster is not None and Fraction(deadline, self._fine) > self.faster.kept:
            self._met(deadline)

    def _won(self, at: int) -> Optional[bool]:
        """Whether v is at most `at`; None: not decided in its share of what is left."""
        return self._met(at * self._fine // self._unit + 1)

    def _met(self, deadline: int) -> Optional[bool]:
        game = with_deadline(self._network, self._objective, deadline)
        try:
            verdict = self._budget.verdict(game, self._objective, self._reaction, _SHARE)
        except LimitHit:
            return None
        if verdict.strategy is None:
            return False
        kept = Fraction(deadline, self._fine)
        self.faster = Faster(game, self._fine, verdict.strategy, verdict.ranks, kept)
        return True


def unscaled(strategy: Strategy, network: Network, factor: int) -> Strategy:
    """A strategy for `scaled(network, factor)` as one for the network."""
    own = {fine: edge for fine, (_, edge) in zip(scaled(network, factor).edges, network.edges)}

    def zone(one: Zone) -> Zone:
        return tuple(replace(constraint, bound=constraint.bound / factor) for constraint in one)

    return replace(strategy, blocks=with_edges(with_zones(strategy.blocks, zone), own))
