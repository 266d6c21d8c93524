"""The least period of patrols that name none: found by solving, with one period for all of them.

A longer period asks for less. So a period that is lost excludes all shorter ones, and the periods between the longest
that is lost and the shortest that is won are halved. Periods are whole time units. Where the scenario asks for patrols
alone, tours keep one that is known at once (see `tours`); of many places it counts.
"""

from __future__ import annotations

from collections import Counter
from contextlib import suppress
from dataclasses import replace
from math import ceil
from typing import List, Optional, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.language.document import Document, Edit, edited
from pursue_gen.language.for_each import without_owners
from pursue_gen.language.network_names import safety_objective
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Patrol, Scenario
from pursue_gen.language.sentences import periods_found
from pursue_gen.language.times import in_units, written_time
from pursue_gen.language.tokens import Lines, end_of
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.decided import strategy_of
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.passages import period_by_passages
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.tours import PATROL, least_period_of_patrols, period_of_tours
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import Limits, careful_memory
from pursue_gen.tga import scenario_objective, translate

WORK = 200_000_000
"""The work of the search without a limit: half a minute. Then the shortest period won counts. Not measured."""

_LITTLE = 5_000_000
"""The work of a search for `check`: a second at most. Not measured."""

_SHARE, _SHARED = 0.3, 0.1
"""The part of what is left of the budget that one game may take, and that its strategy in shares may. Measured on a
hotel with two lifts."""

_BESIDE_TOURS = 0.02
"""The part of what is left that one exact game may take where tours keep a period, and more is promised: most that are
won then are so by tours, or in shares. Measured on imported buildings: a hotel and a clinic."""

_BESIDE_PASSAGES = 30_000_000
"""The work of the search where orders of passage keep a period: a few seconds. Measured on imported buildings."""

_MANY = 30
"""Where orders of passage keep a period of more places than that, no shorter one is looked for: it takes long, and in
vain. Measured on imported buildings."""

_NEAR = 0.1
"""The part of a period by which it may be too long where shorter ones are not decided. Measured on a hotel with two
lifts."""

_SEARCH = 0.5
"""The part of the seconds that the search may take. Not measured."""

_WALKS = 2
"""The longest period that is tried, per place: walks along all ways and back, with all events. Not measured."""

def without_period(scenario: Scenario) -> Tuple[Patrol, ...]:
    """The patrols whose period is to be found."""
    return tuple(each for each in scenario.patrols if each.every is None)


def with_period(scenario: Scenario, every: int, least: Optional[int] = None) -> Scenario:
    """The scenario with this period, in its text as well, for all patrols without one.

    `least`: nothing below it can be promised, where that is known.
    """
    written = in_units(every, scenario.unit)
    changed = {id(each): replace(each, every=written, least=least) for each in without_period(scenario)}
    edits = {_every(scenario.text, each.span, written) for each in without_period(scenario)}
    text = edited(scenario.text, edits)
    return replace(scenario.with_each(lambda each: changed.get(id(each), each)), text=text)


def _every(text: str, span: Span, every: Number) -> Edit:
    """Writes the period into the statement of a patrol, before the word behind which the robots stand."""
    begin, end = Lines(text).of_span(span)
    words = Document(text[begin:end]).statements[0].tokens
    ahead = without_owners(words)[:-1]
    while ahead[-1].type == "OR":  # by bot1 or bot2
        ahead = ahead[:-2]
    while ahead[-1].type in ("ANY", "OF"):  # by any robot, by any of guards
        ahead = ahead[:-1]
    by = next(n for n, word in enumerate(words) if word is ahead[-1])
    at = begin + end_of(words[by - 1])
    return Edit(at, at, f" every {written_time(every)}")


