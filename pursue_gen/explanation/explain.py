"""Why an objective cannot be met, in the scenario's own words: what would change that, and a play that shows it.

Everything in it was computed: each change was tried by solving again, and the next smaller one as well; every
position of the play is one from which the solver finds the game lost. What the budget was too small for is said to be
so.
"""

from __future__ import annotations

import textwrap
from dataclasses import asdict, dataclass, replace
from typing import Any, Dict, List, Optional, Tuple

from pursue_gen.diagnostics import PursueError
from pursue_gen.explanation.changes import Change, findings
from pursue_gen.explanation.play import counter_play
from pursue_gen.explanation.texts import TimedLine, describe, time_text
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.rules import Rules, played
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.tga import scenario_objective, translate

WORK = 100_000_000
"""The work of an explanation: some twenty seconds."""

_FOR_CHANGES = 0.65
"""The part of the limits that the search for changes may take."""


@dataclass(frozen=True)
class Explanation:
    """Single changes that win, in order of interest; the utmost changes that were tried and do not; those that were not
    decided within the limits; and a play that is lost whatever the controller does (empty: not found within them).
    """

    changes: Tuple[Change, ...]
    lost: Tuple[str, ...]
    undecided: Tuple[str, ...]
    play: Tuple[TimedLine, ...]


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
    rest = _share(limits, 1 - _FOR_CHANGES)
    try:
        play = describe(scenario, counter_play(network, objective, rules.reaction, rest, found.helpful, progress))
    except PursueError as problem:
        if problem.exit_status != 5:
            raise
        play = ()
    return Explanation(found.changes, found.lost, found.undecided, play)


def _share(limits: Limits, share: float) -> Limits:
    """That share of what is left of them."""
    return replace(limits, seconds=limits.left * share, spent=0.0, work=max(1, int(limits.work * share)))


def render(explanation: Explanation, width: int = 110) -> str:
    """The explanation as lines of text."""
    lines: List[str] = []
    if explanation.changes:
        lines.append("Each of these alone would change that (found by solving again):")
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
    lines += _listed("Not enough alone:", explanation.lost, width)
    lines += _listed("Not decided within the limits:", explanation.undecided, width)
    return "\n".join(lines) + "\n"


def as_json(explanation: Explanation) -> Dict[str, Any]:
    """The explanation as a JSON object."""
    return {
        "changes": [_change_json(change) for change in explanation.changes],
        "lost": list(explanation.lost),
        "undecided": list(explanation.undecided),
        "play": [{"at": float(line.at), "who": line.who, "text": line.text} for line in explanation.play],
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
    if change.span is not None:
        values.update(file=change.span.file, line=change.span.line, column=change.span.column)
    return values
