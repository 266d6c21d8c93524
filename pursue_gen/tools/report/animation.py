"""An animation of a mission on the map, with controls; without scripts a picture of its start.

The picture that is drawn here shows the start. The script moves the marks along the connections, which follow the paths
of a floor plan where these are known; the times of departure and arrival are those of the recording, and between them
an agent moves at an even speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, List, Optional, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.layout import poses
from pursue_gen.drawing.look import AgentLook, agent_looks, mark, tag, text
from pursue_gen.files import write_texts
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.times import unit_name
from pursue_gen.tools.report import timeline
from pursue_gen.tools.report.html import Section, asset, data, page, rendered
from pursue_gen.tools.report.recording import Recording, Stay, Step, ending_text, stays
from pursue_gen.tools.report.timeline import event_text
from pursue_gen.vocabulary.words import Words, words_of

_ID = "animation"
_AWAY = 28.0
"""Pixels from the centre of a POI to the marks of the agents that are there."""

Point = Tuple[float, float]


@dataclass(frozen=True)
class Segment:
    """A movement along a line (px), from `start` to `end` (time units); a stop where the line is one point."""

    start: float
    end: float
    line: Tuple[Point, ...]
    description: str
    is_work: bool


def check_name(file: Path) -> None:
    """Raise PursueError (exit status 2) unless the file's name ends with .svg or .html."""
    if file.suffix not in (".svg", ".html"):
        message = f"--timeline {file}: the format is not known"
        hint = "name a file that ends with .svg (the timeline), or .html (a page with the timeline and an animation)"
        raise PursueError([error("REP010", message, hint=hint)])


def write(recording: Recording, file: Path) -> None:
    """Write the timeline (.svg), or a page with timeline and animation (.html). Raises PursueError (exit status 2)."""
    check_name(file)
    if file.suffix == ".svg":
        write_texts({file: timeline.draw(recording)})
        return
    title = f"{recording.scenario.name}: {recording.source}"
    write_texts({file: page(title, [section(recording.scenario, recording), timeline.section(recording)])})


def section(scenario: Scenario, recording: Recording, floor: Optional[Floor] = None, ident: str = _ID) -> Section:
    """The animation as a part of a page; `floor` lies under the map, and everybody moves along its paths."""
    unit = unit_name(scenario.unit)
    content = {"end": recording.end, "agents": _tracks(scenario, recording, floor), "steps": _steps(recording)}
    content["unit"] = unit
    values: Dict[str, Any] = {"ident": ident, "end": recording.end, "ending": ending_text(recording), "unit": unit}
    segments = _segments(scenario, recording, None)
    values["agents"] = [(agent.shown, segments[agent.name][0].description) for agent in scenario.agents]
    values.update(picture=draw(scenario, recording, floor, ident), data=data(f"{ident}-movements", content))
    body = rendered("animation", **values)
    return Section(ident, "The mission on the map", body, asset("animation.css"), asset("animation.js"))


def draw(scenario: Scenario, recording: Recording, floor: Optional[Floor] = None, ident: str = _ID) -> str:
    """The map with all agents where they were at the start, as an SVG document."""
    where, computed = poses(scenario)
    ground = map_svg.draw(replace(scenario, agents=()), where, computed, floor, f"{ident}-map")
    looks, tracks = agent_looks(recording.agents), _segments(scenario, recording, floor)
    marks = [_mark(agent, looks[agent.name], tracks[agent.name][0].line[0], k, len(scenario.agents), ident)
             for k, agent in enumerate(scenario.agents)]
    cut = ground.rindex("</svg>")
    return f"{ground[:cut]}{''.join(marks)}{ground[cut:]}"


