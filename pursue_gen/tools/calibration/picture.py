"""Measured times as a picture: a row for each way and event, with its windows; and a page with picture and tables."""

from __future__ import annotations

from pathlib import Path
from typing import Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, counted, error
from pursue_gen.drawing.look import ACCENT, INK, PAPER, RULE, AgentLook, agent_looks, mark, safe, svg, tag, text
from pursue_gen.files import write_texts
from pursue_gen.tools.calibration.proposal import Finding, Proposal, window_text
from pursue_gen.tools.calibration.proposal_report import HEAD, changed, proposed, rows, sentences, shown, unknown
from pursue_gen.tools.calibration.samples import Way
from pursue_gen.tools.calibration.solved_again import Verdict
from pursue_gen.tools.report.html import Section, figure, page, table
from pursue_gen.tools.report.timeline import nice_step

_WIDTH, _RIGHT = 960.0, 30.0
_TOP, _ROW, _BOTTOM = 66.0, 56.0, 40.0
_BOLD = 8.4  # px, a generous guess at how wide a bold letter is
_TICK = 70.0  # px between two marks of the axis, at least
_MOST_LABEL = 34
_DRAWN = 300
"""So many times of a row are drawn, evenly chosen among more; outliers always are."""
_LEVELS = 5
"""Marks of a row are on so many levels, in turn, so that they do not hide each other."""

_ID = "times"


def check_name(file: Optional[Path]) -> None:
    """Raises PursueError (exit status 2) unless the name, if there is one, ends with .svg or .html."""
    if file is not None and file.suffix not in (".svg", ".html"):
        message = f"--picture {file}: the format is not known"
        hint = "name a file that ends with .svg (the picture), or .html (a page with the picture and the tables)"
        raise PursueError([error("CAL004", message, hint=hint)])


def write(proposal: Proposal, verdicts: Sequence[Verdict], file: Path) -> None:
    """Writes the picture (.svg), or a page with picture and tables (.html). Raises PursueError (exit status 2)."""
    check_name(file)
    if file.suffix == ".svg":
        write_texts({file: draw(proposal)})
    else:
        title = f"{proposal.scenario.name}: measured times"
        write_texts({file: page(title, list(sections(proposal, verdicts)))})


def sections(proposal: Proposal, verdicts: Sequence[Verdict]) -> Iterator[Section]:
    """The parts of the page."""
    unit = f"1 time unit = {proposal.options.unit:g} s"
    caption = f"Each mark is a time; the open bar is the window of the model, the filled one the proposal. {unit}."
    parts = [figure(draw(proposal, f"{_ID}-picture"), caption)]
    parts.append(table(HEAD, rows(proposal), "The same as a table; times in time units"))
    parts[:0] = [f"<p>{safe(sentence)}</p>" for sentence in unknown(proposal)]
    parts += [f"<p>{safe(sentence)}</p>" for sentence in sentences(proposal)]
    yield Section(_ID, "Measured times", "\n".join(parts))
    body = f"<pre>{safe(chr(10).join(proposed(proposal)))}</pre>"
    if verdicts:
        body += f"<pre>{safe(chr(10).join(changed(proposal, *verdicts)))}</pre>"
    yield Section("proposal", "What they propose", body)


def draw(proposal: Proposal, ident: str = _ID) -> str:
    """The picture as an SVG document; `ident` becomes its id."""
    findings, scenario = proposal.findings, proposal.scenario
    looks = agent_looks([agent.name for agent in scenario.agents])
    names = [_short(shown(scenario, finding.what)) for finding in findings]
    left = 40 + _BOLD * max(map(len, names), default=4)
    end = max((_end(finding) for finding in findings), default=1.0)
    unit = (_WIDTH - left - _RIGHT) / end
    bottom = _TOP + _ROW * len(findings)
    body: List[str] = [
        tag("rect", x=0, y=_TOP + _ROW * k, width=_WIDTH, height=_ROW, fill="#f4f6f8")
        for k in range(1, len(findings), 2)
    ]
    step = nice_step(_TICK / unit)
    for k in range(int(end / step + 1e-9) + 1):
        x = left + unit * step * k
        body.append(tag("line", class_="pg-rule", x1=x, y1=_TOP - 8, x2=x, y2=bottom + 4, opacity=0.6))
        body.append(text(x, bottom + 18, f"{step * k:g}", "pg-small"))
    for number, (name, finding) in enumerate(zip(names, findings)):
        inner = "".join(_row(finding, name, left, unit, looks))
        where = f"translate(0 {_TOP + _ROW * number:.0f})"
        body.append(tag("g", inner, class_="times", data_what=str(finding.what), transform=where))
    left_model, count = proposal.left
    title = f"{scenario.name}: measured times"
    description = f"{counted(count, 'time')}, in time units; {left_model} left the present model"
    return svg(_WIDTH, bottom + _BOTTOM, title, description, [*_heading(title, description), *body], ident)