def least_period(scenario: Scenario, rules: Rules, options: SolveOptions = DEFAULT) -> Scenario:
    """The scenario with the least period that can be promised under these rules in place of each that is missing.

    What is optional does not count.
    Where the search stops early, with the shortest that is known to be won; where none is, with the longest that is
    tried, and a `least` above it where that is lost. Of the options limits, engine and progress count.
    """
    if not without_period(scenario):
        return scenario
    base, limits = scenario.giving_up(scenario.optional), options.limits
    limits = limits if limits.chosen.seconds or limits.work else replace(limits, work=WORK)
    # With the period that is found the scenario is solved and proven: half of the seconds are for that.
    limits = replace(limits, seconds=limits.left * _SEARCH, spent=0.0)
    budget = Budget(limits, options.progress, options.engine, whole=options.whole)
    patrols = base.with_each(lambda each: each if each in without_period(base) else None)
    tours = None if options.whole or base.reach else _of_tours(patrols, rules)  # a goal ends all patrols
    alone = len(patrols.objectives) == len(base.objectives)
    # Nothing below `low` is won; `high` is, where it is `known`.
    low, high = (2, longest(scenario)) if tours is None else tours
    known = tours is not None and alone
    passed = None if alone or options.whole or base.reach else _by_passages(base, rules, SolveOptions(limits))
    if passed is not None:
        high, known = max(low, passed), True
        if len(base.pois) > _MANY:
            return with_period(scenario, high, low)
        limits = replace(limits, work=min(limits.work or _BESIDE_PASSAGES, _BESIDE_PASSAGES))
        budget = Budget(limits, options.progress, options.engine, whole=options.whole)
    elif known and len(base.safety) >= PATROL:
        return with_period(scenario, high, low)
    floor, probe = low, min(high, _farthest(scenario))
    if tours is not None and not alone and passed is None:  # a robot that has something else to do keeps a longer one
        probe, high = high, longest(scenario)
    share = _SHARE if tours is None or alone else _BESIDE_TOURS
    near = 0.0  # where a shorter period is not decided, those that are little longer are hardly
    while floor <= high and not (known and high - floor <= near * high) and not budget.used_up:
        won = _won(base, probe, rules, budget, share)
        near = _NEAR if won is None else near
        if won:
            high, known = probe, True
        else:
            floor = probe + 1  # perhaps not decided: then nothing is lost for sure, but longer ones are decided sooner
            low = low if won is None else floor
        if won is None and passed is not None:
            break
        probe = (floor + high) // 2 if known else min(2 * probe, high)
    return with_period(scenario, high, low)


def _of_tours(scenario: Scenario, rules: Rules) -> Optional[Tuple[int, int]]:
    """A period below which nothing can be promised, and the one that tours keep; None where there are none."""
    tried = with_period(scenario, longest(scenario))
    game = played(translate(tried), rules), scenario_objective(tried), rules.reaction
    every = period_of_tours(*game)
    least = max(2, least_period_of_patrols(*game))
    return None if every is None else (least, max(least, every))


def _by_passages(scenario: Scenario, rules: Rules, options: SolveOptions) -> Optional[int]:
    """A period that robots keep who pass places in an order; None where none is found."""
    tried, looked_for = with_period(scenario, longest(scenario)), without_period(scenario)
    found = {safety_objective(k) for k, each in enumerate(scenario.safety) if each in looked_for}
    game = played(translate(tried), rules), scenario_objective(tried)
    return period_by_passages(*game, found, rules.reaction, options)


def quickly_found(scenario: Scenario) -> List[str]:
    """What little work finds out about the least period in the default game, in sentences; nothing if that is open."""
    limits = Limits(work=_LITTLE, memory=careful_memory())
    found = least_period(scenario, Rules(), SolveOptions(limits=limits))
    patrols = [each for each in found.patrols if each.least is not None]
    decided = [each for each in patrols if each.least is not None and each.least >= each.known_limit]
    return periods_found(found, won=decided[0].least == decided[0].known_limit) if decided else []


def longest(scenario: Scenario) -> int:
    """The longest period that is tried, in time units."""
    moves = sum(window[1] + 2 for agent in scenario.agents for window in scenario.movements(agent).values())
    work = sum(event.window[1] + 2 * (event.split or 1) for event in scenario.events if event.window is not None)
    waiting = sum(assumption.known_number for assumption in scenario.assumptions if assumption.since)
    places = Counter(patrol.span for patrol in without_period(scenario))
    return max(2, ceil(_WALKS * max(places.values(), default=1) * (moves + work + waiting)))


def _farthest(scenario: Scenario) -> int:
    """The longest movement of all: where the search begins."""
    return max((ceil(w[1]) for agent in scenario.agents for w in scenario.movements(agent).values()), default=2)


def _won(scenario: Scenario, every: int, rules: Rules, budget: Budget, share: float) -> Optional[bool]:
    """Whether that period can be promised; None: not decided within the budget, of which the exact game has a part."""
    tried = with_period(scenario, every)
    with suppress(LimitHit), enforced(budget.for_proofs):
        network = played(translate(tried), rules)
        return strategy_of(budget, network, scenario_objective(tried), rules.reaction, share, _SHARED) is not None
    return None
