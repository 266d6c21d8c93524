"""How late commands may come: the margin of a strategy, and that of a game.

The margin of a strategy is the largest delay with which it still wins, counted from the instant at which a command is
due (the first one at which its zone holds), as the checker finds it. That of a game is the largest reaction with which
there is a winning strategy at all; a strategy that was made for a smaller one need not stand it.

Both are searched for on a grid of STEP time units, up to CAP. More delay only adds plays, so what wins with some delay
wins with less.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Callable, Dict, Optional

from pursue_gen.language.numbers import Number
from pursue_gen.language.times import words_for
from pursue_gen.outcomes import LimitHit
from pursue_gen.proof.checker import LIMIT, verify
from pursue_gen.proof.independence import named_part
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.synthesis.solve import solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.thresholds import narrowed

STEP = Fraction(1, 20)
"""The precision, in time units: the message of a busy robot takes about so long. Not measured."""

CAP = Fraction(10)
"""The search ends there: no machine is so late (the default reaction is a hundredth of it). Not measured."""

USUAL = 3_000
"""States for `strategy_margin` that are worth a second. Not measured."""

@dataclass(frozen=True)
class Margin:
    """It wins with a delay of `wins`, and not with one of `fails`, which is longer (time units).

    `fails` None: no such delay is known; either `wins` is CAP, or the search was ended before it found one.
    """

    wins: Fraction
    fails: Optional[Fraction]

    def __post_init__(self) -> None:
        assert self.fails is None or 0 <= self.wins < self.fails

    def as_json(self) -> Dict[str, Any]:
        """For programs: numbers of time units, null where no failing delay is known."""
        return {"wins": float(self.wins), "fails": None if self.fails is None else float(self.fails)}


def strategy_margin(
    network: Network,
    objective: Objective,
    strategy: Strategy,
    reaction: Fraction,
    states: int = LIMIT,
    limits: Limits = NO_LIMITS,
) -> Margin:
    """The margin of a strategy. Requires that it is proven for the reaction; ensures that the margin is no smaller.

    `states` is what all the looks together may cost, in symbolic states of the checker (not a time: the answer must not
    depend on the machine), within the limits. Where that is used up the margin is at least what was found, and
    where so few states cannot tell, of a strategy with more blocks, at least the reaction.
    """
    if len(strategy.blocks) > states:  # each takes a state where plays come to it
        return Margin(reaction, None)
    part = named_part(network, strategy)
    left, start = states, limits.now()

    def wins(delay: Fraction) -> Optional[bool]:
        nonlocal left
        if left <= 0:
            return None
        report = verify(part, objective, strategy, delay, limit=left, prompt=True, limits=limits.since(start))
        left -= report.states
        return None if report.reason.startswith("limit") else report.ok

    return _largest(wins, reaction)


def game_margin(network: Network, objective: Objective, reaction: Fraction, limits: Limits = NO_LIMITS) -> Margin:
    """The margin of a game, as far as it is found within the limits. Requires that it is won with the reaction; ensures
    that the margin is no smaller."""
    start = limits.now()

    def wins(delay: Fraction) -> bool:
        return solve(network, objective, delay, limits=limits.since(start)).won

    return _largest(wins, reaction)


def _largest(wins: Callable[[Fraction], Optional[bool]], known: Fraction) -> Margin:
    """The last point of the grid where `wins`, which is None where it is not known, and the first where not."""
    assert known >= 0
    end = int(CAP / STEP)

    def fails(point: int) -> Optional[bool]:
        try:
            won = wins(point * STEP)
        except LimitHit:
            return None
        return None if won is None else not won

    if known >= CAP or fails(end) is False:
        return Margin(max(known, CAP), None)
    low, high, stride = int(known // STEP), end, 1
    while low + stride < high:
        failed = fails(low + stride)
        if failed is None:
            return Margin(max(known, low * STEP), None)
        low, high, stride = (low, low + stride, stride) if failed else (low + stride, high, 2 * stride)
    low, high = narrowed(low, high, fails)
    return Margin(max(known, low * STEP), high * STEP)


def in_words(margin: Margin) -> str:
    """The margin in few words."""
    if margin.fails is None:
        return f"at least {_decimal(margin.wins)}"
    return f"{_decimal(margin.wins)}, not {_decimal(margin.fails)}"


def describe(margin: Margin, strategy: Strategy, unit: Optional[Number] = None) -> str:
    """What the margin of the strategy means, in one or two sentences; what no robot can play is called so.

    `unit`: the seconds of a time unit, where the scenario says that.
    """
    if margin.wins == 0 and margin.fails is not None:
        late = f"Margin 0: it loses when a command takes effect {_late(margin.fails, unit)} late"
        return f"{late}; this is an ideal strategy that no real robot can play."
    rest = "and perhaps later"
    if margin.fails is not None:
        rest = f"not {_decimal(margin.fails) if unit is None else words_for(margin.fails, unit)}"
    late = f"Margin: it still wins when commands take effect {_late(margin.wins, unit)} late, {rest}."
    if decides_ends(strategy):
        return f"{late} But it decides when movements and actions end, which no real robot lets it do."
    return late


def decides_ends(strategy: Strategy) -> bool:
    """True if it commands ends of movements or actions, as the original's do; a real robot reports them."""
    return any(command.moves[0].edge.is_end for block in strategy.blocks for command in block.commands)


def _late(value: Fraction, unit: Optional[Number]) -> str:
    return f"{_decimal(value)} time units" if unit is None else words_for(value, unit)


def _decimal(value: Fraction) -> str:
    return f"{float(value):g}"
