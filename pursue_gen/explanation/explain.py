"""Why an objective cannot be met, in the scenario's own words: what would change that, and a play that shows it.

Everything in it was computed: each change was tried by solving again, and the next smaller one as well; every
position of the play is one from which the solver finds the game lost. What the budget was too small for is said to be
so.
"""

from __future__ import annotations

import textwrap
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import listed
from pursue_gen.explanation.changes import Change, findings
from pursue_gen.explanation.endless import Endless, endless
from pursue_gen.explanation.part import (
    Conflict,
    conflict,
    game_of,
    part_of_scenario,
    rules_for,
    statements_of,
    with_one_robot,
)
from pursue_gen.explanation.play import Play, counter_plays
from pursue_gen.explanation.play_lines import Attempt, TimedLine, attempt, describe
from pursue_gen.language.numbers import time_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import unit_name, words_for
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.lost_promises import lost_to_one_walk, quoted
from pursue_gen.solving.one_robot import lost_game
from pursue_gen.solving.rules import Rules
from pursue_gen.solving.without_pauses import verdict_of
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import EXPLAINING, NO_LIMITS, Limits, Listener
from pursue_gen.tga.network import Network

WORK, STATES = 60_000_000, 50_000
"""The work of an explanation, and the discrete states of each of its games: two to four seconds. Measured on lab
scenarios 3, 8, 11 and 20."""

_FEW = 5_000
"""So many discrete states has a scenario at most that is explained as a whole where one part of it is known to be lost.
Measured on the same scenarios."""

_FOR_WHOLE, _FOR_ALL, _FOR_CONFLICT, _FOR_CHANGES, _FOR_ENDLESS = 0.03, 0.5, 0.2, 0.5, 0.1
"""The part of what is left of the budget, where fewer promises are known to be lost, for the scenario as it is, and for
its explanation; for which objectives exclude each other; for changes; and for whether time has to pass. The rest is for
plays. Measured on the same scenarios."""

_FOR_GAME, _FOR_WALK = 0.3, 0.2
"""The parts of the rest for whether a smaller game is lost, and for a play that is one walk. Not measured."""

_LINES, _FIRST_LINES = 10, 3
"""So many lines of a play are shown, and so many of its beginning where it is longer. Not measured."""

_SHOWN = 6
"""So many of the changes are named that do not help. Not measured."""


@dataclass(frozen=True)
class Explanation:
    """Single changes that win, the cheapest first; the utmost changes that were tried and do not; those that were not
    decided within the limits; a play that is lost whatever the controller does (empty: not found within them); what
    else the controller could begin with, and why that fails too; and who prevents the objective without time passing
    (empty: it is prevented in plays in which time passes, or that is not decided). `conflict`: of several objectives
    those that cannot be promised together. `preventing`: whom nobody controls and who acts in the play. `about`: all
    this is about these objectives alone, with nothing else promised; `others`: about others that are lost alone.
    `times_in`: what the times of the play count; `rest`: how long agents rest at places.
    """

    changes: Tuple[Change, ...]
    lost: Tuple[str, ...]
    undecided: Tuple[str, ...]
    play: Tuple[TimedLine, ...]
    attempts: Tuple[Attempt, ...] = ()
    endless: Tuple[Endless, ...] = ()
    conflict: Optional[Conflict] = None
    preventing: Tuple[str, ...] = ()
    about: Tuple[str, ...] = ()
    others: Tuple[Explanation, ...] = ()
    times_in: str = "units"
    rest: str = "1 time unit"


def explain(
    scenario: Scenario,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
    parts: Sequence[Tuple[str, ...]] = (),
) -> Explanation:
    """Explains a scenario that is lost under these rules (that it is lost is not looked at), within the limits.

    Their seconds (none that nobody has set) and their work (WORK where they name none) are for everything, the memory
    and the discrete states (STATES) for each game that is solved, which `progress` reports. `parts`: as in `Lost`;
    where several are lost alone, each is explained alone, and so is a single one where the whole is too large to be
    looked at, or no change is enough for it.
    """
    few = replace(limits.chosen, work=limits.work or WORK, states=limits.states or STATES)
    budget = Budget(few, progress, phase=EXPLAINING)
    if not parts:
        return _explained(scenario, rules, budget)
    if len(parts) == 1 and _is_small(scenario, rules, budget):
        whole = _explained(scenario, rules, budget.split(_FOR_ALL), len(parts[0]) > 1)
        if whole.changes:
            return whole
    found: List[Explanation] = []
    for k, part in enumerate(parts):
        statements = statements_of(scenario, part)
        some = with_one_robot(part_of_scenario(scenario, statements, rules), rules)
        one = _explained(some, rules_for(some, rules), budget.split(1 / (len(parts) - k)), len(part) > 1, part=True)
        found.append(replace(one, about=quoted(statements)))
    return replace(found[0], others=tuple(found[1:]))


