"""What measured times say of the windows of a scenario, and the windows that they propose."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import AbstractSet, Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import counted
from pursue_gen.language.checks import checked
from pursue_gen.language.document import Edit, edited
from pursue_gen.language.lifts import driven
from pursue_gen.language.numbers import Number, decimal_text, exact
from pursue_gen.language.rewriting import Movement, Rewriting
from pursue_gen.language.scenario import Scenario, Window
from pursue_gen.tools.calibration.samples import Measured, Sample, Samples, Unused, Way, Work, by_what, of_record
from pursue_gen.tools.calibration.windows import (
    COUNTED,
    FITTED,
    GUESSED,
    SHARE,
    Spread,
    held_out,
    outliers,
    rounded,
    spread_of,
    window_of,
)
from pursue_gen.tools.replay.record import MissionRecord

BY = "calibrate"
"""Begins the notes in the scenario's text."""

STEP = Fraction(1, 10)
"""Windows are rounded outwards to multiples of so many time units. Not measured."""

TOLERANCE = 0.1
"""Time units by which something may miss its window, as `replay` and the observer have it: messages take time."""

KEPT = "kept"
"""What the window rests on where the times are too few for a claim, and the present one holds all that they could
oblige to: it stays."""

_SHORTEST = Fraction(1, 1000)
"""An event with a duration takes longer than this: 0 is none."""


@dataclass(frozen=True)
class Options:
    """`unit`: seconds per time unit; `step`: what windows are rounded to; `share` of later times that they are to hold.

    `slack`: by how many time units each agent may be later than the present model. `outliers`: whether they count.
    `tolerance`: time units by which something may miss its window and still keep it.
    """

    unit: float = 1.0
    step: Fraction = STEP
    share: float = SHARE
    slack: Mapping[str, int] = field(default_factory=dict)
    outliers: bool = True
    tolerance: float = TOLERANCE


@dataclass(frozen=True)
class Finding:
    """What was measured of a way or an event. Times are in time units.

    `present`: its window in the scenario (with slack); `proposed`: the new one, `basis` what that rests on (KEPT, or
    as in `windows`). `early`, `late`: how many times left the present window; `most_early`, `most_late`: by how much.
    `held`, `tried`: how many times are in the window that the other nine tenths make, of how many; `widened`: the agent
    is not controlled, and its present window only widened. `far`: the outliers among `samples`.
    """

    what: Measured
    samples: Tuple[Sample, ...]
    times: Tuple[float, ...]
    spread: Spread
    far: Tuple[int, ...]
    present: Window
    proposed: Window
    basis: str
    early: int
    late: int
    most_early: float
    most_late: float
    held: int
    tried: int
    widened: bool = False

    @property
    def is_left(self) -> bool:
        """True where times left the present window."""
        return self.early + self.late > 0

    @property
    def source(self) -> str:
        """Where the proposal comes from, as a note in the text."""
        noun = "drive" if isinstance(self.what, Way) else "action"
        count = self.spread.count
        text = f"{counted(count, noun)}, {self.spread.least:.1f}"
        if count > 1:
            text += f" to {self.spread.most:.1f}"
        if self.far:
            text += f", {len(self.far)} far out"
        return text if self.basis in (COUNTED, FITTED) else f"{text}, too few for more than a guess"


@dataclass(frozen=True)
class Proposal:
    """All findings, in the scenario's order; `missing`: ways of robots of which nothing was measured;
    `missing_events`: events with a duration of which nothing was.

    `slack`: what would be enough, in place of new windows, for each robot that was late; `lost_after`: time units, None
    where not all ways of robots were measured. `of_others`: those of `missing_events` that robots
    cannot do without others.
    """

    scenario: Scenario
    options: Options
    findings: Tuple[Finding, ...]
    missing: Tuple[Way, ...]
    missing_events: Tuple[Work, ...]
    unused: Tuple[Unused, ...]
    slack: Mapping[str, int]
    lost_after: Optional[int]
    of_others: Tuple[Work, ...] = ()

    @property
    def ways(self) -> Tuple[int, int]:
        """How many ways of robots were not measured, and of how many."""
        robots = {agent.name for agent in self.scenario.agents if agent.is_robot}
        known = sum(isinstance(each.what, Way) and each.what.agent in robots for each in self.findings)
        return len(self.missing), len(self.missing) + known

    @property
    def claims(self) -> bool:
        """True where some way or event was measured so often that more than a guess is said of it."""
        return any(finding.basis not in (GUESSED, KEPT) for finding in self.findings)

    @property
    def left(self) -> Tuple[int, int]:
        """How many times left the present model, and of how many."""
        return sum(f.early + f.late for f in self.findings), sum(f.spread.count for f in self.findings)

    @property
    def left_most(self) -> Tuple[Finding, ...]:
        """Where the present model was left: most often first, then by most."""
        left = (finding for finding in self.findings if finding.is_left)
        return tuple(sorted(left, key=lambda f: (-f.early - f.late, -max(f.most_early, f.most_late))))

    @property
    def held(self) -> Tuple[int, int]:
        """How many times are in windows that were made without them, and of how many; of what was not guessed."""
        known = [finding for finding in self.findings if finding.basis not in (GUESSED, KEPT)]
        return sum(finding.held for finding in known), sum(finding.tried for finding in known)

    @property
    def changes(self) -> Tuple[Finding, ...]:
        """Those with a new window."""
        return tuple(finding for finding in self.findings if finding.basis != KEPT)

    def text(self) -> str:
        """The scenario's text with the proposed windows."""
        rewriting = Rewriting(self.scenario)
        events = {event.name: event for event in self.scenario.events}
        edits: List[Edit] = []
        ways: Dict[Movement, Tuple[Number, Number, str]] = {}
        for each in self.changes:
            what, (low, high), remark = each.what, each.proposed, f"{BY}: {each.source}"
            if isinstance(what, Work):
                edits += rewriting.duration(events[what.event], low, high, remark)
            else:
                ways[what.agent, what.a, what.b] = low, high, remark
        return edited(self.scenario.text, [*edits, *rewriting.windows(ways)])

    def checked(self) -> Scenario:
        """The scenario with the proposed windows. Raises PursueError where they cannot be meant."""
        return checked(self.text(), f"{self.scenario.file} with the proposal", self.scenario.name)


