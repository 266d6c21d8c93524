"""What the page shows of a text, as plain data: places, ways, agents, events, the other statements, findings."""

from __future__ import annotations

from typing import Any, Collection, Dict, List, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, Severity, Span, as_json, in_order
from pursue_gen.drawing.ground import Ground
from pursue_gen.drawing.layout import drawable
from pursue_gen.drawing.look import agent_looks, mark
from pursue_gen.language.conditions import Condition, condition_text
from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.lengths import unit_of_distance
from pursue_gen.language.names import KINDS
from pursue_gen.language.numbers import Number
from pursue_gen.language.occurrences import GROUP
from pursue_gen.language.rewriting import parts_in, parts_of
from pursue_gen.language.scenario import Connection, Poi
from pursue_gen.language.sentences import end_words, objective_words
from pursue_gen.language.statements.agent import SIZE
from pursue_gen.language.statements.event import counted_text
from pursue_gen.language.syntax import Statement
from pursue_gen.language.template import names_text
from pursue_gen.language.times import unit_name, window_text, written_time
from pursue_gen.language.tokens import bare
from pursue_gen.language.word import HOLE
from pursue_gen.solving.inputs import findings_of
from pursue_gen.tools.draw.made import names, number_at
from pursue_gen.tools.draw.places import positions
from pursue_gen.tools.draw.poses import heading
from pursue_gen.tools.draw.statement_edits import names_behind, words_behind
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import but_for_ways, check_spots
from pursue_gen.workspace.robot_size import NOTHING_TOLD, Told, sizes_of
from pursue_gen.workspace.spots import SPOT_DISTANCE

_MOST_FINDINGS = 200
_MOVES = ("takes", "gives", "mounts", "needs")


def view(
    text: str, file: str = "scenario.pur", ground: Optional[Ground] = None, told: Told = NOTHING_TOLD
) -> Dict[str, Any]:
    """The picture's parts and the findings of a text, right or wrong, and what is wanted in sentences.

    `ground`: whether robots have room where they stand on it is looked at, too; `told`: of their sizes.

    Distances and times are texts as they are written, positions metres, headings degrees; `statement` is the number by
    which `operations.change` knows a part, `from` and `to` are its first and last line, counted from 1. Of what comes
    of a statement that is for each of a group, `made` is the member; it is changed in its statement only. `pace`: what
    `mobile` counts.
    """
    document = Draft.of(text, file)
    found = _findings(document, ground, told)
    places = _places(document)
    return {
        "places": places,
        "computed": positions(document.scenario)[1],
        "ways": _ways(document, {place["name"] for place in places}),
        "agents": _agents(document),
        "events": _events(document),
        "others": [_other(document, k) for k, one in enumerate(document.statements) if not parts_in(one.kind)],
        "names": {kind: names(document, kind) for kind in (*KINDS, GROUP)},
        "findings": [_finding(document, one) for one in found[:_MOST_FINDINGS]],
        "errors": sum(one.severity is Severity.ERROR for one in found),
        "warnings": sum(one.severity is Severity.WARNING for one in found),
        "wanted": _wanted(document, found),
        "pace": f"{unit_name(document.scenario.unit)} per {unit_of_distance(document.scenario.in_metres)}",
    }


def forms() -> List[Dict[str, Any]]:
    """The statements that can be chosen from lists: their words cut at their holes, and what belongs into each hole."""
    found = []
    for kind, statement in STATEMENTS.items():
        for number, form in enumerate(() if statement.parts else statement.forms):
            kinds = {"=": "example", "": "name"}
            holes = [{"kind": kinds[example], "of": what} for example, what in HOLE.findall(form.words)]
            words = HOLE.split(form.words)[::3]
            found.append({"kind": kind, "form": number, "title": form.title, "words": words, "holes": holes})
    return found


def _findings(document: Draft, ground: Optional[Ground], told: Told) -> Tuple[Diagnostic, ...]:
    """What `pursue-gen check` reports, with --map where there is a map."""
    found = findings_of(document.reading)
    scenario = document.reading.scenario
    wrong = but_for_ways(found)
    if ground is None or scenario is None or any(one.severity is Severity.ERROR for one in wrong):
        return found
    return in_order((*found, *check_spots(scenario, (Level(ground),), SPOT_DISTANCE, sizes_of(scenario, told))))