def _explained(
    scenario: Scenario, rules: Rules, budget: Budget, conflicting: bool = True, part: bool = False
) -> Explanation:
    """The explanation of what is lost; `conflicting`: it may be that some of its objectives are not to blame; `part`:
    it is part of a scenario that is too large to be looked at."""
    together: Optional[Conflict] = None
    if conflicting and len(scenario.objectives) > 1:
        together = conflict(scenario, rules, budget.split(_FOR_CONFLICT))
    found = findings(scenario, rules, budget.split(_FOR_CHANGES))
    network, objective = game_of(scenario, rules)
    repeating: Tuple[Endless, ...] = ()
    plays: List[Play] = []
    with suppress(LimitHit):
        repeating = endless(network, objective, rules.reaction, budget.split(_FOR_ENDLESS), scenario.rest)
    smaller: Optional[Network] = None
    if objective.goal:  # who wins by one walk shows it best
        smaller = lost_to_one_walk(network, objective, rules.reaction, budget.part())
    elif part:  # or against one robot, with few moves
        smaller = lost_game(network, objective, rules.reaction, budget.split(_FOR_GAME))
    if smaller is not None:
        network, budget = smaller, budget.split(_FOR_WALK) if objective.goal else budget
    with suppress(LimitHit):
        plays.extend(counter_plays(network, objective, rules.reaction, budget, found.helpful, bool(repeating)))
    main = describe(scenario, plays[0]) if plays else ()
    preventing = _preventing(scenario, main)
    if plays and plays[0].end == "open" and not preventing:  # it was cut off before anything is to be seen
        plays, main = [], ()
    attempts = tuple(attempt(scenario, play) for play in plays[1:])
    how = found.changes, found.lost, found.undecided, main, attempts, repeating, together
    times_in = "units" if scenario.unit is None else unit_name(scenario.unit)
    return Explanation(*how, preventing, times_in=times_in, rest=words_for(scenario.rest, scenario.unit))


def _is_small(scenario: Scenario, rules: Rules, budget: Budget) -> bool:
    """True if the whole scenario is decided with little work, and so can be changed in many ways."""
    try:
        verdict_of(budget.split(_FOR_WHOLE, _FEW), *game_of(scenario, rules), rules.reaction)
    except LimitHit:
        return False
    return True


def _preventing(scenario: Scenario, play: Sequence[TimedLine]) -> Tuple[str, ...]:
    """The agents whom nobody controls that do something in the play, as people read their names."""
    acting = {line.who for line in play}
    return tuple(agent.shown for agent in scenario.agents if not agent.controllable and agent.shown in acting)


def render(explanation: Explanation, width: int = 110) -> str:
    """The explanation as lines of text."""
    texts = endless_texts(explanation)
    texts += [explanation.conflict.in_words()] if explanation.conflict else []
    lines = [line for text in texts for line in textwrap.wrap(text, width)]
    if explanation.play:
        lines += [f"{play_title(explanation)} (times in {explanation.times_in}):", *_told(explanation.play)]
    if explanation.changes:
        lines.append(f"Each of these alone would change that, the smallest change first ({how_found(explanation)}):")
        lines += [f"  - {_change(change)}" for change in explanation.changes]
    else:
        lines.append("No single small change that was tried would change that.")
    if explanation.attempts:
        lines.append("What else the robots could begin with, and why that fails:")
        lines += [line for text in attempt_texts(explanation) for line in _wrapped(text, width)]
    lines += _listed("Not enough alone:", explanation.lost, width)
    lines += _listed("Not decided within the limits:", _undecided(explanation), width)
    if explanation.others:
        lines.insert(0, f"{listed(explanation.about)}:")
    for other in explanation.others:
        lines += [f"{listed(other.about)}:", render(other, width).rstrip()]
    return "\n".join(lines) + "\n"


