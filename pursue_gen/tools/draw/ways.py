"""Ways that are drawn between two places: the first one, and others for other agents."""

from __future__ import annotations

from typing import Optional, Tuple

from pursue_gen.language.draft import Draft
from pursue_gen.language.numbers import read_number
from pursue_gen.language.rewriting import parts_of
from pursue_gen.language.syntax import Statement
from pursue_gen.language.times import written_time
from pursue_gen.tools.draw import fields
from pursue_gen.tools.draw.fields import Values, refused
from pursue_gen.tools.draw.made import check_place, names, not_there, number_at
from pursue_gen.tools.draw.places import lengths_per_metre, metres, positions
from pursue_gen.tools.draw.statement_edits import added, names_behind, with_part, words_behind


def connect(document: Draft, values: Values) -> Tuple[Draft, Optional[int]]:
    """{a, b, distance?, one_way?}: a way; without a distance it has the length of the line, in the scenario's unit."""
    a, b = fields.name_of(values, "a"), fields.name_of(values, "b")
    for name in (a, b):
        check_place(document, name)
    if a == b:
        raise refused(f"a way from {a} to itself", "choose another place")
    one_way = bool(values.get("one_way"))
    for number, statement in enumerate(document.statements):
        if statement.kind == "CONNECT" and _joins(statement, a, b, one_way):
            return document, number
    for way in document.scenario.connections:
        if way.span.member and ((a, b) in way.directions and (one_way or not way.one_way)):
            return document, number_at(document, way.span)
    distance = fields.length_of(values, "distance") if values.get("distance") else _length(document, a, b)
    return added(document, f"connect {a} and {b} distance {distance}{' one_way' if one_way else ''}")


def _joins(statement: Statement, a: str, b: str, one_way: bool) -> bool:
    """Is this the way already? One that goes both ways is."""
    parts = parts_of(statement)
    ends = tuple(str(parts[key][1]) for key in ("CONNECT", "AND") if len(parts.get(key, ())) > 1)
    if one_way and "ONE_WAY" in parts:
        return ends == (a, b)
    return ends in ((a, b), (b, a))


def _length(document: Draft, a: str, b: str) -> str:
    """How long the straight line is in the scenario's unit of distance, 0.1 at least."""
    where, _ = positions(document.scenario)
    (ax, ay), (bx, by) = ((where[name].x, where[name].y) for name in (a, b))
    length = ((ax - bx) ** 2 + (ay - by) ** 2) ** 0.5 * lengths_per_metre(document.scenario)
    rounded = read_number(metres(max(round(length, 1), 0.1)))
    return written_time(document.scenario.as_distance(rounded or 1))


def second_way(document: Draft, values: Values) -> Tuple[Draft, Optional[int]]:
    """{statement, agents: […], distance?}: another way between the places of a way, for these agents; that one is no
    longer for them. Without a distance it is as long."""
    number = fields.index_of(values, "statement", len(document.statements))
    way, agents = document.statements[number], fields.names_of(values, "agents")
    if way.kind != "CONNECT":
        raise refused("this is no way", "choose it again")
    if not agents:
        raise refused("the second way is for nobody", "choose the agents that take it")
    for agent in agents:
        if agent not in names(document, "agent"):
            raise not_there(document, "agent", agent)
    taken = names_behind(way, "FOR")
    left = [name for name in taken if name not in agents]
    if taken and not left:
        raise refused("the first way would be for nobody", "choose some of its agents only")
    distance = fields.length_of(values, "distance") if values.get("distance") else words_behind(way, "DISTANCE")
    ends = [words_behind(way, part) for part in ("CONNECT", "AND")]
    more = f"{' one_way' if way.first('ONE_WAY') is not None else ''} for {', '.join(agents)}"
    if taken:
        document = with_part(document, number, "FOR", ", ".join(left))
    else:
        others = [name for name in names_behind(way, "EXCEPT") if name not in agents]
        document = with_part(document, number, "EXCEPT", ", ".join([*others, *agents]))
    return added(document, f"connect {ends[0]} and {ends[1]} distance {distance}{more}")
