"""A proposal for people, as tables and sentences, and for programs, as JSON."""

from __future__ import annotations

from typing import Any, Dict, Iterator, List, Sequence, Tuple

from pursue_gen.columns import columns
from pursue_gen.diagnostics import counted
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.calibration.proposal import KEPT, Finding, Proposal, statement, window_text
from pursue_gen.tools.calibration.samples import Unused, Way
from pursue_gen.tools.calibration.solved_again import Verdict
from pursue_gen.tools.calibration.windows import COUNTED, FITTED, GUESSED, times_needed


def report(proposal: Proposal) -> Iterator[str]:
    """All of it for a terminal: what is not known comes first."""
    yield from unknown(proposal)
    yield f"1 time unit = {proposal.options.unit:g} s; times in time units"
    yield ""
    yield from columns([HEAD, *rows(proposal)])
    yield ""
    yield from sentences(proposal)
    yield ""
    yield from proposed(proposal)


def unknown(proposal: Proposal) -> Iterator[str]:
    """How much was not measured at all, or too seldom for a claim; nothing where all of it was."""
    missing, ways = proposal.ways
    if missing:
        yield f"{missing} of {counted(ways, 'way')} of robots not measured: their windows stay as they are."
    if not proposal.claims:
        yield "Nothing can be claimed: what was measured was measured less than 5 times, and its windows are guesses."


HEAD = ("what", "times", "least", "median", "95 %", "most", "deviation", "model", "early", "late", "proposal", "basis")

_MANY = 12
"""So many lines of a kind are printed."""


def rows(proposal: Proposal) -> List[Tuple[str, ...]]:
    """A row of texts for each way and event, in the order of HEAD; times in time units."""
    return [_row(proposal.scenario, finding) for finding in proposal.findings]


def _row(scenario: Scenario, finding: Finding) -> Tuple[str, ...]:
    spread = finding.spread
    figures = (spread.least, spread.median, spread.p95, spread.most, spread.deviation)
    early = f"{finding.early} by {finding.most_early:.1f}" if finding.early else "-"
    late = f"{finding.late} by {finding.most_late:.1f}" if finding.late else "-"
    return (
        shown(scenario, finding.what), str(spread.count), *(f"{figure:.2f}" for figure in figures),
        window_text(finding.present), early, late, window_text(finding.proposed), finding.basis,
    )  # fmt: skip


def shown(scenario: Scenario, what: object) -> str:
    """A way or an event, as people read it."""
    if isinstance(what, Way):
        return f"{scenario.shown(what.agent)}: {scenario.shown(what.a)} to {scenario.shown(what.b)}"
    return scenario.shown(str(what))


def sentences(proposal: Proposal) -> Iterator[str]:
    """What else there is to say: how often the model was left, what the proposal rests on, what is missing."""
    left, count = proposal.left
    yield f"{left} of {counted(count, 'time')} left the present model ({100 * left / max(1, count):.1f} %)."
    held, tried = proposal.held
    share = float(proposal.options.share)
    if tried:
        yield (
            f"Held against themselves: {held} of {tried} times ({100 * held / tried:.1f} %) are in the window that the "
            "other nine tenths of their kind make."
        )
    kinds = {finding.basis for finding in proposal.findings}
    needed = times_needed(share)
    yield from (text for kind, text in _bases(share, needed).items() if kind in kinds)
    yield from _far(proposal)
    yield from _unused(proposal)
    if proposal.missing:
        some = ", ".join(shown(proposal.scenario, way) for way in proposal.missing[:_MANY])
        more = " …" if len(proposal.missing) > _MANY else ""
        yield f"Not measured, so windows stay: {some}{more}. (rosrun UI drive_legs drives all ways of robots.)"
    if proposal.missing_events:
        some = ", ".join(shown(proposal.scenario, event) for event in proposal.missing_events[:_MANY])
        more = " …" if len(proposal.missing_events) > _MANY else ""
        how = "rosrun UI drive_legs _actions:=5 does what needs robots alone; recorded missions measure the rest"
        yield f"Not measured, so durations stay: {some}{more}. ({how}.)"
    if proposal.of_others:
        some = ", ".join(shown(proposal.scenario, event) for event in proposal.of_others[:_MANY])
        yield f"Not robots alone do this, so only recorded missions measure it: {some}."
    widened = [shown(proposal.scenario, finding.what) for finding in proposal.findings if finding.widened]
    if widened:
        yield f"Not controlled, so windows are only widened: {', '.join(widened[:_MANY])}."
    for robot, units in proposal.slack.items():
        yield f"With the present windows, --slack {robot}={units} would be enough for all that were late."
    if proposal.lost_after is not None:
        yield f"lost_after:={proposal.lost_after} waits for a late agent as long as the slowest took in all."


