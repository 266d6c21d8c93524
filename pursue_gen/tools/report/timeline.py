"""A mission as a timeline: a lane for each agent and for each objective, and for states, turns, batteries, conditions,
pauses and plans."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Dict, Iterator, List, Mapping, Sequence, Tuple

from pursue_gen.drawing.look import AgentLook, agent_looks, mark, patterns, safe, svg, tag, text
from pursue_gen.language import network_names as names
from pursue_gen.language.conditions import Holds
from pursue_gen.language.symbols import UNDER_WAY, Role, Symbol, role_of
from pursue_gen.language.times import unit_name
from pursue_gen.tga.event_words import event_word
from pursue_gen.tga.network import Network
from pursue_gen.tga.objectives import stated
from pursue_gen.tools.report.html import Section, table
from pursue_gen.tools.report.recording import (
    Recording,
    Stay,
    Step,
    broken,
    changes,
    conditions,
    ending_text,
    holding,
    lasting,
    paused,
    pauses,
    status_text,
    stays,
)
from pursue_gen.vocabulary.promises import promise_names
from pursue_gen.vocabulary.statuses import courses
from pursue_gen.vocabulary.words import Words, words_of
from pursue_runtime.state import HOLDING
from pursue_runtime.vocabulary import UNPLACED

_WIDTH, _WIDEST = 960.0, 2000.0
_ROW, _BAR, _TOP = 54.0, 16.0, 54.0
_SIDE, _RIGHT = 24.0, 30.0
_LETTER, _BOLD = 7.0, 8.0  # px, a generous guess at how wide a small letter is, and a bold one
_TICK = 70.0  # px between two marks of the time axis, at least
_LETTERS = 24  # of the name of a lane
_LABELLED = 0.8  # this part of the bars gets room for its whole label, if the picture is not too wide then

_OVER = (Role.IDLE, Role.LOSE, Role.WIN, Role.LATE)
"""Where no limit of an objective is running."""

_ID = "timeline"


@dataclass(frozen=True)
class Lane:
    """A row of the picture: its name, and of which agent it is ("": none)."""

    name: str
    parts: Tuple[str, ...]
    agent: str = ""


@dataclass(frozen=True)
class Scale:
    """From time units to pixels."""

    left: float
    unit: float
    width: float
    end: float

    def x(self, at: float) -> float:
        """Where a moment is."""
        return self.left + self.unit * at


def draw(recording: Recording, ident: str = _ID) -> str:
    """The timeline as an SVG document; `ident` begins the ids in it."""
    looks = agent_looks(recording.agents)
    scale = _scale(recording)
    rows = _lanes(recording, looks, scale, ident)
    height = _TOP + _ROW * len(rows) + 40
    body = [patterns(looks, ident)]
    body += [
        tag("rect", x=0, y=_TOP + _ROW * k, width=scale.width, height=_ROW, fill="#f4f6f8")
        for k in range(1, len(rows), 2)
    ]
    body += _axis(scale, _TOP + _ROW * len(rows))
    for number, lane in enumerate(rows):
        y = _TOP + _ROW * number
        look = looks.get(lane.agent)
        head = [mark(look, 20, y + 27, 8.0)] if look else []
        head.append(text(36 if look else 12, y + 32, _short(lane.name, _LETTERS + 1), "pg-strong", "start"))
        head += [tag("title", safe(lane.name))] if len(lane.name) > _LETTERS else []
        inner = tag("g", *lane.parts, transform=f"translate(0 {y:.0f})")
        body.append(tag("g", *head, inner, class_="lane", data_lane=lane.name))
    body += _end(recording, scale, _TOP + _ROW * len(rows))
    title = f"{recording.scenario.name}: {recording.source}"
    lasted = f"{_time(recording.end)} {unit_name(recording.scenario.unit)}"
    description = f"{len(recording.steps)} steps in {lasted}; {ending_text(recording)}"
    heading = text(12, 20, title, "pg-strong", "start")
    subtitle = text(12 + 9.2 * len(title) + 16, 20, description, "pg-small", "start")
    return svg(scale.width, height, title, description, [heading, subtitle, *body], ident)


def section(recording: Recording, ident: str = _ID) -> Section:
    """The timeline as a part of a page, with a table of all steps."""
    words = words_of(recording.scenario, recording.network)
    shown = recording.scenario.shown
    rows = [
        (_time(step.at), shown(step.agent), _step_text(step, words, recording), changed)
        for step, changed in zip(recording.steps, changes(recording))
    ]
    heads = ("Time", "Who", "What", "What that changes")
    unit = unit_name(recording.scenario.unit)
    steps = table(heads, rows, f"All steps; times in {unit} since the start")
    caption = f"Bars are movements and actions, lines are waits; times are in {unit} since the start."
    picture = (
        f'<figure><div class="wide picture {safe(ident)}-wide" tabindex="0" role="region" aria-label="Timeline">'
        f"{draw(recording, f'{ident}-picture')}</div><figcaption>{caption}</figcaption></figure>"
    )
    # A long mission is scrolled, not squeezed.
    style = f".{ident}-wide svg{{max-width:none!important}}"
    body = f"{picture}<details><summary>The same as a table</summary>{steps}</details>"
    return Section(ident, "The mission in time", body, style)


# The frame ------------------------------------------------------------------------------------------------------------


def _scale(recording: Recording) -> Scale:
    longest = max(map(len, _names(recording)), default=4)
    left = _SIDE + 30 + 8.4 * min(longest, _LETTERS)
    end = max(recording.end, 1.0)
    bars = (
        (len(_bar_label(recording, stay.what)) + 1) * _BOLD / (stay.end - stay.start)
        for agent in recording.agents
        for stay in stays(recording, agent)
        if stay.over and stay.end > stay.start and _bar_label(recording, stay.what)
    )
    wanted = sorted(bars)
    roomy = end * wanted[int(_LABELLED * (len(wanted) - 1))] if wanted else 0.0
    inner = min(max(_WIDTH - left - _RIGHT - 40, roomy), _WIDEST)
    return Scale(left, inner / end, left + inner + _RIGHT + 40, end)


def _bar_label(recording: Recording, location: str) -> str:
    """What stands above a movement or an action; nothing above a wait."""
    symbol = Symbol.of(location)
    if symbol.role is Role.SOMEWHERE:
        return ""
    first, *others = map(recording.scenario.shown, symbol.parts)
    return "" if symbol.role not in UNDER_WAY else first if symbol.role is Role.WORK else f"{first} → {others[0]}"


def _names(recording: Recording) -> List[str]:
    scenario = recording.scenario
    lanes = [*map(scenario.shown, recording.agents), *(each.label for each in courses(scenario, recording.network))]
    return [*lanes, *conditions(scenario), *promise_names(scenario).values(), *pauses(scenario)]


def _axis(scale: Scale, bottom: float) -> Iterator[str]:
    """The marks of the time axis, above and below."""
    step = nice_step(_TICK / scale.unit)
    count = int(scale.end / step + 1e-9)
    for k in range(count + 1):
        at = k * step
        x = scale.x(at)
        yield tag("line", class_="pg-rule", x1=x, y1=_TOP - 8, x2=x, y2=bottom + 4, opacity=0.6)
        yield text(x, bottom + 18, _time(at), "pg-small")
        yield text(x, _TOP - 12, _time(at), "pg-small")
    yield text(scale.x(0) - 12, bottom + 18, "time", "pg-small", "end")


def _end(recording: Recording, scale: Scale, bottom: float) -> Iterator[str]:
    """The end of the mission, or of its recording."""
    x = scale.x(recording.end)
    yield tag("line", x1=x, y1=_TOP - 8, x2=x, y2=bottom + 6, stroke="#1b1f24", stroke_width=3, class_="end")
    anchor = "end" if x > scale.width - 160 else "start"
    yield text(x + (-6 if anchor == "end" else 6), bottom + 34, f"{ending_text(recording)}, {_time(recording.end)}",
               "pg-strong pg-halo", anchor)


# The lanes ------------------------------------------------------------------------------------------------------------


def _lanes(recording: Recording, looks: Mapping[str, AgentLook], scale: Scale, ident: str) -> List[Lane]:
    lanes = []
    for number, agent in enumerate(recording.agents):
        fill = f"url(#{ident}-fill-{number})"
        bars = tuple(_agent(recording, scale, agent, looks[agent], fill))
        lanes.append(Lane(recording.scenario.shown(agent), bars, agent))
    lanes += _promises(recording, scale)
    for status in courses(recording.scenario, recording.network):
        texts = ((step.at, status.text(step.locations, step.values) or "") for step in recording.steps)
        found = lasting(recording, texts)
        is_state = "true" in status.texts.values()
        shown = [stay for stay in found if not is_state or stay.what in ("true", "unknown")]
        how = (_box(scale, stay, "true") if stay.what == "true" else _line(scale, stay, stay.what) for stay in shown)
        lanes.append(Lane(status.label, tuple(how)))
    for words_of_it, condition in conditions(recording.scenario).items():
        if isinstance(condition, Holds):
            continue  # its state has a lane
        parts = [_box(scale, stay, "holds", f"{words_of_it} holds") for stay in holding(recording, condition)]
        lanes.append(Lane(words_of_it, tuple(parts)))
    for name, pause in pauses(recording.scenario).items():
        due = [(stay, f"not before {_time(until)}") for stay, until in paused(recording, pause)]
        lanes.append(Lane(name, tuple(_box(scale, stay, says, f"{name} {says}") for stay, says in due)))
    lanes += [Lane("broken", (_box(scale, stay, says, f"broken: {says}"),)) for says, stay in broken(recording)]
    lanes += _course(recording, scale)
    return lanes


def _agent(recording: Recording, scale: Scale, agent: str, look: AgentLook, fill: str) -> Iterator[str]:
    """Movements and actions as bars, waits as lines, and what takes no time as marks."""
    found, taken, shown = stays(recording, agent), 0.0, recording.scenario.shown
    labels = [_bar_label(recording, stay.what) for stay in found]
    for number, (stay, label) in enumerate(zip(found, labels)):
        symbol = Symbol.of(stay.what)
        here = f"at {shown(symbol.parts[-1])}" if symbol.parts else UNPLACED
        x = scale.x(stay.start)
        if not label:
            yield _line(scale, stay, here, "wait", max(0.0, taken - x))
            continue
        after = next((scale.x(found[k].start) for k in range(number + 1, len(found)) if labels[k]), None)
        room = (scale.width if after is None else after) - x
        taken = x + min(room, (len(label) + 1) * _BOLD)
        is_work = role_of(stay.what) is Role.WORK
        ink = ("#ffffff", f"{label} {here}", 3.0) if is_work else (fill, f"from {label}", 1.5)
        yield _bar(scale, stay, _label(x, room, label, "pg-strong"), look.colour, *ink)
    free = 0.0
    for before, step in zip(recording.steps, recording.steps[1:]):
        if step.agent != agent or before.locations.get(agent) != step.locations.get(agent):
            continue
        x, label = scale.x(step.at), shown(step.event)
        tooltip = tag("title", safe(f"{shown(agent)}: {label} at {_time(step.at)}"))
        drawn = mark(look, x, 28, 8.0, stroke="#ffffff", stroke_width=1.5)
        room = x - len(label) * _LETTER / 2
        under = text(x, 50, label, "pg-small pg-strong") if room > free else ""
        free = x + len(label) * _LETTER / 2 if under else free
        yield tag("g", tooltip, drawn, under, class_="instant")


def _promises(recording: Recording, scale: Scale) -> Iterator[Lane]:
    """Each objective: when it was kept, reached or broken; of one with a limit, when its clock ran, and when that would
    have run out."""
    scenario = recording.scenario
    objectives, others = stated(scenario), {each.label for each in courses(scenario, recording.network)}
    for automaton, promised in promise_names(scenario).items():
        name = f"objective: {promised}" if promised in others else promised
        found, objective = stays(recording, automaton), objectives[automaton]
        if objective.limit is None:
            yield Lane(name, tuple(_course_of(scale, stay, objective.status(stay.what)) for stay in found if stay.what))
            continue
        words, limit = objective.words, float(objective.limit)
        there = [stay for stay in found if stay.what == names.IDLE]
        risks = [stay for stay in found if role_of(stay.what) not in _OVER]
        if objective.once:
            risks = [replace(risks[0], end=risks[-1].end, over=risks[-1].over)] if risks else []
        due = [(stay, limit if objective.once else stay.start + limit) for stay in risks]
        lines = tuple(_line(scale, stay, words.there) for stay in there if words.there)
        yield Lane(name, lines + _deadline(recording, scale, due, words.due))


def _course_of(scale: Scale, stay: Stay, says: str) -> str:
    """What an objective without a limit was at: a box where it was broken, else a line."""
    return (_box if role_of(stay.what) is Role.LOSE else _line)(scale, stay, says)


def _deadline(recording: Recording, scale: Scale, risks: Sequence[Tuple[Stay, float]], what: str) -> Tuple[str, ...]:
    """How long something was due, and by when."""
    parts: List[str] = []
    for stay, due in risks:
        parts.append(_box(scale, stay, f"due by {_time(due)}", f"{what} due by {_time(due)}"))
        if due <= recording.end:
            x = scale.x(due)
            parts.append(tag("path", d=f"M{x:.1f},18 V40 M{x - 5:.1f},18 H{x + 5:.1f} M{x - 5:.1f},40 H{x + 5:.1f}",
                             stroke="#1b1f24", stroke_width=2.5, fill="none", class_="due"))
    return tuple(parts)


def _course(recording: Recording, scale: Scale) -> Iterator[Lane]:
    """Where the mission was held, and new plans; nothing where it just ran."""
    held = [stay for stay in lasting(recording, ((s.at, s.status) for s in recording.steps)) if stay.what == HOLDING]
    parts = [_box(scale, stay, "holding") for stay in held]
    for before, step in zip(recording.steps, recording.steps[1:]):
        if step.plan != before.plan:
            x = scale.x(step.at)
            parts.append(tag("line", x1=x, y1=14.0, x2=x, y2=44.0, stroke="#1b1f24", stroke_width=2))
            parts.append(text(x + 4, 50, f"plan {step.plan}", "pg-small", "start"))
    if parts:
        yield Lane("course", tuple(parts))


# The parts of a lane --------------------------------------------------------------------------------------------------


def _bar(scale: Scale, stay: Stay, label: str, colour: str, fill: str, tooltip: str, border: float) -> str:
    x, width = scale.x(stay.start), max(2.0, scale.unit * (stay.end - stay.start))
    rect = tag("rect", x=x, y=20.0, width=width, height=_BAR, rx=3, fill=fill, stroke=colour, stroke_width=border)
    return tag("g", _title(stay, tooltip), rect, label, class_="bar")


def _box(scale: Scale, stay: Stay, label: str, tooltip: str = "") -> str:
    x, width = scale.x(stay.start), max(2.0, scale.unit * (stay.end - stay.start))
    rect = tag("rect", x=x, y=22.0, width=width, height=12.0, rx=2, fill="#d0d7de", stroke="#57606a", stroke_width=1.5)
    return tag("g", _title(stay, tooltip or label), rect, _label(x, width, label), class_="box")


def _line(scale: Scale, stay: Stay, label: str, kind: str = "turn", moved: float = 0.0) -> str:
    """`moved`: so many pixels at the beginning belong to the label before."""
    x, width = scale.x(stay.start), scale.unit * (stay.end - stay.start)
    room = width - moved if kind == "turn" or width - moved > (len(label) + 1) * _LETTER else 0.0
    line = tag("line", class_="pg-rule", x1=x, y1=28.0, x2=x + width, y2=28.0, stroke_width=1)
    tick = tag("line", class_="pg-rule", x1=x, y1=24.0, x2=x, y2=32.0)
    return tag("g", _title(stay, label), line, tick, _label(x + moved, room, label), class_=kind)


def _label(x: float, width: float, label: str, kind: str = "") -> str:
    """The words above a part, as many of them as there is room for."""
    shown = _short(label, (width - 4) / (_BOLD if kind else _LETTER))
    return text(x + 2, 14, shown, f"pg-small {kind}".strip(), "start") if shown else ""


def _short(label: str, letters: float) -> str:
    most = int(letters)
    if len(label) <= most:
        return label
    return label[: most - 1] + "…" if most >= 6 else ""


def _title(stay: Stay, tooltip: str) -> str:
    until = f"to {_time(stay.end)}" if stay.over else "to the end"
    return tag("title", safe(f"{tooltip}, {_time(stay.start)} {until}"))


def _step_text(step: Step, words: Words, recording: Recording) -> str:
    """What happened in a step, in a sentence."""
    if not step.event:
        what = status_text(recording, step.status) or "the mission runs"
        return f"{what}: {step.reason}" if step.reason else what
    return event_text(step, words, recording.network)


def event_text(step: Step, words: Words, network: Network) -> str:
    """What the agent did, in words."""
    found: Dict[str, str] = {}
    for automaton in network.automata:
        if automaton.name == step.agent:
            found = {event_word(automaton.name, edge): words.move(automaton.name, edge) for edge in automaton.edges}
    return found.get(step.event, step.event)


def nice_step(least: float) -> float:
    """The smallest of 1, 2, 5, 10, 20 … (and 0.1, 0.2, 0.5) that is not less."""
    size = 0.1
    while True:
        for factor in (1, 2, 5):
            if size * factor >= least:
                return size * factor
        size *= 10


def _time(at: float) -> str:
    """A time with at most two decimals."""
    return f"{at:.2f}".rstrip("0").rstrip(".") or "0"