def _undecided(explanation: Explanation) -> Tuple[str, ...]:
    """What was not decided within the limits."""
    return (*(() if explanation.play else ("a play that shows it",)), *explanation.undecided)


def how_found(explanation: Explanation) -> str:
    """How the changes were found."""
    return f"found by solving again{', with nothing else promised' if explanation.about else ''}"


def play_title(explanation: Explanation) -> str:
    """What stands above the play: who prevents the objective in it."""
    who = explanation.preventing
    title = "How it goes wrong, for example"
    return f"{title}: {listed(who)} prevent{'s' if len(who) == 1 else ''} it" if who else title


def _told(play: Sequence[TimedLine]) -> List[str]:
    """The play, of a long one its beginning and its end."""
    times = [time_text(line.at) for line in play]
    widest = max(map(len, times))
    lines = [f"  {at:>{widest}}  {line.who + ': ' if line.who else ''}{line.text}" for at, line in zip(times, play)]
    left_out = len(lines) - _LINES + 1
    if left_out > 1:
        lines[_FIRST_LINES : _FIRST_LINES + left_out] = [f"  {'…':>{widest}}  ({left_out} more steps)"]
    return lines


def endless_texts(explanation: Explanation) -> List[str]:
    """A sentence for each agent without whose actions without end the objective could be met."""
    return [
        f"Only actions without end prevent it: on its ways {one.agent} may do {' and '.join(one.events)} again and "
        f"again, without time passing. If it had to wait for more than {explanation.rest} in between, as at places, it "
        "could be met; give such an event a duration or a location."
        for one in explanation.endless
    ]


def attempt_texts(explanation: Explanation) -> List[str]:
    """What else the robots could begin with, and why that fails: a text for each reason."""
    firsts: Dict[str, List[str]] = {}
    for one in explanation.attempts:
        firsts.setdefault(one.why, []).append(one.first)
    return [f"{', or '.join(texts)}: {why}" for why, texts in firsts.items()]


def _wrapped(text: str, width: int) -> List[str]:
    wrapper = textwrap.TextWrapper(width, initial_indent="  - ", subsequent_indent="    ", break_on_hyphens=False)
    return wrapper.wrap(text)


def as_json(explanation: Explanation) -> Dict[str, Any]:
    """The explanation as a JSON object."""
    return {
        "changes": [_change_json(change) for change in explanation.changes],
        "lost": list(explanation.lost),
        "undecided": list(explanation.undecided),
        "play": [{"at": float(line.at), "who": line.who, "text": line.text} for line in explanation.play],
        "attempts": [asdict(one) for one in explanation.attempts],
        "endless": [asdict(one) for one in explanation.endless],
        "preventing": list(explanation.preventing),
        "about": list(explanation.about),
        "others": [as_json(other) for other in explanation.others],
        "conflict": [one.full_text for one in explanation.conflict.objectives] if explanation.conflict else [],
    }


def _change(change: Change) -> str:
    place = change.span.in_words if change.span else ""
    limit = f"{change.not_enough} is not enough" if change.not_enough else ""
    if not change.least:
        limit += "; what lies between was not decided" if limit else "less was not decided"
    notes = "; ".join(note for note in (limit, place) if note)
    return f"{change.sentence}{f' ({notes})' if notes else ''}"


def _listed(title: str, entries: Tuple[str, ...], width: int) -> List[str]:
    if not entries:
        return []
    some = list(dict.fromkeys(entries))
    more = f"; and {len(some) - _SHOWN} more" if len(some) > _SHOWN else ""
    text = f"{title} {'; '.join(some[:_SHOWN])}{more}."
    return textwrap.wrap(text, width, subsequent_indent="  ", break_on_hyphens=False)


def _change_json(change: Change) -> Dict[str, Any]:
    values = {key: value for key, value in asdict(change).items() if key not in ("span", "not_enough")}
    values.update({key: _value(values[key]) for key in ("before", "after", "next_lost")})
    if change.span is not None:
        values.update(file=change.span.file, line=change.span.line, column=change.span.column)
    return values


def _value(text: str) -> Union[float, str, None]:
    """A value of a change: a number if it is one, None for none, else its text."""
    try:
        number = Fraction(text)
    except ValueError:
        return text or None
    return number.numerator if number.denominator == 1 else float(number)
