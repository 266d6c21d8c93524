"""What the page shows of a text, as plain data: places, ways, agents, events, the other statements, findings."""

from __future__ import annotations

from typing import Any, Collection, Dict, List, Optional, Sequence, Tuple, Union

from pursue_gen.diagnostics import Diagnostic, Severity, Span, as_json, in_order
from pursue_gen.drawing.ground import Ground
from pursue_gen.drawing.layout import drawable
from pursue_gen.drawing.look import agent_looks, mark
from pursue_gen.language.document import Document
from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import STATEMENTS
from pursue_gen.language.measures import unit_of_distance
from pursue_gen.language.names import KINDS
from pursue_gen.language.occurrences import GROUP
from pursue_gen.language.rewriting import parts_in, parts_of
from pursue_gen.language.scenario import Agent, Connection, Event, Poi
from pursue_gen.language.sentences import end_words, objective_words
from pursue_gen.language.statements.agent import SIZE
from pursue_gen.language.syntax import Statement
from pursue_gen.language.times import unit_name
from pursue_gen.language.tokens import bare
from pursue_gen.language.word import HOLE
from pursue_gen.solving.inputs import findings_of
from pursue_gen.tools.draw.made import names, number_at
from pursue_gen.tools.draw.places import heading, positions
from pursue_gen.tools.draw.statement_edits import names_behind, words_behind
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.map_check import but_for_ways, check_spots
from pursue_gen.workspace.robot_size import NOTHING_TOLD, Told, sizes_of
from pursue_gen.workspace.spots import SPOT_DISTANCE

_MOST_FINDINGS = 200
_OF_AGENTS = ("mobile", "speed", *SIZE, "carries", "has", "location")
_OF_EVENTS = ("location", "duration", "takes", "gives", "mounts", "needs", "only_if")
"""What stands behind the words that these fields are called like."""
_TICKS = ("collaborative", "together", "may_stop")
"""What is so of an event, or not."""

Part = Union[Poi, Connection, Agent, Event]


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


def _whole(document: Draft, kind: str, read: Sequence[Part]) -> List[Tuple[Statement, Dict[str, Any]]]:
    """The statements of a kind whose parts can be shown, with their lines: those that name something begin with its
    name. Behind them what of `read` comes of statements that are for each of a group, written out."""
    found = []
    for number, statement in enumerate(document.statements):
        is_first = statement.name is None or _is_first(document, number)
        if statement.kind == kind and statement.tokens[0].type == kind and is_first:
            found.append((statement, _placed(document, number)))
    made = [part for part in read if part.span.member]
    return [*found, *zip(_written_out(made), (_made(document, part.span) for part in made))]


def _written_out(parts: Sequence[Part]) -> Tuple[Statement, ...]:
    """A statement for each part."""
    return Document("\n".join(part.text for part in parts)).statements


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
        whom = _whom(_written_out([poi])[0] if here is None else document.statements[here.statement])
        found.append({**place, "given": poi.pose is not None, "spots": spots, **whom, **origin})
    return found


def _whom(statement: Statement) -> Dict[str, str]:
    """For whom a place or a way is, as it is written."""
    return {"only_for": words_behind(statement, "FOR"), "not_for": words_behind(statement, "EXCEPT")}


def _ways(document: Draft, known: Collection[str]) -> List[Dict[str, Any]]:
    """The ways between places that are shown."""
    found = []
    for statement, placed in _whole(document, "CONNECT", document.scenario.connections):
        a, b = words_behind(statement, "CONNECT"), words_behind(statement, "AND")
        if a in known and b in known and a != b:
            texts = {key: words_behind(statement, key.upper()) for key in ("distance", "only_if")}
            one_way = statement.first("ONE_WAY") is not None
            found.append({"a": a, "b": b, **texts, **_whom(statement), "one_way": one_way, **placed})
    return found


def _agents(document: Draft) -> List[Dict[str, Any]]:
    statements = _whole(document, "AGENT", document.scenario.agents)
    known = {one.name: one for one in reversed(document.scenario.agents)}
    looks = agent_looks([bare(one.name) for one, _ in statements if one.name is not None])
    found = []
    for one, placed in statements:
        if one.name is None:
            continue
        name, parts = bare(one.name), parts_of(one)
        kind = "free" if "CONTROLLABLE" not in parts else "person" if "HUMAN" in parts else "robot"
        agent = {"name": name, "label": words_behind(one, "LABEL")[1:-1], "kind": kind}
        agent.update({key: words_behind(one, key.upper()) for key in _OF_AGENTS})
        lists = {key: names_behind(one, key.upper()) for key in ("can_do", "reacts_to")}
        if name in known:  # groups are lists of their members
            lists = {key: [ref.name for ref in getattr(known[name], key)] for key in lists}
        found.append({**agent, "mark": mark(looks[name], 0, 0, 6.0), **lists, **placed})
    return found


def _events(document: Draft) -> List[Dict[str, Any]]:
    found = []
    for one, placed in _whole(document, "EVENT", document.scenario.events):
        if one.name is None:
            continue
        parts = parts_of(one)
        event = {"name": bare(one.name), "label": words_behind(one, "LABEL")[1:-1]}
        texts = {key: words_behind(one, key.upper()) for key in _OF_EVENTS}
        numbers = {"parts": words_behind(one, "IN"), "at_most": words_behind(one, "AT_MOST")}
        texts.update({key: words.partition(" ")[0] for key, words in numbers.items()})
        found.append({**event, **texts, **{key: key.upper() in parts for key in _TICKS}, **placed})
    return found


def _other(document: Draft, number: int) -> Dict[str, Any]:
    """A statement as its words."""
    statement = document.statements[number]
    words = " ".join(document.text[statement.start : statement.end].split())
    single = not document.comments_in(statement)  # then its words can be changed as one line
    return {"kind": statement.kind, "words": words, "single": single, **_placed(document, number)}
