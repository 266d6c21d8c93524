"""A picture of the map: places, connections with distances, who starts where, what happens where, who can do what."""

from __future__ import annotations

import math
from typing import Dict, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.look import QUIET, AgentLook, agent_looks, mark, svg, tag, text
from pursue_gen.language.conditions import condition_words
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import Agent, Connection, Event, Pose, Scenario
from pursue_gen.language.sentences import speed_words, window_words
from pursue_gen.language.times import written_time

_WIDTH, _WIDEST = 640.0, 1600.0
_MARGIN, _RIM = 80.0, 12.0
_LINE = 19.0
_LETTER = 7.8  # px, a generous guess at how wide a letter is
_ROOMY = 14  # so many places fit the usual width
_BEFORE, _HEAD = 18.0, 12.0  # px: how far before a place an arrow ends, and how long its head is

Point = Tuple[float, float]


def draw(
    scenario: Scenario,
    poses: Mapping[str, Pose],
    computed: bool,
    floor: Optional[Floor] = None,
    ident: str = "",
    spots: Optional[Mapping[str, Mapping[str, Pose]]] = None,
) -> str:
    """The map as an SVG document; `computed` adds a note that the poses were computed, not given.

    `floor` is drawn under it, `ident` is the picture's id in a page. `spots`: agent → place → pose; those beside the
    poses of their places get the agent's mark.
    """
    paper = paper_of(scenario, poses, floor)
    places = {name: paper.point(pose.x, pose.y) for name, pose in poses.items()}
    looks = agent_looks([agent.name for agent in scenario.agents])
    body = [paper.floor(floor)] if floor else []
    for ways in _beside_each_other(scenario):
        body += _connection(paper.way(ways[0].a, ways[0].b), ways)
    body += [_poi(scenario.shown(name), places[name]) for name in sorted(places)]
    for agent_name, table in (spots or {}).items():
        beside = [pose for place, pose in table.items() if pose != poses[place]]
        body += [mark(looks[agent_name], *paper.point(pose.x, pose.y), 5.0) for pose in beside]
    body += _happening(scenario, places)
    body += _standing(scenario, places, looks)
    above, below = _room(scenario, places, paper.height)
    for agent in scenario.agents:
        lines = _wrapped(_description(agent, scenario), paper.width - 150)
        body += _legend(looks[agent.name], lines, below)
        below += _LINE * len(lines) + 8
    notes = [_anywhere(scenario)] if _anywhere(scenario) else []
    notes += list(_conditions(scenario))
    notes += ["positions computed from the distances"] if computed else []
    for note in notes:
        for line in _wrapped(note, paper.width - 40):
            body.append(text(20, below + 12, line, "pg-small", "start"))
            below += _LINE
    title = f"Map of {scenario.name}"
    description = f"{len(places)} places, {len(scenario.connections)} connections, {len(scenario.agents)} agents"
    if above:  # many agents start at a place near the upper rim
        body = [tag("g", "\n".join(body), transform=f"translate(0 {above:.2f})")]
    return svg(paper.width, above + below + 10, title, description, body, ident)


def paper_of(scenario: Scenario, poses: Mapping[str, Pose], floor: Optional[Floor]) -> Paper:
    """On what the map of a scenario is drawn."""
    width = min(_WIDEST, _WIDTH * math.sqrt(max(1.0, len(poses) / _ROOMY)))
    return Paper(poses, floor, width, _margin(scenario))


def _margin(scenario: Scenario) -> float:
    """How much room the labels beside places at the rim need, in pixels."""
    bound = (event for event in scenario.events if event.location is not None)
    labels = [f"⚙ {event.shown}{_lasts(event, scenario.unit)}" for event in bound if event.label]
    labels += [poi.label for poi in scenario.pois if poi.label]
    labels += [f"{agent.label}    " for agent in scenario.agents if agent.label]  # its mark is before it
    return min(max([_MARGIN, *(_LETTER * len(label) / 2 + _RIM for label in labels)]), _WIDTH / 3)


