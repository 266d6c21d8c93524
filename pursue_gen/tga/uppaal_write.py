"""Writes networks (`TGA.xml`) and queries (`TCTL.q`) for UPPAAL: well-formed, valid against its flat DTD, repeatable.

Ids are unique over the file. A named location has the id `automaton.location`. A location without a name has its own
name as its id, so that UPPAAL prints `_<name>` in plans as for the original's networks; only where several automata
have a nameless location of one name, their ids are `automaton.location` too. The reader takes what follows the last
dot of an id as the name of a nameless location.
"""

from __future__ import annotations

from collections import Counter
from typing import Dict, Iterable, Iterator, List, Tuple
from xml.sax.saxutils import escape, quoteattr

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Kind, Location, Network, Objective

_HEADER = """<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE nta PUBLIC '-//Uppaal Team//DTD Flat System 1.6//EN' \
'http://www.it.uu.se/research/group/darts/uppaal/flat-1_6.dtd'>"""

_COLUMNS = 6
_WIDTH, _HEIGHT = 340, 204
"""The grid on which locations are drawn, in UPPAAL's units."""

_Point = Tuple[int, int]


def write_network(network: Network, objective: Objective) -> str:
    """The text of a network's file, with its objective as a query.

    Raises PursueError for a network whose clocks do not start at 0: UPPAAL's all do.
    """
    if network.start:
        message = "UPPAAL has no way to write a network whose clocks do not start at 0"
        raise PursueError([error("TGA030", message, hint="write the network of the scenario, from its beginning")])
    lines = [_HEADER, "<nta>", _tag("declaration", "\n".join(_declarations(network)), "\t")]
    ids = _ids(network)
    for automaton in network.automata:
        lines += _template(automaton, ids[automaton.name])
    system = f"system {', '.join(automaton.name for automaton in network.automata)};"
    lines.append(_tag("system", system, "\t"))
    query = [_tag("formula", _formula(objective), "\t\t\t"), "\t\t\t<comment/>"]
    lines += ["\t<queries>", "\t\t<query>", *query, "\t\t</query>", "\t</queries>", "</nta>"]
    return "\n".join(lines) + "\n"


def write_query(objective: Objective) -> str:
    """The text of a query's file."""
    return _formula(objective) + "\n"


def _formula(objective: Objective) -> str:
    goal, bad = (".".join(place) if place else "" for place in (objective.goal, objective.bad))
    if objective.kind is Kind.REACH:
        return f"control: A<> {goal}"
    if objective.kind is Kind.SAFETY:
        return f"control: A[] not({bad})"
    return f"control: A[ not({bad}) U {goal} ]"


def _declarations(network: Network) -> Iterator[str]:
    if network.channels:
        yield f"broadcast chan {', '.join(network.channels)};"
    if network.clocks:
        yield f"clock {', '.join(network.clocks)};"
    if network.variables:
        yield f"int {', '.join(f'{name} = {value}' for name, value in network.variables)};"


def _ids(network: Network) -> Dict[str, Dict[str, str]]:
    """The ids of locations, by automaton and location."""
    nameless = Counter(
        location.name for automaton in network.automata for location in automaton.locations if not location.named
    )

    def identifier(automaton: Automaton, location: Location) -> str:
        bare = not location.named and nameless[location.name] == 1
        return location.name if bare else f"{automaton.name}.{location.name}"

    return {
        automaton.name: {location.name: identifier(automaton, location) for location in automaton.locations}
        for automaton in network.automata
    }


def _template(automaton: Automaton, ids: Dict[str, str]) -> Iterator[str]:
    places = {location.name: _place(number) for number, location in enumerate(automaton.locations)}
    yield "\t<template>"
    yield _tag("name", automaton.name, "\t\t")
    for location in automaton.locations:
        yield from _location(location, ids[location.name], places[location.name])
    yield f"\t\t<init ref={quoteattr(ids[automaton.initial])}/>"
    for edge in automaton.edges:
        yield from _transition(edge, ids, places)
    yield "\t</template>"


def _place(number: int) -> _Point:
    return number % _COLUMNS * _WIDTH, number // _COLUMNS * _HEIGHT


def _location(location: Location, identifier: str, place: _Point) -> Iterator[str]:
    x, y = place
    yield f"\t\t<location id={quoteattr(identifier)}{_at(place)}>"
    if location.named:
        yield _tag("name", location.name, "\t\t\t", _at((x - 10, y - 34)))
    if location.invariant:
        yield _label("invariant", _bounds(location.invariant), (x - 10, y + 17))
    yield "\t\t</location>"


def _transition(edge: Edge, ids: Dict[str, str], places: Dict[str, _Point]) -> Iterator[str]:
    (x, y), (to_x, to_y) = places[edge.source], places[edge.target]
    middle_x, middle_y = (x + to_x) // 2, (y + to_y) // 2
    yield "\t\t<transition>" if edge.controllable else '\t\t<transition controllable="false">'
    yield f"\t\t\t<source ref={quoteattr(ids[edge.source])}/>"
    yield f"\t\t\t<target ref={quoteattr(ids[edge.target])}/>"
    for number, (kind, text) in enumerate(_labels(edge)):
        yield _label(kind, text, (middle_x + 18, middle_y - 51 + 17 * number))
    if edge.source == edge.target:
        # Without nails a loop has no length, and nobody would see it.
        yield from (f"\t\t\t<nail{_at((x + dx, y - 50))}/>" for dx in (-30, 30))
    yield "\t\t</transition>"


def _labels(edge: Edge) -> List[Tuple[str, str]]:
    """The labels that are not empty, in UPPAAL's order."""
    sync = f"{edge.sync.channel}{'!' if edge.sync.sends else '?'}" if edge.sync else ""
    updates = [f"{name} = {value}" for name, value in edge.assign] + [f"{clock} = 0" for clock in edge.resets]
    labels = [("guard", _guard(edge.guard)), ("synchronisation", sync), ("assignment", ", ".join(updates))]
    return [(kind, text) for kind, text in labels if text]


def _guard(guard: Guard) -> str:
    return " && ".join([_bounds([bound]) for bound in guard.clocks] + [_clause(clause) for clause in guard.integers])


def _clause(clause: Clause) -> str:
    tests = [f"{test.variable} == {test.value}" for test in clause]
    if not tests:
        return "false"
    return tests[0] if len(tests) == 1 else f"({' || '.join(tests)})"


def _bounds(bounds: Iterable[ClockBound]) -> str:
    return " && ".join(f"{bound.clock} {bound.op} {bound.bound}" for bound in bounds)


def _label(kind: str, text: str, place: _Point) -> str:
    return _tag("label", text, "\t\t\t", f' kind="{kind}"{_at(place)}')


def _at(place: _Point) -> str:
    return f' x="{place[0]}" y="{place[1]}"'


def _tag(name: str, text: str, indent: str, attributes: str = "") -> str:
    return f"{indent}<{name}{attributes}>{escape(text)}</{name}>"