def _heading(title: str, description: str) -> Iterator[str]:
    yield text(12, 20, title, "pg-strong", "start")
    yield text(12 + 9.2 * len(title) + 16, 20, description, "pg-small", "start")
    at = 12.0
    for words, part in (
        ("window of the model", tag("rect", x=at, y=34.0, width=22.0, height=12.0, fill=PAPER, stroke=INK)),
        ("proposal", tag("rect", x=at + 190, y=37.0, width=22.0, height=6.0, fill=ACCENT)),
        ("outlier", tag("circle", cx=at + 311, cy=40.0, r=6.0, fill="none", stroke=INK, stroke_width=2)),
        ("median", tag("line", x1=at + 395, y1=33.0, x2=at + 395, y2=47.0, stroke=INK, stroke_width=3)),
    ):
        place = {"window of the model": 28, "proposal": 218, "outlier": 324, "median": 404}[words]
        yield part
        yield text(at + place, 44, words, "pg-small", "start")


def _row(finding: Finding, name: str, left: float, unit: float, looks: Mapping[str, AgentLook]) -> Iterator[str]:
    """The name, the windows, the times and their median."""
    yield text(12, 24, name, "pg-strong", "start")
    yield text(12, 42, f"{counted(finding.spread.count, 'time')}, {finding.basis}", "pg-small", "start")
    low, high = (left + unit * float(end) for end in finding.present)
    yield tag(
        "rect", tag("title", safe(f"model: {window_text(finding.present)}")), x=low, y=6.0, width=max(2.0, high - low),
        height=34.0, fill=PAPER, stroke=INK, stroke_width=1.5, rx=3,
    )  # fmt: skip
    low, high = (left + unit * float(end) for end in finding.proposed)
    yield tag(
        "rect", tag("title", safe(f"proposal: {window_text(finding.proposed)}")), x=low, y=44.0,
        width=max(2.0, high - low), height=6.0, fill=ACCENT,
    )  # fmt: skip
    look = looks[finding.what.agent] if isinstance(finding.what, Way) else AgentLook(RULE, "", "diamond", "solid")
    for number, (time, far) in enumerate(_marks(finding)):
        x, y = left + unit * time, 11.0 + 6.0 * (number % _LEVELS)
        yield mark(look, x, y, 3.5, opacity=0.75)
        if far:
            label = tag("title", safe(f"outlier: {time:.2f}"))
            yield tag("circle", label, cx=x, cy=y, r=6.0, fill="none", stroke=INK, stroke_width=2, class_="outlier")
    x = left + unit * finding.spread.median
    yield tag("line", x1=x, y1=6.0, x2=x, y2=40.0, stroke=INK, stroke_width=3, class_="median")


def _marks(finding: Finding) -> Sequence[Tuple[float, bool]]:
    """The times that are drawn, and which of them are outliers."""
    far = [(finding.times[place], True) for place in finding.far]
    usual = sorted((time, False) for place, time in enumerate(finding.times) if place not in finding.far)
    count = min(len(usual), _DRAWN)
    return [*(usual[k * len(usual) // count] for k in range(count)), *far]


def _end(finding: Finding) -> float:
    return max(float(finding.present[1]), float(finding.proposed[1]), finding.spread.most, 1.0)


def _short(name: str) -> str:
    return name if len(name) <= _MOST_LABEL else f"{name[: _MOST_LABEL - 1]}…"