def propose(scenario: Scenario, samples: Samples, options: Options) -> Proposal:
    """What the times say. They have to be of this scenario's ways and events."""
    measured = by_what(samples.measured)
    present = _present(scenario, options.slack)
    findings = [_finding(scenario, what, measured[what], window, options) for what, window in present.items()
                if what in measured]  # fmt: skip
    robots = {agent.name for agent in scenario.agents if agent.is_robot}
    missing = tuple(what for what in present if isinstance(what, Way) and what.agent in robots and what not in measured)
    events = tuple(what for what in present if isinstance(what, Work) and what not in measured)
    of_others = tuple(event for event in events if not _is_of_robots(scenario, event))
    return Proposal(
        scenario, options, tuple(findings), missing, events, samples.unused, _slack(findings, robots, options),
        None if missing else _lost_after(findings), of_others,
    )  # fmt: skip


def of_mission(
    record: MissionRecord, scenario: Scenario, slack: Mapping[str, int], tolerance: float, file: str
) -> Proposal:
    """What the times of one mission say; `slack`, in time units, is that of the game that was played."""
    samples = of_record(record, scenario, file)
    return propose(scenario, samples, Options(samples.unit or 1.0, slack=slack, tolerance=tolerance))


def _present(scenario: Scenario, slack: Mapping[str, int]) -> Dict[Measured, Window]:
    """The windows of the scenario as it is played, in its order."""
    found: Dict[Measured, Window] = {}
    for agent in scenario.agents:
        for way, (low, high) in driven(scenario, agent).items():
            found[Way(agent.name, *way)] = low, exact(high + slack.get(agent.name, 0))
    for event in scenario.events:
        if event.window is not None:
            later = min((slack.get(doer.name, 0) for doer in scenario.doers(event.name)), default=0)
            found[Work(event.name)] = event.window[0], exact(event.window[1] + later * (event.split or 1))
    return found


def _finding(
    scenario: Scenario, what: Measured, samples: Sequence[Sample], present: Window, options: Options
) -> Finding:
    times = tuple(sample.seconds / options.unit for sample in samples)
    far = outliers(times)
    used = times if options.outliers else tuple(time for place, time in enumerate(times) if place not in far)
    window = window_of(used, options.share)
    low, high = (exact(steps * options.step) for steps in rounded(window, float(options.step)))
    if isinstance(what, Work):
        low = exact(max(low, _SHORTEST))
        high = exact(max(high, low + options.step))
    widened = not _is_controlled(scenario, what)
    if widened:
        low, high = min(low, present[0]), max(high, present[1])
    early = [float(present[0]) - time for time in times if time < present[0] - options.tolerance]
    late = [time - float(present[1]) for time in times if time > present[1] + options.tolerance]
    basis = window.basis
    if basis == GUESSED and not (early or late or options.slack):
        low, high = min(low, present[0]), max(high, present[1])  # nothing says that the present one is too wide
        if (low, high) == present:
            basis, widened = KEPT, False
    return Finding(
        what, tuple(samples), times, spread_of(times), far, present, (low, high), basis, len(early), len(late),
        max(early, default=0.0), max(late, default=0.0), *held_out(used, options.share), widened,
    )  # fmt: skip


def _is_controlled(scenario: Scenario, what: Measured) -> bool:
    """True where only agents that are controlled are on the way, or do the event."""
    if isinstance(what, Way):
        return any(agent.controllable for agent in scenario.agents if agent.name == what.agent)
    return all(agent.controllable for agent in scenario.doers(what.event))


def _slack(findings: Sequence[Finding], robots: AbstractSet[str], options: Options) -> Dict[str, int]:
    """By how many whole time units each robot would have to be allowed to be later, with the present windows."""
    found: Dict[str, int] = {}
    for finding in findings:
        if isinstance(finding.what, Way) and finding.late and finding.what.agent in robots:
            agent = finding.what.agent
            found[agent] = max(found.get(agent, 0), options.slack.get(agent, 0) + ceil(finding.most_late))
    return found


def _lost_after(findings: Sequence[Finding]) -> Optional[int]:
    """As long again as the slowest took that came to its end: how long others tried says nothing of who comes."""
    return ceil(max(finding.spread.most for finding in findings)) if findings else None


def _is_of_robots(scenario: Scenario, work: Work) -> bool:
    """True for an event that robots can do without people and agents that are not controlled."""
    robots = [agent for agent in scenario.agents if agent.is_robot]
    needs_two = any(event.name == work.event and event.collaborative for event in scenario.events)
    doers = {robot.name for robot in robots if work.event in {ref.name for ref in robot.can_do}}
    partners = {robot.name for robot in robots if work.event in {ref.name for ref in robot.reacts_to}}
    return any(partners - {doer} for doer in doers) if needs_two else bool(doers)


def window_text(window: Window) -> str:
    """`4 to 6.3`."""
    return f"{decimal_text(window[0])} to {decimal_text(window[1])}"


def statement(finding: Finding) -> str:
    """What the proposal is in the language."""
    what = finding.what
    if isinstance(what, Way):
        return f"travel {what.agent} from {what.a} to {what.b} takes {window_text(finding.proposed)}"
    return f'event "{what.event}" … duration {window_text(finding.proposed)}'
