"""Writes networks (`TGA.xml`) and queries (`TCTL.q`) for UPPAAL: well-formed, valid against its flat DTD, repeatable.

Ids are unique over the file. A named location has the id `automaton.location`. A location without a name has its own
name as its id, so that UPPAAL prints `_<name>` in plans as for the original's networks; only where several automata
have a nameless location of one name, their ids are `automaton.location` too. The reader takes what follows the last
dot of an id as the name of a nameless location. Names that are words of UPPAAL's models get another name in its files,
and their own when plans are read: the names of a scenario need not avoid these words.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import fields, is_dataclass, replace
from typing import Any, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple, TypeVar
from xml.dom import minidom

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Network, Objective
from pursue_gen.tga.scale import common_denominator, scaled

_PUBLIC = "-//Uppaal Team//DTD Flat System 1.6//EN"
_SYSTEM = "http://www.it.uu.se/research/group/darts/uppaal/flat-1_6.dtd"

MULTIPLIED = "// All times are multiplied by {}: UPPAAL knows whole numbers only."
"""The first line of the declarations of a network with decimals. Readers divide by that factor."""

_COLUMNS = 6
_WIDTH, _HEIGHT = 340, 204
"""The grid on which locations are drawn, in UPPAAL's units."""

_Point = Tuple[int, int]


def write_network(network: Network, objective: Objective) -> str:
    """The text of a network's file, with its objective as a query. Names that are words of UPPAAL are other ones there.

    Decimals are multiplied by one factor, with all other times; a comment says it. Raises PursueError for a network
    whose clocks do not start at 0: UPPAAL's all do.
    """
    if network.start:
        message = "UPPAAL has no way to write a network whose clocks do not start at 0"
        raise Invalid([error("TGA030", message, hint="write the network of the scenario, from its beginning")])
    factor = common_denominator(network.times)
    network = renamed(scaled(network, factor) if factor > 1 else network, uppaal_names(network))
    implementation = minidom.getDOMImplementation()
    assert implementation is not None, "minidom is its own"
    document = implementation.createDocument(None, "nta", implementation.createDocumentType("nta", _PUBLIC, _SYSTEM))
    nta = document.documentElement
    assert nta is not None, "it has just been created"
    _add(nta, "declaration", "\n".join([*([MULTIPLIED.format(factor)] if factor > 1 else []), *_declarations(network)]))
    ids = _ids(network)
    for automaton in network.automata:
        _template(nta, automaton, ids[automaton.name])
    _add(nta, "system", f"system {', '.join(automaton.name for automaton in network.automata)};")
    query = _add(_add(nta, "queries"), "query")
    _add(query, "formula", _formula(objective))
    _add(query, "comment")
    return document.toprettyxml(indent="\t", encoding="utf-8").decode()


def write_query(objective: Objective) -> str:
    """The text of a query's file."""
    return _formula(objective) + "\n"


def _formula(objective: Objective) -> str:
    goal = " and ".join(map(".".join, objective.goal))
    goal = f"({goal})" if len(objective.goal) > 1 else goal
    bad = " or ".join(map(".".join, objective.bad))
    if not objective.avoids:
        return f"control: A<> {goal}"
    if not objective.reaches:
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


def _template(nta: minidom.Element, automaton: Automaton, ids: Dict[str, str]) -> None:
    places = {location.name: _place(number) for number, location in enumerate(automaton.locations)}
    template = _add(nta, "template")
    _add(template, "name", automaton.name)
    for location in automaton.locations:
        _location(template, location, ids[location.name], places[location.name])
    _add(template, "init", ref=ids[automaton.initial])
    for edge in automaton.edges:
        _transition(template, edge, ids, places)


def _place(number: int) -> _Point:
    return number % _COLUMNS * _WIDTH, number // _COLUMNS * _HEIGHT


def _location(template: minidom.Element, location: Location, identifier: str, place: _Point) -> None:
    x, y = place
    element = _add(template, "location", "", place, id=identifier)
    if location.named:
        _add(element, "name", location.name, (x - 10, y - 34))
    if location.invariant:
        _add(element, "label", _bounds(location.invariant), (x - 10, y + 17), kind="invariant")


def _transition(template: minidom.Element, edge: Edge, ids: Dict[str, str], places: Dict[str, _Point]) -> None:
    (x, y), (to_x, to_y) = places[edge.source], places[edge.target]
    middle_x, middle_y = (x + to_x) // 2, (y + to_y) // 2
    transition = _add(template, "transition")
    if not edge.controllable:
        transition.setAttribute("controllable", "false")
    _add(transition, "source", ref=ids[edge.source])
    _add(transition, "target", ref=ids[edge.target])
    for number, (kind, text) in enumerate(_labels(edge)):
        _add(transition, "label", text, (middle_x + 18, middle_y - 51 + 17 * number), kind=kind)
    if edge.source == edge.target:
        # Without nails a loop has no length, and could not be seen.
        for dx in (-30, 30):
            _add(transition, "nail", "", (x + dx, y - 50))


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


def _add(
    parent: minidom.Element, name: str, text: str = "", place: Optional[_Point] = None, **attributes: str
) -> minidom.Element:
    """A new element at the end of the parent, with this text and at this place of the drawing."""
    document = parent.ownerDocument
    assert document is not None, "it was made by its document"
    element = document.createElement(name)
    drawn = {} if place is None else {"x": str(place[0]), "y": str(place[1])}
    for attribute, value in {**attributes, **drawn}.items():
        element.setAttribute(attribute, value)
    if text:
        element.appendChild(document.createTextNode(text))
    parent.appendChild(element)
    return element


T = TypeVar("T")

WORDS = frozenset(
    "chan clock bool int commit const urgent broadcast init process state guard sync assign system trans deadlock "
    "imply forall exists typedef struct rate before_update after_update meta priority progress scalar select void "
    "default switch case enum string double hybrid dynamic spawn exit branchpoint".split()
)
"""Words of UPPAAL's models that the language lets people use as names."""


def uppaal_names(network: Network) -> Dict[str, str]:
    """For each name of the network that is a word of UPPAAL the name that it gets there; no other name is like it."""
    used = {*network.names, *(location.name for automaton in network.automata for location in automaton.locations)}
    names: Dict[str, str] = {}
    for word in sorted(used & WORDS):
        new = word + "_"
        while new in used:
            new += "_"
        names[word] = new
        used.add(new)
    return names


def renamed(thing: T, names: Mapping[str, str]) -> T:
    """The network, or a part of it, in which these names are other ones; itself where there are none."""
    if not names:
        return thing
    some: Any = thing
    if isinstance(thing, str):
        some = names.get(thing, thing)
    elif isinstance(thing, tuple):
        some = tuple(renamed(part, names) for part in thing)
    elif is_dataclass(thing):
        some = replace(some, **{each.name: renamed(getattr(some, each.name), names) for each in fields(thing)})
    return some  # type: ignore[no-any-return]


def with_own_names(text: str, network: Network) -> str:
    """A plan for the network in which its own names stand in place of those that it has in UPPAAL's files."""
    for word, new in uppaal_names(network).items():
        text = re.sub(rf"\b{new}\b", word, text)
    return text