def _wanted(document: Draft, findings: Sequence[Diagnostic]) -> List[str]:
    """The objectives in sentences; none as long as there are errors."""
    wrong = any(one.severity is Severity.ERROR for one in findings)
    scenario = document.reading.scenario
    return [] if wrong or scenario is None else [*objective_words(scenario), *end_words(scenario)]


def _finding(document: Draft, finding: Diagnostic) -> Dict[str, Any]:
    """A finding with `start` and `end` as offsets that JavaScript counts; None where it is about the whole text."""
    shown = as_json(finding)
    if finding.span is not None:
        start, end = document.lines.of_span(finding.span)
        shown["start"], shown["end"] = (_in_utf_16(document.text, at) for at in (start, end))
    return shown


def _in_utf_16(text: str, offset: int) -> int:
    before = text[:offset]
    return offset if before.isascii() else len(before.encode("utf-16-le", "surrogatepass")) // 2


def _placed(document: Draft, number: int) -> Dict[str, Any]:
    """The lines of a statement."""
    statement = document.statements[number]
    first, last = (document.lines.of(at) + 1 for at in (statement.start, statement.end))
    return {"statement": number, "from": first, "to": last}


def _made(document: Draft, span: Span) -> Dict[str, Any]:
    """The lines of a statement that is for each of a group, and the member."""
    return {**_placed(document, number_at(document, span)), "made": span.member}


def _condition(condition: Optional[Condition]) -> str:
    return "" if condition is None else condition_text(condition)


def _whole(document: Draft, kind: str) -> List[Tuple[int, Statement]]:
    """The statements of a kind whose parts can be shown: those that name something begin with its name."""
    found = []
    for number, statement in enumerate(document.statements):
        is_first = statement.name is None or _is_first(document, number)
        if statement.kind == kind and statement.tokens[0].type == kind and is_first:
            found.append((number, statement))
    return found


def _is_first(document: Draft, number: int) -> bool:
    """True where no statement above declares the same name."""
    name = bare(document.statements[number].name)
    return any(kind.get(name) and kind[name].statement == number for kind in document.declared.values())


def _places(document: Draft) -> List[Dict[str, Any]]:
    where, _ = positions(document.scenario)
    found = []
    for poi in drawable(document.scenario).pois:
        here = document.declared["POI"].get(poi.name)
        pose = where.get(poi.name)
        if pose is None or (here is None and not poi.span.member):
            continue
        place = {"name": poi.name, "label": poi.label or "", "x": pose.x, "y": pose.y, "yaw": heading(pose)}
        spots = [{"robot": spot.robot.name, "x": spot.pose.x, "y": spot.pose.y} for spot in poi.spots]
        origin = _made(document, poi.span) if here is None else _placed(document, here.statement)
        whom = _whom_made(poi) if here is None else _whom(document.statements[here.statement])
        found.append({**place, "given": poi.pose is not None, "spots": spots, **whom, **origin})
    return found


def _whom(statement: Statement) -> Dict[str, str]:
    """For whom a place or a way is, as it is written."""
    return {"only_for": words_behind(statement, "FOR"), "not_for": words_behind(statement, "EXCEPT")}


def _whom_made(part: Union[Poi, Connection]) -> Dict[str, str]:
    """The same of what is for each of a group."""
    return {"only_for": names_text(part.only_for), "not_for": names_text(part.not_for)}


def _ways(document: Draft, known: Collection[str]) -> List[Dict[str, Any]]:
    """The ways between places that are shown."""
    found = []
    for number, statement in _whole(document, "CONNECT"):
        a, b = words_behind(statement, "CONNECT"), words_behind(statement, "AND")
        if a in known and b in known and a != b:
            way = {"a": a, "b": b, "distance": words_behind(statement, "DISTANCE")}
            way["only_if"] = words_behind(statement, "ONLY_IF")
            way.update(_whom(statement))
            found.append({**way, "one_way": statement.first("ONE_WAY") is not None, **_placed(document, number)})
    for one in document.scenario.connections:
        if one.span.member and {one.a, one.b} <= {*known} and one.a != one.b:
            way = {"a": one.a, "b": one.b, "distance": written_time(one.distance), "only_if": _condition(one.only_if)}
            way.update(_whom_made(one))
            found.append({**way, "one_way": one.one_way, **_made(document, one.span)})
    return found


