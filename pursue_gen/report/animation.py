"""A mission on the map: where everybody is at every moment, with buttons to run through it; a still picture without.

The picture that is drawn here shows the beginning. The script moves the marks along the connections; that an agent
arrived is known from the recording, so it moves evenly from the moment it set off to the moment it was there.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.layout import poses
from pursue_gen.drawing.look import AgentLook, agent_looks, mark, safe, tag, text
from pursue_gen.explanation.network_words import Words, words_of
from pursue_gen.files import write_texts
from pursue_gen.language.scenario import Agent, Scenario
from pursue_gen.report import timeline
from pursue_gen.report.html import Section, asset, data, page
from pursue_gen.report.recording import Recording, Stay, Step, ending_words, stays
from pursue_gen.report.timeline import event_words

_ID = "animation"
_AWAY = 28.0
"""px from the middle of a place to the marks of those who are there."""

Point = Tuple[float, float]


@dataclass(frozen=True)
class Leg:
    """From one point of the picture to another, between two moments; standing still where the points are equal."""

    start: float
    end: float
    a: Point
    b: Point
    told: str


def check_name(file: Path) -> None:
    """Raises PursueError (exit status 2) for a file that is not called as a picture or a page is."""
    if file.suffix not in (".svg", ".html"):
        message = f"--timeline {file}: it is not known what that is to be"
        hint = "name a file that ends with .svg (the timeline), or .html (a page with the timeline and an animation)"
        raise PursueError([error("REP010", message, hint=hint)], exit_status=2)


def write(recording: Recording, file: Path) -> None:
    """Writes the timeline (.svg), or a page with timeline and animation (.html). Raises PursueError (status 2)."""
    check_name(file)
    if file.suffix == ".svg":
        write_texts({file: timeline.draw(recording)})
        return
    title = f"{recording.scenario.name}: {recording.source}"
    write_texts({file: page(title, [section(recording.scenario, recording), timeline.section(recording)])})


def section(scenario: Scenario, recording: Recording, ident: str = _ID) -> Section:
    """The animation as a part of a page."""
    film = {"end": recording.end, "agents": _tracks(scenario, recording), "steps": _steps(recording)}
    controls = (
        f'<div class="animation-controls" role="group" aria-label="Controls" hidden>'
        f'<button type="button" id="{ident}-back" aria-label="One step back">◀ step</button>'
        f'<button type="button" id="{ident}-play">▶ play</button>'
        f'<button type="button" id="{ident}-on" aria-label="One step on">step ▶</button>'
        f'<label>Time <input type="range" id="{ident}-time" min="0" max="{safe(recording.end)}" step="any" value="0">'
        f'</label> <output id="{ident}-now">0</output>'
        f'<label>Speed <select id="{ident}-speed"><option value="0.5">½</option><option value="1">1</option>'
        '<option value="2" selected>2</option><option value="5">5</option><option value="10">10</option>'
        "</select> time units a second</label></div>"
    )
    told = f'<p id="{ident}-told" class="animation-told">0: it begins; {safe(ending_words(recording))} at the end</p>'
    where = f'<ul id="{ident}-where" class="animation-where">{"".join(_who(scenario, recording))}</ul>'
    shown = draw(scenario, recording, ident)
    picture = f'<div class="wide picture" tabindex="0" role="region" aria-label="Map">{shown}</div>'
    note = '<noscript><p class="quiet">This is the beginning; without scripts it stands still.</p></noscript>'
    body = f"{controls}{told}<figure>{picture}</figure>{where}{note}{data(f'{ident}-film', film)}"
    return Section(ident, "The mission on the map", body, asset("animation.css"), asset("animation.js"))


def draw(scenario: Scenario, recording: Recording, ident: str = _ID) -> str:
    """The map with everybody where they were at the beginning, as an SVG document."""
    where, computed = poses(scenario)
    ground = map_svg.draw(replace(scenario, agents=()), where, computed, None, f"{ident}-map")
    looks, tracks = agent_looks(recording.agents), _legs(scenario, recording)
    marks = [_mark(agent, looks[agent.name], tracks[agent.name][0].a, k, len(scenario.agents), ident)
             for k, agent in enumerate(scenario.agents)]
    cut = ground.rindex("</svg>")
    return f"{ground[:cut]}{''.join(marks)}{ground[cut:]}"


def _mark(agent: Agent, look: AgentLook, at: Point, number: int, count: int, ident: str) -> str:
    """An agent's shape and name around its own side of the place; the group is moved as a whole."""
    dx, dy = _aside(number, count)
    anchor = "middle" if abs(dx) < 9 else "start" if dx > 0 else "end"
    label = text(dx + (0 if anchor == "middle" else math.copysign(13, dx)), dy - (12 if anchor == "middle" else -5),
                 agent.name, "pg-strong pg-halo", anchor)
    busy = tag("circle", class_="busy", cx=dx, cy=dy, r=13.0, fill="none", stroke=look.colour, stroke_width=2.5,
               visibility="hidden")
    shape = mark(look, dx, dy, 9.0, stroke="#ffffff", stroke_width=1.5)
    place = f"translate({at[0]:.1f} {at[1]:.1f})"
    return tag("g", busy, shape, label, class_="agent", id=f"{ident}-agent-{number}", transform=place)


