"""Why an objective cannot be met, in the scenario's own words: what would change that, and a play that shows it.

Everything in it was computed: each change was tried by solving again, and the next smaller one as well; every
position of the play is one from which the solver finds the game lost. What the budget was too small for is said to be
so.
"""

from __future__ import annotations

import textwrap
from dataclasses import asdict, dataclass, replace
from fractions import Fraction
from typing import Any, Dict, List, Optional, Tuple, Union

from pursue_gen.explanation.changes import Change, findings
from pursue_gen.explanation.endless import PAUSE, Endless, endless
from pursue_gen.explanation.play import Play, counter_plays
from pursue_gen.explanation.texts import Attempt, TimedLine, attempt, describe, time_text
from pursue_gen.explanation.together import Conflict, conflict
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.wording import statement_text
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.budget import Budget
from pursue_gen.synthesis.limits import EXPLAINING, NO_LIMITS, Limits, Listener
from pursue_gen.tga import scenario_objective, translate

WORK = 150_000_000
"""The work of an explanation: ten to thirty seconds."""

_FOR_CHANGES, _FOR_ENDLESS, _FOR_CONFLICT = 0.5, 0.05, 0.1
"""The part of the limits that the search for changes may take, whether time has to pass, and which objectives exclude
each other; the rest is for plays."""



@dataclass(frozen=True)
class Explanation:
    """Single changes that win, the cheapest first; the utmost changes that were tried and do not; those that were not
    decided within the limits; a play that is lost whatever the controller does (empty: not found within them); what
    else the controller could begin with, and why that fails too; and who prevents the objective without time passing
    (empty: it is prevented in plays in which time passes, or that is not decided). `conflict`: of several objectives
    those that cannot be promised together.
    """

    changes: Tuple[Change, ...]
    lost: Tuple[str, ...]
    undecided: Tuple[str, ...]
    play: Tuple[TimedLine, ...]
    attempts: Tuple[Attempt, ...] = ()
    endless: Tuple[Endless, ...] = ()
    conflict: Optional[Conflict] = None


def explain(
    scenario: Scenario,
    rules: Rules,
    limits: Limits = NO_LIMITS,
    progress: Optional[Listener] = None,
) -> Explanation:
    """Explains a scenario that is lost under these rules (that it is lost is not looked at), within the limits.

    Their seconds (none that nobody has set) and their work (WORK where they name none) are for everything, the memory
    for each game that is solved, which `progress` reports.
    """
    limits = replace(limits.chosen, work=limits.work or WORK)
    found = findings(scenario, rules, _share(limits, _FOR_CHANGES), progress)
    network, objective = played(translate(scenario), rules), scenario_objective(scenario)
    together: Optional[Conflict] = None
    if len(scenario.objectives) > 1:
        together = conflict(scenario, rules, Budget(_share(limits, _FOR_CONFLICT), progress, phase=EXPLAINING))
    repeating: Tuple[Endless, ...] = ()
    plays: List[Play] = []
    try:
        budget = Budget(_share(limits, _FOR_ENDLESS), progress, phase=EXPLAINING)
        repeating = endless(network, objective, rules.reaction, budget)
    except LimitHit:
        pass
    rest = _share(limits, 1 - _FOR_CHANGES - _FOR_ENDLESS - (_FOR_CONFLICT if together else 0))
    try:
        game = network, objective, rules.reaction
        plays.extend(counter_plays(*game, rest, found.helpful, progress, bool(repeating)))
    except LimitHit:
        pass
    main = describe(scenario, plays[0]) if plays else ()
    attempts = tuple(attempt(scenario, play) for play in plays[1:])
    return Explanation(found.changes, found.lost, found.undecided, main, attempts, repeating, together)


def _share(limits: Limits, share: float) -> Limits:
    """That share of what is left of them."""
    return replace(limits, seconds=limits.left * share, spent=0.0, work=max(1, int(limits.work * share)))


def render(explanation: Explanation, width: int = 110) -> str:
    """The explanation as lines of text."""
    texts = endless_texts(explanation)
    texts += [explanation.conflict.in_words()] if explanation.conflict else []
    lines = [line for text in texts for line in textwrap.wrap(text, width)]
    if explanation.changes:
        lines.append("Each of these alone would change that, the smallest change first (found by solving again):")
        lines += [f"  - {_change(change)}" for change in explanation.changes]
    else:
        lines.append("No single small change that was tried would change that.")
    if explanation.play:
        lines.append("How it goes wrong, for example (times in units):")
        times = [time_text(line.at) for line in explanation.play]
        widest = max(map(len, times))
        for at, line in zip(times, explanation.play):
            lines.append(f"  {at:>{widest}}  {line.who + ': ' if line.who else ''}{line.text}")
    else:
        lines.append("A play that shows it was not found within the limits.")
    if explanation.attempts:
        lines.append("What else the robots could begin with, and why that fails:")
        lines += [line for text in attempt_texts(explanation) for line in _wrapped(text, width)]
    lines += _listed("Not enough alone:", explanation.lost, width)
    lines += _listed("Not decided within the limits:", explanation.undecided, width)
    return "\n".join(lines) + "\n"


def endless_texts(explanation: Explanation) -> List[str]:
    """A sentence for each agent without whose actions without end the objective could be met."""
    return [
        f"Only actions without end prevent it: on its ways {one.agent} may do {' and '.join(one.events)} again and "
        f"again, without time passing. If it had to wait for more than {PAUSE} time unit in between, as at places, it "
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
        "conflict": [statement_text(one) for one in explanation.conflict.objectives] if explanation.conflict else [],
    }


def _change(change: Change) -> str:
    place = f"line {change.span.line}" if change.span else ""
    limit = f"{change.next_lost} is not enough" if change.next_lost != change.before else ""
    if not change.least:
        limit += "; what lies between was not decided" if limit else "less was not decided"
    notes = "; ".join(note for note in (limit, place) if note)
    return f"{change.sentence}{f' ({notes})' if notes else ''}"


def _listed(title: str, entries: Tuple[str, ...], width: int) -> List[str]:
    if not entries:
        return []
    return textwrap.wrap(f"{title} {'; '.join(entries)}.", width, subsequent_indent="  ", break_on_hyphens=False)


def _change_json(change: Change) -> Dict[str, Any]:
    values = {key: value for key, value in asdict(change).items() if key != "span"}
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