class Paper:
    """From metres to points on the picture (y downwards), one scale for both directions."""

    def __init__(self, poses: Mapping[str, Pose], floor: Optional[Floor], width: float, around: float) -> None:
        """`around`: the margin, in pixels, where there is no floor plan."""
        self.width, self._poses, self._paths = width, poses, floor.paths if floor else {}
        points = [(pose.x, pose.y) for pose in poses.values()] + list(floor.corners() if floor else ())
        xs, ys = [x for x, _ in points] or [0.0], [y for _, y in points] or [0.0]
        margin = 30.0 if floor else around
        self.scale = (width - 2 * margin) / max(max(xs) - min(xs), max(ys) - min(ys), 1e-6)
        self._left = (width - self.scale * (max(xs) - min(xs))) / 2 - self.scale * min(xs)
        self._top = margin + self.scale * max(ys)
        self.height = 2 * margin + self.scale * (max(ys) - min(ys))

    def point(self, x: float, y: float) -> Point:
        """Where a point of the map is on the picture."""
        return self._left + self.scale * x, self._top - self.scale * y

    def way(self, a: str, b: str) -> List[Point]:
        """The way from one place to another on the picture, along its path where that is known."""
        bends = self._paths.get((a, b)) or self._paths.get((b, a), ())[::-1]
        ends = [self.point(pose.x, pose.y) for pose in (self._poses[a], self._poses[b])]
        return [ends[0], *(self.point(*bend) for bend in bends[1:-1]), ends[1]]

    def floor(self, floor: Floor) -> str:
        """The floor plan, pale, so that what is drawn on it can be read."""
        x, y = self.point(floor.x, floor.y)
        size = self.scale * floor.resolution
        height = floor.height * size
        turn = f"translate({x:.2f} {y:.2f}) rotate({-math.degrees(floor.yaw):.3f}) translate(0 {-height:.2f})"
        picture = {"width": floor.width * size, "height": height, "href": floor.uri}
        return tag("g", tag("image", opacity=0.6, preserveAspectRatio="none", **picture), transform=turn)


def _beside_each_other(scenario: Scenario) -> List[List[Connection]]:
    """The ways, those together that are one line: each is for agents of its own."""
    found: Dict[Tuple[str, str], List[Connection]] = {}
    for way in scenario.connections:
        a, b = way.directions[0]
        ends = (a, b) if way.one_way or (b, a) not in found else (b, a)
        found.setdefault(ends, []).append(way)
    return list(found.values())


def _connection(line: Sequence[Point], ways: Sequence[Connection]) -> Iterator[str]:
    """A line with its length in the middle; one that goes one way has its length, and an arrow, nearer to its end.

    Where it is not always open, the line is dashed and a question mark is behind the length. `ways`: of different
    agents, which have their own lengths.
    """
    way = ways[0]
    dash = None if all(each.only_if is None for each in ways) else "7 5"
    length = ", ".join(dict.fromkeys(written_time(each.distance) for each in ways))
    if len(line) == 2:
        (x1, y1), (x2, y2) = line
        yield tag("line", class_="pg-way", x1=x1, y1=y1, x2=x2, y2=y2, stroke_dasharray=dash)
    else:
        points = " ".join(f"{x:.2f},{y:.2f}" for x, y in line)
        yield tag("polyline", class_="pg-way", points=points, stroke_dasharray=dash)
    part = 0.5
    if way.one_way:
        part = 0.42  # two that go opposite ways do not cover each other's lengths
        yield _arrow(*line[-2:])
    x, y = first_part(line, part)[-1]
    yield text(x, y + 5, f"{length} ?" if dash else length, "pg-small pg-halo")


def first_part(line: Sequence[Point], part: float) -> Tuple[Point, ...]:
    """So much of a line with bends, from 0 to 1."""
    left = part * sum(math.dist(a, b) for a, b in zip(line, line[1:]))
    found = [line[0]]
    for a, b in zip(line, line[1:]):
        if left <= 0:
            break
        size = math.dist(a, b)
        share = min(1.0, left / size) if size else 1.0
        found.append((a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])))
        left -= size
    return tuple(found)


def _arrow(a: Point, b: Point) -> str:
    """The head of an arrow from a to b, in front of the place."""
    length = math.dist(a, b) or 1.0
    along = (b[0] - a[0]) / length, (b[1] - a[1]) / length
    tip = b[0] - _BEFORE * along[0], b[1] - _BEFORE * along[1]
    back = tip[0] - _HEAD * along[0], tip[1] - _HEAD * along[1]
    sides = [(back[0] - k * along[1], back[1] + k * along[0]) for k in (_HEAD / 2, -_HEAD / 2)]
    points = " ".join(f"{x:.2f},{y:.2f}" for x, y in (tip, *sides))
    return tag("polygon", fill=QUIET, points=points)


def _poi(name: str, at: Point) -> str:
    """A circle with the name in it, or under it if it is long."""
    circle = tag("circle", class_="pg-poi", cx=at[0], cy=at[1], r=16.0)
    inside = len(name) <= 3
    words = text(at[0], at[1] + (5 if inside else 31), name, "pg-strong" if inside else "pg-strong pg-halo")
    return f"{circle}\n{words}"


def _happening(scenario: Scenario, places: Mapping[str, Point]) -> List[str]:
    """Under each place what happens there, and how long it takes."""
    rows: Dict[str, int] = {}
    parts = []
    for event in scenario.events:
        if event.location is None or event.location.name not in places:
            continue
        name = event.location.name
        x, y = places[name]
        first = 31 if len(scenario.shown(name)) <= 3 else 47
        words = f"⚙ {event.shown}{_lasts(event, scenario.unit)}"
        parts.append(text(x, y + first + 15 * rows.get(name, 0), words, "pg-small pg-halo"))
        rows[name] = rows.get(name, 0) + 1
    return parts