def _bases(share: float, needed: int) -> Dict[str, str]:
    percent = f"{100 * share:g} %"
    return {
        COUNTED: f"counted: holds {percent} of later times, at a confidence of 95 %, however they are distributed.",
        FITTED: f"fitted: holds {percent} of later times, at a confidence of 95 %, if their logarithms are normally "
        f"distributed; without that assumption it takes {needed} times of a kind.",
        KEPT: "kept: less than 5 times, and the present window, which stays, is as wide as a guess or wider.",
        GUESSED: "guessed: less than 5 times: from half the shortest to twice the longest, and no narrower than a "
        "present window that holds them. Nothing can be claimed.",
    }


def _far(proposal: Proposal) -> Iterator[str]:
    far = [(finding, finding.samples[place]) for finding in proposal.findings for place in finding.far]
    if not far:
        return
    kept = "they count" if proposal.options.outliers else "left out of the proposal, so such times will leave the model"
    yield f"Outliers (beyond a quartile by more than 3 times the distance of the quartiles); {kept}:"
    for finding, sample in far[:_MANY]:
        units = sample.seconds / proposal.options.unit
        name = shown(proposal.scenario, finding.what)
        yield f"  {name} took {units:.2f}, {sample.at:.1f} s after the beginning of {sample.file}"


def _unused(proposal: Proposal) -> Iterator[str]:
    kinds: Dict[Tuple[str, str], List[Unused]] = {}
    for each in proposal.unused:
        kinds.setdefault((shown(proposal.scenario, each.what), each.why), []).append(each)
    for (what, why), some in list(kinds.items())[:_MANY]:
        yield f"Not used: {what}, {counted(len(some), 'time')} ({why})."


def left_most(proposal: Proposal) -> Iterator[str]:
    """Where the model was left most, with what is proposed there; nothing where it was kept."""
    found = proposal.left_most
    if found:
        yield "Where the model was left most (in time units), and the windows that these times propose:"
    for finding in found[:_MANY]:
        by = [("early", finding.early, finding.most_early), ("late", finding.late, finding.most_late)]
        of = finding.spread.count
        how = " and ".join(f"{count} of {of} {word} by {most:.2f}" for word, count, most in by if count)
        what = shown(proposal.scenario, finding.what)
        yield f"  {what}, model {window_text(finding.present)}: {how}"
        yield f"    {statement(finding)} // {finding.source}"
    if len(found) > _MANY:
        yield f"  and {len(found) - _MANY} more"


def left_most_json(proposal: Proposal) -> List[Dict[str, Any]]:
    """The same for programs."""
    return [_finding_json(finding) for finding in proposal.left_most]


def proposed(proposal: Proposal) -> Iterator[str]:
    """The statements of the proposal, each with where it comes from."""
    lines = [statement(finding) for finding in proposal.changes]
    width = max(map(len, lines), default=0)
    for line, finding in zip(lines, proposal.changes):
        yield f"{line.ljust(width)}  // {finding.source}"


def changed(proposal: Proposal, before: Verdict, after: Verdict) -> Iterator[str]:
    """What the proposal changes."""
    if proposal.missing or not proposal.claims:
        yield "With windows that are guesses (above) neither verdict says what these robots will do:"
    yield f"as it is:          {before.words}"
    yield f"with the proposal: {after.words}"
    if after.margin:
        yield after.margin
    for verdict in (before, after):
        if verdict.reason:
            yield f"  {verdict.reason}"


def as_json(proposal: Proposal, verdicts: Sequence[Verdict] = ()) -> Dict[str, Any]:
    """Everything as a JSON object; times in time units."""
    left, held = proposal.left, proposal.held
    data: Dict[str, Any] = {
        "unit": proposal.options.unit,
        "share": proposal.options.share,
        "times": [_finding_json(finding) for finding in proposal.findings],
        "left": {"times": left[0], "of": left[1]},
        "held_out": {"held": held[0], "of": held[1]},
        "not_measured": dict(zip(("ways", "of"), proposal.ways)),
        "missing": [vars(way) for way in proposal.missing],
        "missing_events": [work.event for work in proposal.missing_events],
        "unused": [{"what": str(u.what), "why": u.why, "seconds": u.seconds, "file": u.file} for u in proposal.unused],
        "slack": dict(proposal.slack),
        "lost_after": proposal.lost_after,
    }
    if verdicts:
        data["before"], data["after"] = (verdict.as_json() for verdict in verdicts)
    return data


def _finding_json(finding: Finding) -> Dict[str, Any]:
    return {
        **vars(finding.what),
        **vars(finding.spread),
        "outliers": [finding.times[place] for place in finding.far],
        "present": [float(end) for end in finding.present],
        "proposed": [float(end) for end in finding.proposed],
        "basis": finding.basis,
        "early": finding.early,
        "late": finding.late,
        "most_early": finding.most_early,
        "most_late": finding.most_late,
        "held_out": finding.held,
    }
