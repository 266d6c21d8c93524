"""What a name, a number or a word of a scenario means, in plain words, as Markdown."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import takewhile
from typing import Any, Callable, List, Mapping, Optional, Tuple

from lark import Token

from pursue_gen.diagnostics import listed
from pursue_gen.language.batteries import full, levels
from pursue_gen.language.conditions import condition_words
from pursue_gen.language.draft import Draft
from pursue_gen.language.for_each import ranges_of
from pursue_gen.language.kinds import KEYWORDS, MEANINGS, STATEMENTS
from pursue_gen.language.labels import in_markdown, markdown
from pursue_gen.language.measures import unit_of_distance, units_of_distance
from pursue_gen.language.numbers import Number, exact, window_of
from pursue_gen.language.occurrences import GROUP, MEMBERS, VARIABLE, Occurrence
from pursue_gen.language.scenario import Agent, Event, Poi, Ref, Rule, Scenario, Window
from pursue_gen.language.statements.base import Written
from pursue_gen.language.statements.battery import MOST_CAPACITY
from pursue_gen.language.syntax import Statement
from pursue_gen.language.times import in_units, units_of_time, written_time
from pursue_gen.language.tokens import start_of
from pursue_gen.language.tree_reader import TreeReader

_MOST_LINES = 12
_PLURALS = {"POI": "places", "agent": "agents", "event": "events", "state": "states", "thing": "things"}


@dataclass(frozen=True)
class Hover:
    """The explanation of text[start:end]."""

    markdown: str
    start: int
    end: int


def hover(document: Draft, offset: int) -> Optional[Hover]:
    """The explanation of what stands at an offset; None where there is none."""
    occurrence = document.occurrence_at(offset)
    if occurrence is not None:
        text = _about_members(document, occurrence) or _about(document.scenario, occurrence.kind, occurrence.name)
        if text is None:
            text = f"There is no {occurrence.kind} `{occurrence.name}`."
        return Hover(text, occurrence.start, occurrence.end)
    token = document.token_at(offset)
    part = document.statement_at(offset)
    if token is None:
        return None
    start = start_of(token)
    if token.type in KEYWORDS:
        form = f"\n\n```pursue\n{STATEMENTS[token.type].form()}\n```" if token.type in STATEMENTS else ""
        return Hover(f"**{token}**: {MEANINGS[token.type]}{form}", start, start + len(token))
    number = _read(document, part, token) if part is not None and token.type == "NUMBER" else None
    if number is not None and part is not None:
        text = _number(document, part.body, start, number)
        return Hover(text, start, start + len(token)) if text else None
    return None


def read_time(document: Draft, token: Token) -> Optional[Number]:
    """The number of a token, as a time; None where it cannot be read."""
    reader = TreeReader(document.file, {}, document.scenario.unit)
    number = reader.time(token)
    return None if reader.findings else number


def _read(document: Draft, part: Statement, token: Token) -> Optional[Number]:
    """The number of a token of a statement, as what it counts there; None where it cannot be read."""
    if part.pair("DISTANCE") is None:
        return read_time(document, token)
    reader = TreeReader(document.file, {}, document.scenario.unit)
    number = reader.distance(token)
    return None if reader.findings else number


def lasts(window: Window, unit: Optional[Number]) -> str:
    """How long something takes. `unit`: the seconds of a time unit, None: the scenario does not say."""
    first, last = (in_units(end, unit) for end in window)
    return f"{written_time(first)} to {units_of_time(last)}"


def _about_members(document: Draft, here: Occurrence) -> str:
    """What a group, or a variable that stands for each of one, stands for; "" of other names."""
    groups, kinds = document.syntax.groups, document.declared
    if here.kind == GROUP:
        members = groups.get(here.name, ())
        kind = next((_PLURALS[kind] for kind in MEMBERS if members[:1] and members[0] in kinds[kind]), "things")
        return f"**{here.name}**: a group of {kind}\n\n- {listed(members) if members else 'nothing is in it'}"
    if here.kind != VARIABLE:
        return ""
    ranges = ranges_of(document.statements[here.statement].tokens)
    found = next((one for one in ranges if here.name in one.variables), None)
    if found is None:
        return f"**{here.name}**: a variable"
    members = groups.get("" if found.robots else str(found.group), ())
    others = [name for name in found.variables if name != here.name]
    group = "robots" if found.robots else found.group
    words = f"each of {group} in turn" if not others else f"one of {group}, beside {others[0]}: every pair once"
    return f"**{here.name}**: {words}\n\n- {listed(members) if members else 'nothing is in it'}"


def _about(scenario: Scenario, kind: str, name: str) -> Optional[str]:
    field = next(each.listed_in for each in STATEMENTS.values() if each.declares == kind)
    part = next((part for part in getattr(scenario, field) if part.name == name), None)
    if part is None:
        return None
    label, more = getattr(part, "label", None), _MORE.get(kind)
    read_as = f"; people read \u201c{markdown(label)}\u201d" if label else ""
    lines = [f"**{name}**: {part.described.format(part)}{read_as}", "", *(f"- {line}" for line in part.details)]
    return "\n".join([*lines, *(more(scenario, part) if more else ()), *_said(scenario, kind, name)])


def _listed(lines: List[str]) -> List[str]:
    more = len(lines) - _MOST_LINES
    return lines if more <= 0 else [*lines[:_MOST_LINES], f"- … and {more} more"]


def _poi(scenario: Scenario, poi: Poi) -> List[str]:
    lines = []
    ways = [way for way in scenario.connections if poi.name in (way.a, way.b)]
    for way in ways:
        other = way.b if way.a == poi.name else way.a
        there = (poi.name, other) in way.directions
        words, direction = (f"to {other}", (poi.name, other)) if there else (f"from {other} only", (other, poi.name))
        able = [agent for agent in scenario.agents if way in scenario.ways_of(agent.name)]
        movers = [(agent.name, scenario.movements(agent).get(direction)) for agent in able]
        times = ", ".join(f"{name} {lasts(window, scenario.unit)}" for name, window in movers if window is not None)
        only = f", only while {in_markdown(scenario, condition_words(way.only_if))}" if way.only_if is not None else ""
        whom = f", {in_markdown(scenario, way.whom_words)}" if way.whom_words else ""
        words += f": distance {written_time(way.distance)}"
        doors = "".join(f", {in_markdown(scenario, said)}" for said in scenario.words_on(way))
        lines.append(f"- {words}" + (f" ({times})" if times else "") + doors + whom + only)
    lines = _listed(lines)
    if not ways:
        lines.append("- no way leads here")
    lines += [f"- {in_markdown(scenario, poi.whom_words)}"] if poi.whom_words else []
    lines += _if_any("starts here", [a.name for a in scenario.agents if any(ref.name == poi.name for ref in a.starts)])
    here = [e.name for e in scenario.events if e.location is not None and e.location.name == poi.name]
    lines += _if_any("happens here", here)
    if poi.pose is not None:
        lines.append(f"- on the robot's map at x = {poi.pose.x:g} m, y = {poi.pose.y:g} m")
    for spot in poi.spots:
        lines.append(f"- {spot.robot.name} stands at x = {spot.pose.x:g} m, y = {spot.pose.y:g} m")
    return lines


def _event(scenario: Scenario, event: Event) -> List[str]:
    where = f"at {event.location.name}" if event.location else "wherever the agent is"
    lines = [f"- happens {where}"]
    lines.append(f"- takes {lasts(event.window, scenario.unit)}" if event.window is not None else "- takes no time")
    if event.split is not None:
        lines.append(f"- is done in {event.split} parts, each of which stays done")
    if event.at_most is not None:
        lines.append(f"- happens at most {event.at_most} times")
    lines += [f"- {in_markdown(scenario, event.load_words)}"] if event.load_words else []
    lines.append("- done by " + (", ".join(agent.name for agent in scenario.doers(event.name)) or "nobody"))
    if event.collaborative:
        reacts = {agent.name: {ref.name for ref in agent.reacts_to} for agent in scenario.agents}
        partners = ", ".join(name for name, some in reacts.items() if event.name in some)
        lines.append(f"- takes two at one place; the partner is {partners or 'nobody'}")
        if event.duration is not None:
            both = "both are busy until it ends" if event.together else "the partner may leave as soon as it has begun"
            lines.append(f"- {both}")
    return lines


def _rule(scenario: Scenario, rule: Rule) -> List[str]:
    lines = [f"- {rule.body.name if isinstance(rule.body, Ref) else rule.body.in_words}"]
    if rule.each:
        bound = ", ".join(agent.name for agent in scenario.bound_by(rule))
        lines.append(f"- each of these has its own turn: {bound or 'nobody'}")
    names = ", ".join(ref.name for ref in rule.events)
    return [*lines, f"- {names} can happen only when it is their turn"]


def _said(scenario: Scenario, kind: str, name: str) -> List[str]:
    """What statements say of a thing that another one declares."""
    parts: Tuple[Written, ...] = (
        *scenario.pois, *scenario.doors, *scenario.lifts, *scenario.rules, *scenario.dependencies,
        *scenario.connections, *scenario.events, *scenario.states, *scenario.batteries, *scenario.assumptions,
        *scenario.objectives,
    )  # fmt: skip
    return [f"- {line}" for part in parts for line in part.about(kind, name, partial(in_markdown, scenario))]


def _agent(scenario: Scenario, agent: Agent) -> List[str]:
    lines = [f"- starts at {agent.starts_text}"]
    if agent.mobile is None:
        lines.append("- stays there")
    else:
        needs = units_of_time(in_units(agent.mobile, scenario.unit))
        pace = f"needs {needs} for a {unit_of_distance(scenario.in_metres)}"
        lines.append(f"- {pace}" if agent.speed is None else f"- moves {agent.speed} metres in a second")
        own = {travel.way for travel in scenario.travels if travel.agent.name == agent.name}
        known = {(way.a, way.b) for way in scenario.connections} | own  # the other direction takes as long
        movements = scenario.movements(agent).items()
        ways = [((a, b), lasts(window, scenario.unit)) for (a, b), window in movements if (a, b) in known]
        lines += _listed([f"- {a} to {b}: {time}" for (a, b), time in ways])
    lines += [] if agent.carries is None else [f"- carries {agent.carries} at one time at most"]
    lines += _if_any("has at the start", [ref.name for ref in agent.has])
    lines += [f"- {words} on a map" for words in [agent.size_words] if words]
    lines += _if_any("can do", [ref.name for ref in agent.can_do])
    lines += _if_any("reacts to", [ref.name for ref in agent.reacts_to])
    return lines


_MORE: Mapping[str, Callable[[Scenario, Any], List[str]]] = {
    "POI": _poi, "event": _event, "rule": _rule, "agent": _agent
}  # fmt: skip
"""What the whole scenario has to say of a thing of a kind."""


def _number(document: Draft, part: Statement, start: int, time: Number) -> str:
    """What the number at an offset of a statement means; `time`: it, as it was written."""
    scenario, number = document.scenario, exact(time)
    words = [t.type for t in part.tokens if start_of(t) < start and t.type in KEYWORDS]
    word = words[-1] if words else ""
    movers = [agent for agent in scenario.agents if agent.mobile is not None]
    if word == "DISTANCE":
        lines = [f"A way of {units_of_distance(time, scenario.in_metres)}.", ""]
        of_it = [way for way in scenario.connections if way.span.line == part.tokens[0].line]
        able = [agent for agent in movers if not of_it or any(way.admits(agent.name) for way in of_it)]
        needs = [f"- {agent.name} needs {lasts(agent.window_on(number), scenario.unit)}" for agent in able]
        return "\n".join(lines + _listed(needs))
    if part.kind == "EVENT" and word in ("TAKES", "GIVES"):
        return f"So many at one time: {number}."
    begins = next((k for k, t in enumerate(part.tokens) if t.type in ("DURATION", "TAKES")), None)
    if begins is not None and word in ("DURATION", "TAKES", "TO"):
        written = takewhile(lambda token: token.type in ("NUMBER", "TO"), part.tokens[begins + 1 :])
        read = (read_time(document, token) for token in written if token.type == "NUMBER")
        numbers = [value for value in read if value is not None]
        return f"It takes {lasts(window_of(numbers[0], numbers[1] if len(numbers) > 1 else None), scenario.unit)}."
    behind = next((t.type for t in part.tokens if start_of(t) > start), "")
    if word in ("AT_MOST", "HOLDS") and behind != "TIMES":
        return f"No more than {number} at one time."
    if word == "MOBILE":
        pace = units_of_time(in_units(number, scenario.unit))
        lines = [f"It needs {pace} for a {unit_of_distance(scenario.in_metres)}; a larger number is slower.", ""]
        times = [(f"{way.a} to {way.b}", exact(way.distance * number)) for way in scenario.connections]
        ways = [f"- {name}: {lasts((time, exact(time + 1)), scenario.unit)}" for name, time in times]
        return "\n".join(lines + _listed(ways))
    if word == "SPEED":
        here = [agent for agent in movers if agent.span.line == part.tokens[0].line and agent.speed is not None]
        lines = [f"It moves {number} metres in a second.", ""]
        windows = [(way, agent.window_on(way.distance)) for agent in here for way in scenario.ways_of(agent.name)]
        ways = [f"- {way.a} to {way.b}: {lasts(window, scenario.unit)}" for way, window in windows]
        return "\n".join(lines + _listed(ways))
    if part.kind == "BATTERY":
        return _battery(scenario, part)
    stated = (one for one in (*scenario.assumptions, *scenario.objectives) if one.span.line == part.tokens[0].line)
    kinds = (STATEMENTS.get(word), *stated, STATEMENTS.get(part.kind))  # a number may stand behind optional itself
    return next(filter(None, (kind.number_words(word.lower(), time) for kind in kinds if kind is not None)), "")


def _battery(scenario: Scenario, part: Statement) -> str:
    """At how many levels a battery can be."""
    agents = {agent.name for agent in scenario.agents}
    for battery in scenario.batteries:
        here = battery.span.line == part.tokens[0].line and battery.agent.name in agents
        if here and full(scenario, battery) <= MOST_CAPACITY:
            count = len(levels(scenario, battery))
            return f"The battery can be at {count} levels; the game has up to {count} times as many states."
    return ""


def _if_any(words: str, names: List[str]) -> List[str]:
    return [f"- {words}: {', '.join(names)}"] if names else []