def _room(scenario: Scenario, places: Mapping[str, Point], height: float) -> Point:
    """How much is needed above the paper for agents' names, and where what stands below it may begin."""
    above, below = 0.0, height
    for name, (_, y) in places.items():
        agents = sum(ref.name == name for agent in scenario.agents for ref in agent.starts)
        events = sum(event.location is not None and event.location.name == name for event in scenario.events)
        above = max(above, 40 + 17 * (agents - 1) - y if agents else 0.0)
        below = max(below, y + 60 + 15 * events)
    return above, below


def _standing(scenario: Scenario, places: Mapping[str, Point], looks: Mapping[str, AgentLook]) -> List[str]:
    """The agents above the POI where they start, one above the other; above each where they may, with a question mark.
    """
    parts = []
    standing: Dict[str, int] = {}
    starts = ((agent, ref.name) for agent in scenario.agents for ref in agent.starts if ref.name in places)
    for agent, place in starts:
        x, y = places[place]
        row = standing.get(place, 0)
        standing[place] = row + 1
        shown = f"{agent.shown}?" if agent.is_somewhere else agent.shown
        up, half = y - 26 - 17 * row, _LETTER * len(shown) / 2
        parts.append(mark(looks[agent.name], x - half - 4, up - 5, 7.0))
        parts.append(text(x + 8, up, shown, "pg-halo"))
    return parts


def _legend(look: AgentLook, lines: List[str], top: float) -> List[str]:
    """An agent's mark and line, its name, and what it is and can do."""
    stroke = {"stroke": look.colour, "stroke_width": 2.5, "stroke_dasharray": look.dash}
    line = tag("line", x1=34, y1=top + 7, x2=74, y2=top + 7, **stroke)
    words = (text(84, top + 12 + _LINE * k, words, "", "start") for k, words in enumerate(lines))
    return [mark(look, 20, top + 7, 7.0), line, *words]


def _description(agent: Agent, scenario: Scenario) -> str:
    """What an agent is and can do, in a sentence."""
    parts = [f"{agent.shown}: {agent.kind_words}, {speed_words(agent, scenario)}"]
    if agent.can_do:
        parts.append("can do " + ", ".join(ref.shown for ref in agent.can_do))
    if agent.reacts_to:
        parts.append("takes part in " + ", ".join(ref.shown for ref in agent.reacts_to))
    return "; ".join(parts)


def _anywhere(scenario: Scenario) -> str:
    """Events that are bound to no place."""
    free = [event.shown + _lasts(event, scenario.unit) for event in scenario.events if event.location is None]
    return f"Anywhere: {', '.join(free)}" if free else ""


def _lasts(event: Event, unit: Optional[Number]) -> str:
    """How long an event takes, in brackets; nothing where it takes no time. Then what it moves, and how often it can
    happen."""
    times = "" if event.at_most is None else f" at most {event.at_most}"
    moves = f" {event.load_words}" if event.load_words else ""
    parts = f" in {event.split} parts" if event.split else ""
    return ("" if event.window is None else f" ({window_words(event.window, unit)}{parts})") + moves + times


def _conditions(scenario: Scenario) -> Iterator[str]:
    """The places and ways that are not for all, the ways and events that are not always open, and while what."""
    yield from (f"{poi.shown} {poi.whom_words}" for poi in scenario.pois if poi.whom_words)
    for way in scenario.connections:
        ends = f"{scenario.shown(way.a)} and {scenario.shown(way.b)}"
        lane = f" at distance {written_time(way.distance)}" if scenario.is_lane(way) else ""
        if way.whom_words:
            yield f"Between {ends}{lane} {way.whom_words}"
        yield from (f"Between {ends} {words}" for words in scenario.words_on(way))
        if way.only_if is not None:
            yield f"Between {ends} only while {condition_words(way.only_if)}"
    for event in scenario.events:
        if event.only_if is not None:
            yield f"{event.shown} only while {condition_words(event.only_if)}"


def _wrapped(words: str, room: float) -> List[str]:
    """The words in lines that fit so many pixels; a word that is longer than a line is cut into pieces."""
    most = max(8, int(room / _LETTER))
    lines = [""]
    for word in words.split(" "):
        for piece in [word[k : k + most] for k in range(0, len(word), most)] or [""]:
            if lines[-1] and len(lines[-1]) + 1 + len(piece) > most:
                lines.append("")
            lines[-1] += (" " if lines[-1] else "") + piece
    return lines
