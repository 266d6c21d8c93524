"""What simulated missions came to, as text and as JSON."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Dict, List, Optional

from pursue_gen.columns import columns
from pursue_gen.language.numbers import tenths_above
from pursue_gen.language.times import unit_name, words_for
from pursue_gen.tools.simulation.outcome import FAILED, GOAL, HELD, SAFE, Outcome
from pursue_gen.tools.simulation.runs import Summary
from pursue_runtime.state import LOST, STOPPED

END_TEXTS = {
    GOAL: "goal reached",
    SAFE: "safe to the end",
    STOPPED: "safe stop",
    HELD: "holding, to the end",
    LOST: "lost, by a fault",
    FAILED: "FAILED",
}


def table(summary: Summary, guaranteed: Optional[str] = None) -> str:
    """The outcomes with their times; `guaranteed` is a sentence on the time that the strategy guarantees."""
    cells = [["outcome", "missions", "%", "min", "median", "worst"]]
    answers = [["objective", "called upon", "worst answer", "limit", "missions without a call"]]
    for each in summary.answers:
        latest = "-" if each.latest is None else f"{each.latest:.2f}"
        answers.append([each.objective, f"{each.calls:,}", latest, f"{each.limit:g}", f"{each.untried:,}"])
    for row in summary.rows:
        share = f"{100 * row.missions / summary.missions:.1f}"
        times = [f"{time:.2f}" for time in (row.least, row.median, row.worst)]
        cells.append([END_TEXTS[row.end], f"{row.missions:,}", share, *times])
    lines = [*columns(cells, ruled=True), ""]
    lines += [*columns(answers, ruled=True), ""] if summary.answers else []
    return "\n".join([*lines, *_notes(summary, guaranteed)]).rstrip()


def _notes(summary: Summary, guaranteed: Optional[str]) -> List[str]:
    unit = summary.case.scenario.unit
    lines = [f"Times are in {unit_name(unit)} from the start."]
    lines += [guaranteed] if guaranteed else []
    if summary.bound is not None:
        bound = words_for(tenths_above(Fraction(f"{summary.bound:.6f}")), unit)
        lines.append(f"With the workspace's controllers, and without faults: at most {bound}.")
    lines += driven_words(summary)
    if summary.happened:
        faults = ", ".join(f"{kind} {times:,}" for kind, times in summary.happened.items())
        lines += [f"Faults: {faults}.", f"Missions that went on with a new plan: {summary.planned:,}."]
    return lines


def driven_words(summary: Summary) -> List[str]:
    """How far each robot drove, as a sentence; none where no robot can."""
    units = ", ".join(f"{name} {driven:.1f}" for name, driven in summary.driven.items())
    counts = "metres" if summary.case.scenario.in_metres else "units of distance"
    return [f"Driven in a mission, on average, in {counts}: {units}."] if units else []


def failure(outcome: Outcome, again: str) -> List[str]:
    """A mission that must never be: what is wrong, how to repeat it, the play."""
    lines = [f"mission {outcome.seed} ({outcome.opponent}) failed after {outcome.time:.3f}: {outcome.reason}"]
    lines += [f"    {problem}" for problem in outcome.problems[1:]]
    return [*lines, f"again: {again}", *(f"    {line}" for line in outcome.play)]


def as_json(summary: Summary, facts: Dict[str, Any]) -> Dict[str, Any]:
    """The same for machines; `facts` come first."""
    return {
        **facts,
        "missions": summary.missions,
        "outcomes": {
            row.end: {"missions": row.missions, "min": row.least, "median": row.median, "worst": row.worst}
            for row in summary.rows
        },
        "objectives": [
            {"objective": a.objective, "limit": a.limit, "calls": a.calls, "worst": a.latest, "untried": a.untried}
            for a in summary.answers
        ],
        "driven": dict(summary.driven),
        "bound": summary.bound,
        "happened": summary.happened,
        "planned": summary.planned,
        "failures": [
            {"seed": o.seed, "opponent": o.opponent, "time": o.time, "reason": o.reason, "play": list(o.play)}
            for o in summary.failures
        ],
    }