def _mark(agent: Agent, look: AgentLook, at: Point, number: int, count: int, ident: str) -> str:
    """An agent's shape and name on its own side of the POI; the group is moved as a whole."""
    dx, dy = _offset(number, count)
    anchor = "middle" if abs(dx) < 9 else "start" if dx > 0 else "end"
    label = text(dx + (0 if anchor == "middle" else math.copysign(13, dx)), dy - (12 if anchor == "middle" else -5),
                 agent.shown, "pg-strong pg-halo", anchor)
    busy = tag("circle", class_="busy", cx=dx, cy=dy, r=13.0, fill="none", stroke=look.colour, stroke_width=2.5,
               visibility="hidden")
    shape = mark(look, dx, dy, 9.0, stroke="#ffffff", stroke_width=1.5)
    place = f"translate({at[0]:.1f} {at[1]:.1f})"
    return tag("g", busy, shape, label, class_="agent", id=f"{ident}-agent-{number}", transform=place)


def _offset(number: int, count: int) -> Point:
    """Offset of an agent's mark from its POI (px): above it, spread from left to right, so that none hides another."""
    if count == 1:
        return 0.0, -_AWAY
    angle = math.radians(-170 + 160 * number / (count - 1))
    return _AWAY * math.cos(angle), _AWAY * math.sin(angle)


# The data of the script -----------------------------------------------------------------------------------------------


def _tracks(scenario: Scenario, recording: Recording, floor: Optional[Floor]) -> List[Dict[str, Any]]:
    """For each agent its name, its offset, and its segments: [start, end, [[x, y], …], description, acting?]."""
    segments, count = _segments(scenario, recording, floor), len(scenario.agents)
    return [
        {
            "name": agent.shown,
            "offset": [round(v, 1) for v in _offset(number, count)],
            "segments": [
                [one.start, one.end, [[round(x, 1), round(y, 1)] for x, y in one.line], one.description, one.is_work]
                for one in segments[agent.name]
            ],
        }
        for number, agent in enumerate(scenario.agents)
    ]


def _steps(recording: Recording) -> List[List[Any]]:
    """The times of the steps, and what happened then."""
    words = words_of(recording.scenario, recording.network)
    steps: List[List[Any]] = [[step.at, _step_text(step, words, recording)] for step in recording.steps]
    over = recording.steps[-1].at >= recording.end
    return steps if over else [*steps, [recording.end, ending_text(recording)]]


def _step_text(step: Step, words: Words, recording: Recording) -> str:
    if not step.event:
        return step.reason or ("start" if step is recording.steps[0] else step.status)
    event = event_text(step, words, recording.network)
    sentence = f"{recording.scenario.shown(step.agent)} {event}" if step.agent in recording.agents else event
    last = step is recording.steps[-1] and step.status != "running"
    return f"{sentence}; {ending_text(recording)}" if last else sentence


def _segments(scenario: Scenario, recording: Recording, floor: Optional[Floor]) -> Dict[str, List[Segment]]:
    """Agent → its movements and stops on the picture, in order of time."""
    words = words_of(scenario, recording.network)
    paper = map_svg.paper_of(replace(scenario, agents=()), poses(scenario)[0], floor)
    return {agent.name: _segments_of(agent, recording, words, paper) for agent in scenario.agents}


def _segments_of(agent: Agent, recording: Recording, words: Words, paper: map_svg.Paper) -> List[Segment]:
    segments = []
    for stay in stays(recording, agent.name):
        here = Symbol.of(stay.what)
        is_way = here.role is Role.WAY
        there = here.parts[-1:] or (agent.location.name,)  # nobody has said yet where it starts
        points = paper.way(*here.parts) if is_way else paper.way(*there * 2)
        done = _part_done(recording, stay, agent, here.parts) if is_way else 0.0
        description, is_work = words.place(agent.name, stay.what), here.role is Role.WORK
        segments.append(Segment(stay.start, stay.end, map_svg.first_part(points, done), description, is_work))
    return segments


def _part_done(recording: Recording, stay: Stay, agent: Agent, part: Tuple[str, ...]) -> float:
    """How much of its way an agent comes: all, or less where the recording ends or the movement is given up."""
    after = next((step.locations.get(agent.name) for step in recording.steps if step.at >= stay.end), None)
    if stay.over and after == part[1]:
        return 1.0
    _, longest = recording.scenario.movements(agent).get((part[0], part[1]), (1, 2))
    return float(min(0.95, (stay.end - stay.start) / longest))


