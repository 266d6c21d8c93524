"""What would change the verdict: one small change at a time, tried by solving again.

A number is changed no further than it takes: the change that is named wins, and the next smaller one has been tried too
and does not. (Where wins come and go along the way, a still smaller one may exist.)
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Dict, Optional, Tuple

from pursue_gen.diagnostics import PursueError, Span
from pursue_gen.explanation.number_changes import Repair
from pursue_gen.explanation.part import game_of
from pursue_gen.explanation.repairs import repairs
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import like, written_time
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.cut_off import lost_to_a_stay
from pursue_gen.solving.decided import guessed, strategy_of
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective
from pursue_gen.thresholds import narrowed

_SHARE = 0.5
"""The part of what is left that one attempt may take. Measured on the third ecobot."""

_SHARED = 0.02
"""The part of what is left that a strategy in shares may take. Measured on a depot with three carts, and labs 9, 73 and
181."""

_FOR_GUESSES, _FOR_LIMITS = 0.1, 0.1
"""The part of the budget for strategies in shares or by a policy, where the exact game is too large; of what is left of
it, that for a later deadline, which people ask for first. Measured on a barn with a battery, and on an usher in a
cinema."""

_Game = Tuple[Network, Objective, Fraction]
"""A network, what is wanted in it, and the reaction."""

_PROBES = (11, 19, 31, 63, 127, 255)
"""Where a search for a number that wins looks before the end of a long list: large ones take longer. Not measured."""


_IN_IDEAL = ("ends", "reaction")
"""Changes of the rules that the ideal game has too."""

_WHO_PREVENTS = ("assumption", "control")
"""Changes of what those do whom nobody controls."""

_LIMITS = ("deadline", "within", "after")
"""Changes of what an objective gives as a limit."""

_FIRST, _LAST = (_WHO_PREVENTS, _LIMITS), (("game",), _IN_IDEAL)
"""What is tried before all else, and after it: no robot can play the ideal game."""


@dataclass(frozen=True)
class Change:
    """A change that wins.

    `what` is ends, reaction, slack, game, deadline, after, agent (its pace), duration, latest or earliest (an end of an
    event's window), times, room, open, pause, travel, distance, direction, door, lift, whom, rule, dependency,
    knowledge, start, may_stop, parts, assumption or control; `name` whose; `before` and `after` its values as text;
    `sentence` describes it; `next_lost` is a smaller change, or what is now, that does not win: the next smaller one,
    where the change is known to be the `least`; `not_enough`: the same for people, "" where it is what is now.
    """

    what: str
    name: str
    before: str
    after: str
    sentence: str
    span: Optional[Span] = None
    next_lost: str = ""
    least: bool = True
    not_enough: str = ""


@dataclass(frozen=True)
class Findings:
    """Changes that win, the cheapest first; what was tried to the utmost and does not; what was not decided within the
    limits.

    `helpful`: strategies that win a changed game in which only numbers differ, those first that say most of the game
    as it is.
    """

    changes: Tuple[Change, ...]
    lost: Tuple[str, ...]
    undecided: Tuple[str, ...]
    helpful: Tuple[Strategy, ...] = ()


def findings(scenario: Scenario, rules: Rules, budget: Budget) -> Findings:
    """Tries all that is small, for a scenario that is lost under these rules, within the budget."""
    tried = list(repairs(scenario, rules))
    won: Dict[int, _Win] = {}
    lost: Dict[int, str] = {}
    undecided: Dict[int, str] = {}
    for_guesses = budget.work * _FOR_GUESSES
    ideal = next((k for k, repair in enumerate(tried) if repair.what == "game"), None)
    # What says most comes first. Long lists come last: they make numbers larger, and larger games.
    for k in sorted(range(len(tried)), key=lambda k: (_turn(tried[k]), len(tried[k].values) > _PROBES[0], k)):
        repair = tried[k]
        easier = ideal if repair.what in _IN_IDEAL else None
        if easier in lost:
            lost[k] = repair.say(repair.values[-1])
            continue
        if easier in undecided:
            undecided[k] = repair.label
            continue
        try:
            win = _least(repair, scenario, rules, budget)
        except LimitHit:
            undecided[k] = repair.label
            continue
        except PursueError:  # no scenario has that value
            continue
        if win is None:
            lost[k] = repair.say(repair.values[-1])
        else:
            won[k] = win
    guesses = budget.with_work(for_guesses)
    for k in sorted(undecided, key=lambda k: (_turn(tried[k]), k)):
        share = _FOR_LIMITS if tried[k].what in _LIMITS else _SHARED
        guess = _guess(tried[k], scenario, rules, guesses, share)
        if guess is not None:
            won[k] = guess
            del undecided[k]
    if any(tried[k].what in _IN_IDEAL for k in won):
        won = {k: win for k, win in won.items() if tried[k].what != "game"}
    helps = (k for k in won if tried[k].helps and not won[k].strategy.in_parts)
    helpful = sorted(helps, key=lambda k: (-tried[k].helps, k))
    changes = [_change(tried[k], win) for k, win in sorted(won.items())]
    return Findings(
        tuple(sorted(changes, key=_price)),
        tuple(text for _, text in sorted(lost.items())),
        tuple(text for _, text in sorted(undecided.items())),
        tuple(won[k].strategy for k in helpful),
    )


def _turn(repair: Repair) -> int:
    """What is tried before what: who prevents it, then which deadline would do; how it is played comes last."""
    turns = (*_FIRST, (), *_LAST)
    return next((turn for turn, some in enumerate(turns) if repair.what in some), len(_FIRST))


@dataclass(frozen=True)
class _Win:
    """The value at `high` wins, the one at `low` does not (-1: it is the one that the scenario has)."""

    low: int
    high: int
    strategy: Strategy


def _least(repair: Repair, scenario: Scenario, rules: Rules, budget: Budget) -> Optional[_Win]:
    """The smallest change that wins, between two that have been tried; None: the largest does not.

    At the limits, the smallest that is known. Raises LimitHit when none is.
    """

    def strategy_of(k: int) -> Optional[Strategy]:
        return _strategy(_game(repair, k, scenario, rules), budget, repair.what in _WHO_PREVENTS)

    last = len(repair.values) - 1
    win: Optional[_Win] = None
    low = -1
    for probe in [p for p in _PROBES if p < last] + [last] if last >= _PROBES[0] else [last]:
        strategy = strategy_of(probe)
        if strategy is not None:
            win = _Win(low, probe, strategy)
            break
        low = probe
    if win is None:
        return None
    known = {win.high: win.strategy}

    def wins(k: int) -> Optional[bool]:
        with suppress(LimitHit):
            strategy = strategy_of(k)
            known.update({} if strategy is None else {k: strategy})
            return strategy is not None
        return None

    low, high = narrowed(win.low, win.high, wins)
    return _Win(low, high, known[high])


def _guess(repair: Repair, scenario: Scenario, rules: Rules, budget: Budget, share: float) -> Optional[_Win]:
    """A small change that wins by a strategy in shares or by a policy, where the exact game is too large; None: there
    is no such strategy for the largest. `share`: the part of what is left of the budget for each value."""
    known: Dict[int, Strategy] = {}

    def wins(k: int) -> bool:
        with suppress(PursueError):
            strategy = guessed(budget, *_game(repair, k, scenario, rules), share, share)
            known.update({} if strategy is None else {k: strategy})
        return k in known

    last = len(repair.values) - 1
    if not wins(last):
        return None
    high = narrowed(-1, last, wins)[1]
    return _Win(-1, high, known[high])


def _change(repair: Repair, win: _Win) -> Change:
    value, next_lost = repair.values[win.high], repair.values[win.low] if win.low >= 0 else repair.before
    texts, least = (str(repair.before), str(value), repair.say(value)), win.high - win.low == 1
    other: Any = next_lost
    lost = "" if str(next_lost) == str(repair.before) else written_time(like(other, repair.before))
    return Change(repair.what, repair.name, *texts, repair.span, str(next_lost), least, lost)


def _price(change: Change) -> Tuple[int, Fraction]:
    """Cheap are numbers that hardly change, then what is on or off; what no real robot can do comes last."""
    if change.what in ("ends", "game") or (change.what == "reaction" and not Fraction(change.after)):
        return 2, Fraction(0)
    try:
        small, large = sorted((Fraction(change.before), Fraction(change.after)))
    except ValueError:
        return 1, Fraction(0)
    return (0, large / small) if small else (1, large)


def _strategy(game: _Game, budget: Budget, by_guess: bool) -> Optional[Strategy]:
    """A strategy that wins the changed game, None where it is lost. Raises LimitHit. `by_guess`: also one in shares, or
    by a policy."""
    if lost_to_a_stay(*game[:2]) is not None:
        return None
    verdict = (budget, *game, _SHARE)
    return strategy_of(*verdict, _SHARED) if by_guess else verdict_of(*verdict).strategy


def _game(repair: Repair, k: int, scenario: Scenario, rules: Rules) -> _Game:
    """The game with this value of what is changed."""
    changed = repair.make(repair.values[k])
    some, how = (changed, rules) if isinstance(changed, Scenario) else (scenario, changed)
    return (*game_of(some, how), how.reaction)