def _agents(document: Draft) -> List[Dict[str, Any]]:
    statements = [(k, one) for k, one in _whole(document, "AGENT") if one.name is not None]
    known = {one.name: one for one in reversed(document.scenario.agents)}
    made = [one for one in document.scenario.agents if one.span.member]
    looks = agent_looks([*(bare(one.name) for _, one in statements), *(one.name for one in made)])
    found = []
    for number, one in statements:
        name, parts = bare(one.name), parts_of(one)
        kind = "free" if "CONTROLLABLE" not in parts else "person" if "HUMAN" in parts else "robot"
        agent = {"name": name, "label": words_behind(one, "LABEL")[1:-1], "kind": kind}
        agent.update(mobile=words_behind(one, "MOBILE"), speed=words_behind(one, "SPEED"))
        agent.update({key: words_behind(one, key.upper()) for key in (*SIZE, "carries", "has", "location")})
        agent["mark"] = mark(looks[name], 0, 0, 6.0)
        lists = {key: names_behind(one, key.upper()) for key in ("can_do", "reacts_to")}
        if name in known:  # groups are lists of their members
            lists = {key: [ref.name for ref in getattr(known[name], key)] for key in lists}
        found.append({**agent, **lists, **_placed(document, number)})
    for each in made:
        kind = "free" if not each.controllable else "person" if each.human else "robot"
        agent = {"name": each.name, "label": each.label or "", "kind": kind, "location": each.starts_text}
        agent.update(mobile="" if each.speed else str(each.mobile or ""), speed=str(each.speed or ""))
        agent.update({word: _length(getattr(each, word)) for word in SIZE})
        agent.update(carries=str(each.carries or ""), has=names_text(each.has))
        agent.update(mark=mark(looks[each.name], 0, 0, 6.0))
        lists = {key: [ref.name for ref in getattr(each, key)] for key in ("can_do", "reacts_to")}
        found.append({**agent, **lists, **_made(document, each.span)})
    return found


def _length(number: Optional[Number]) -> str:
    """A length as it is written; "" where there is none."""
    return "" if number is None else written_time(number)


_TICKS = ("collaborative", "together", "may_stop")
"""What is so of an event, or not."""


def _events(document: Draft) -> List[Dict[str, Any]]:
    found = []
    for number, one in _whole(document, "EVENT"):
        if one.name is None:
            continue
        parts = parts_of(one)
        event = {"name": bare(one.name), "label": words_behind(one, "LABEL")[1:-1]}
        texts = {key: words_behind(one, key.upper()) for key in ("location", "duration", *_MOVES, "only_if")}
        at_most = words_behind(one, "AT_MOST").partition(" ")[0]
        ticks = {key: key.upper() in parts for key in _TICKS}
        event["parts"] = words_behind(one, "IN").partition(" ")[0]
        found.append({**event, **texts, "at_most": at_most, **ticks, **_placed(document, number)})
    for each in document.scenario.events:
        if each.span.member:
            event = {"name": each.name, "label": each.label or "", "at_most": str(each.at_most or "")}
            event.update(location=each.location.name if each.location else "", only_if=_condition(each.only_if))
            event["parts"] = str(each.split or "")
            event["duration"] = "" if each.duration is None else window_text(each.duration, each.latest)
            counts = {"takes": each.taken, "gives": each.given}
            event.update({key: counted_text(getattr(each, key), counts.get(key, 1)) for key in _MOVES})
            ticks = {key: getattr(each, key) for key in _TICKS}
            found.append({**event, **ticks, **_made(document, each.span)})
    return found


def _other(document: Draft, number: int) -> Dict[str, Any]:
    """A statement as its words."""
    statement = document.statements[number]
    words = " ".join(document.text[statement.start : statement.end].split())
    single = not document.comments_in(statement)  # then its words can be changed as one line
    return {"kind": statement.kind, "words": words, "single": single, **_placed(document, number)}