def _aside(number: int, count: int) -> Point:
    """On which side of a place an agent stands: above it, spread from left to right, so that nobody hides another."""
    if count == 1:
        return 0.0, -_AWAY
    angle = math.radians(-170 + 160 * number / (count - 1))
    return _AWAY * math.cos(angle), _AWAY * math.sin(angle)


# What the script gets -------------------------------------------------------------------------------------------------


def _tracks(scenario: Scenario, recording: Recording) -> List[Dict[str, Any]]:
    """For each agent its name, its side of a place, and its legs: [start, end, x, y, x, y, what it does, at work?]."""
    legs, count = _legs(scenario, recording), len(scenario.agents)
    return [
        {
            "name": agent.name,
            "aside": [round(v, 1) for v in _aside(number, count)],
            "legs": [
                [leg.start, leg.end, *(round(v, 1) for v in (*leg.a, *leg.b)), leg.told, leg.told.startswith("doing ")]
                for leg in legs[agent.name]
            ],
        }
        for number, agent in enumerate(scenario.agents)
    ]


def _steps(recording: Recording) -> List[List[Any]]:
    """The moments of the steps, and what happened then."""
    words = words_of(recording.scenario, recording.network)
    told = [[step.at, _said(step, words, recording)] for step in recording.steps]
    over = recording.steps[-1].at >= recording.end
    return told if over else [*told, [recording.end, ending_words(recording)]]


def _said(step: Step, words: Words, recording: Recording) -> str:
    if not step.event:
        return step.reason or ("it begins" if step is recording.steps[0] else step.status)
    said = event_words(step, words, recording.network)
    told = f"{step.agent} {said}" if step.agent in recording.agents else said
    last = step is recording.steps[-1] and step.status != "running"
    return f"{told}; {ending_words(recording)}" if last else told


def _who(scenario: Scenario, recording: Recording) -> List[str]:
    """A line for each agent: where it is at the beginning."""
    legs = _legs(scenario, recording)
    return [f"<li><b>{safe(agent.name)}</b> <span>{safe(legs[agent.name][0].told)}</span></li>"
            for agent in scenario.agents]


def _legs(scenario: Scenario, recording: Recording) -> Dict[str, List[Leg]]:
    """What every agent does, on the picture."""
    words = words_of(scenario, recording.network)
    where, computed = poses(scenario)
    ground = map_svg.draw(replace(scenario, agents=()), where, computed)
    found = re.search(r'viewBox="0 0 ([\d.]+)', ground)
    assert found is not None, "a picture has a size"
    paper = map_svg.Paper(where, None, float(found.group(1)))
    places = {name: paper.point(pose.x, pose.y) for name, pose in where.items()}
    return {agent.name: _legs_of(agent, recording, words, places) for agent in scenario.agents}


def _legs_of(agent: Agent, recording: Recording, words: Words, places: Mapping[str, Point]) -> List[Leg]:
    legs = []
    for stay in stays(recording, agent.name):
        part = words.parts.get(stay.what, ("at", agent.location.name))
        told = words.place(agent.name, stay.what)
        a = places[part[1]]
        b = _reached(recording, stay, agent, a, places[part[2]], part) if part[0] == "way" else a
        legs.append(Leg(stay.start, stay.end, a, b, told))
    return legs


def _reached(
    recording: Recording, stay: Stay, agent: Agent, a: Point, b: Point, part: Tuple[str, ...]
) -> Point:
    """Where a movement ends: at the other place, or on the way where the recording ends before (or it is given up)."""
    after = next((step.locations.get(agent.name) for step in recording.steps if step.at >= stay.end), None)
    if stay.over and after == part[2]:
        return b
    ways = (c.distance for c in recording.scenario.connections if {c.a, c.b} == {part[1], part[2]})
    share = min(0.95, (stay.end - stay.start) / (next(ways, 1) * (agent.mobile or 1) + 1))
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])
