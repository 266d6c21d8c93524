"""Reads networks (`TGA.xml`) and queries (`TCTL.q`) of UPPAAL, ours and the original translator's.

What a network of this tool cannot hold (templates with parameters, channels that are not broadcast, committed
locations, clock guards on receiving edges, …) is an error that says so, with its place. Codes: TGA001 the text is not
a network, TGA002 unsupported, TGA003 an unknown or doubled name, TGA004 a label or declaration that cannot be read,
TGA005 a query.
"""

from __future__ import annotations

import re
from collections import Counter
from fractions import Fraction
from typing import Callable, Dict, List, Pattern, Tuple, TypeVar

from pursue_gen.diagnostics import Span, error
from pursue_gen.outcomes import Invalid
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Guard, Kind, Location, Network, Objective
from pursue_gen.tga.scale import scaled
from pursue_gen.tga.uppaal_labels import (
    Names,
    Update,
    integer,
    parse_guard,
    parse_invariant,
    parse_sync,
    parse_update,
    tokens,
)
from pursue_gen.tga.uppaal_markup import Element, read_markup, shortened
from pursue_gen.tga.uppaal_write import MULTIPLIED

T = TypeVar("T")
Raw = TypeVar("Raw")

_COMMENTS = re.compile(r"//[^\n]*|/\*.*?(?:\*/|(?P<unclosed>\Z))", re.DOTALL)
_MULTIPLIED = re.compile(re.escape(MULTIPLIED).replace(r"\{\}", r"([1-9][0-9]{0,17})"))
_PLACE = r"(\w+)\s*\.\s*(\w+)"


def _queries() -> Dict[Kind, Pattern[str]]:
    """What the queries of each kind of objective look like: one location, or several with `and` (to reach) or `or`."""
    place = r"\w+\s*\.\s*\w+"
    joined = rf"{place}(?:(?:\s+%s\s+|\s*%s\s*){place})*"
    all_of, any_of = joined % ("and", "&&"), joined % ("or", r"\|\|")
    goal = rf"(?P<goal>{all_of}|\(\s*{all_of}\s*\))"
    bad = rf"(?P<bad>(?:not|!)\s*\(\s*{any_of}\s*\)|(?:not\s|!)\s*{place})"
    control = r"\s*control\s*:\s*A\s*"
    return {
        Kind.REACH: re.compile(rf"{control}<\s*>\s*{goal}\s*"),
        Kind.SAFETY: re.compile(rf"{control}\[\s*\]\s*{bad}\s*"),
        Kind.REACH_WHILE_SAFE: re.compile(rf"{control}\[\s*{bad}\s*U\s*{goal}\s*\]\s*"),
    }


_QUERIES = _queries()
_KINDS_IGNORED = ("comments", "testcodeEnter", "testcodeExit", "testcode")


def read_network(text: str, file: str) -> Network:
    """The network of a file, its automata in the order of its system line.

    Text beside elements is ignored, and ids need to be unique in their template only. A `states` automaton without
    edges (an older translator wrote one where a scenario has no states) is treated as absent. Times that our writer has
    multiplied are divided again. Raises PursueError with the place.
    """
    nta = read_markup(text, file)
    if nta.name != "nta":
        nta.fail("TGA001", f"<{nta.name}> stands where <nta> was expected")
    clocks, variables, channels = _declarations(nta)
    names = Names(frozenset(clocks), frozenset(v for v, _ in variables), frozenset(channels))
    templates: Dict[str, Automaton] = {}
    for template in nta.all("template"):
        automaton = _automaton(template, names)
        if automaton.name in templates:
            template.fail("TGA003", f"there are two templates {automaton.name}")
        templates[automaton.name] = automaton
    order = _system(nta, templates)
    automata = tuple(templates[name] for name in order if name != "states" or templates[name].edges)
    network, factor = Network(tuple(clocks), tuple(variables), tuple(channels), automata), _factor(nta)
    return scaled(network, Fraction(1, factor)) if factor > 1 else network


def _factor(nta: Element) -> int:
    """By what the times in the file are multiplied: our writer says it in a comment where that is not 1."""
    declaration = nta.one("declaration")
    said = _MULTIPLIED.search("" if declaration is None else declaration.text)
    return 1 if said is None else int(said.group(1))


def read_query(text: str, file: str) -> Objective:
    """The objective of a query file: `A<> x.win`, `A[] not(x.lose)` or `A[ not(x.lose) U y.win ]` after `control:`.

    Several locations to reach are joined by `and`, several to avoid by `or`: `not(x.lose or z.lose)`. Raises
    PursueError where the file has another query, none, or several.
    """
    for kind, query in _QUERIES.items():
        found = query.fullmatch(_uncommented(text, ""))
        if found:
            parts = {name: _places(part) for name, part in found.groupdict().items()}
            return Objective(kind, parts.get("goal", ()), parts.get("bad", ()))
    hint = "control: A<> x.win, control: A[] not(x.lose) or control: A[ not(x.lose) U y.win ], and only one of them"
    lines = text.rstrip().split("\n")
    span = Span(file, 1, 1, len(lines), len(lines[-1]) + 1)
    shown = lines[0].strip() if lines[0].strip() else "an empty file"
    raise Invalid([error("TGA005", shortened(f"'{shown}' is not a query that this tool can play"), span, hint)])


def _uncommented(text: str, instead: str = " ") -> str:
    """The text with `instead` for each comment; one that is never closed stays, and is no declaration."""
    return _COMMENTS.sub(lambda match: instead if match.group("unclosed") is None else match.group(), text)


def _places(text: str) -> Tuple[Tuple[str, str], ...]:
    """The locations in a part of a query, each once."""
    return tuple(dict.fromkeys((found.group(1), found.group(2)) for found in re.finditer(_PLACE, text)))


def _declarations(nta: Element) -> Tuple[List[str], List[Tuple[str, int]], List[str]]:
    declaration = nta.one("declaration")
    clocks: List[str] = []
    variables: List[Tuple[str, int]] = []
    channels: List[str] = []
    if declaration is None:
        return clocks, variables, channels
    for statement in _uncommented(declaration.text).split(";"):
        words = _labelled(declaration, statement, tokens)
        if not words:
            continue
        if words[:2] == ["broadcast", "chan"]:
            channels += _names(declaration, words[2:])
        elif words[0] == "clock":
            clocks += _names(declaration, words[1:])
        elif words[0] == "int":
            variables += _integers(declaration, words[1:])
        else:
            message = f"the declaration '{shortened(' '.join(statement.split()), 80)}' is not supported"
            declaration.fail("TGA002", message, "clock, int and broadcast chan are")
    seen = set()
    for name in clocks + [v for v, _ in variables] + channels:
        if name in seen:
            declaration.fail("TGA003", f"{name} is declared twice")
        seen.add(name)
    return clocks, variables, channels


def _names(declaration: Element, words: List[str]) -> List[str]:
    names, commas = words[::2], words[1::2]
    if len(words) % 2 == 0 or any(comma != "," for comma in commas) or not all(n.isidentifier() for n in names):
        declaration.fail("TGA004", f"'{' '.join(words)}' stands where names with commas between them were expected")
    return names


def _integers(declaration: Element, words: List[str]) -> List[Tuple[str, int]]:
    result = []
    for part in " ".join(words).split(","):
        name, *value = part.split()
        if not name.isidentifier() or (value and value[0] != "="):
            message = f"the declaration 'int{shortened(part, 80)}' is not supported"
            declaration.fail("TGA002", message, "plain int variables are")
        result.append((name, _labelled(declaration, value[1:], integer) if value else 0))
    return result


def _automaton(template: Element, names: Names) -> Automaton:
    title = template.one("name")
    name = title.text.strip() if title else ""
    if not name:
        template.fail("TGA001", "a template has no name")
    parameter, local = template.one("parameter"), template.one("declaration")
    if parameter and parameter.text.strip():
        parameter.fail("TGA002", f"template {name} has parameters", "write one template for each automaton")
    if local and _uncommented(local.text).strip():
        local.fail("TGA002", f"template {name} has declarations of its own", "move them to the global declaration")
    locations: Dict[str, Location] = {}
    for element in template.all("location"):
        identifier = element.attribute("id")
        if identifier in locations:
            element.fail("TGA003", f"template {name} has two locations with the id {identifier}")
        locations[identifier] = _location(element, identifier, names)
    if len({location.name for location in locations.values()}) < len(locations):
        template.fail("TGA003", f"template {name} has two locations of one name")
    for kind in ("branchpoint", "lsc", "instance"):
        other = template.one(kind)
        if other:
            other.fail("TGA002", f"<{kind}> is not supported")
    init = template.one("init")
    if init is None:
        template.fail("TGA001", f"template {name} has no initial location")
    edges = tuple(_edge(element, locations, names) for element in template.all("transition"))
    return Automaton(name, tuple(locations.values()), _target(init, locations), edges)


def _location(element: Element, identifier: str, names: Names) -> Location:
    for kind in ("committed", "urgent"):
        if element.one(kind):
            element.fail("TGA002", f"location {identifier} is {kind}", "only plain locations are supported")
    labels = _labels(element, ("invariant",))
    nothing: Tuple[ClockBound, ...] = ()
    invariant = _label(labels, "invariant", nothing, lambda text: parse_invariant(text, names))
    title = element.one("name")
    name = title.text.strip() if title else ""
    # Ids that our writer makes unique over the file hold the location's name after their last dot.
    return Location(name or identifier.rpartition(".")[2], invariant, bool(name))


def _edge(element: Element, locations: Dict[str, Location], names: Names) -> Edge:
    source, target = element.one("source"), element.one("target")
    if source is None or target is None:
        element.fail("TGA001", "a transition lacks its source or its target")
    labels = _labels(element, ("guard", "synchronisation", "assignment"))
    guard = _label(labels, "guard", Guard(), lambda text: parse_guard(text, names))
    sync = _label(labels, "synchronisation", None, lambda text: parse_sync(text, names))
    nothing: Update = ((), ())
    assign, resets = _label(labels, "assignment", nothing, lambda text: parse_update(text, names))
    if sync and not sync.sends and guard.clocks:
        message = f"an edge that receives {sync.channel} has the clock guard '{labels['guard'].text.strip()}'"
        labels["guard"].fail("TGA002", message, "UPPAAL forbids it for broadcast channels: put it on the sending edge")
    controllable = element.attributes.get("controllable", "true")
    if controllable not in ("true", "false"):
        element.fail("TGA004", f"controllable is '{controllable}', true or false was expected")
    return Edge(
        _target(source, locations), _target(target, locations), guard, sync, assign, resets, controllable == "true"
    )


def _target(element: Element, locations: Dict[str, Location]) -> str:
    reference = element.attribute("ref")
    if reference not in locations:
        element.fail("TGA003", f"there is no location with the id {reference} in this template")
    return locations[reference].name


def _labels(element: Element, kinds: Tuple[str, ...]) -> Dict[str, Element]:
    """The labels by kind. Raises PursueError for a kind that is not supported, and for two of a kind."""
    result: Dict[str, Element] = {}
    for label in element.all("label"):
        kind = label.attribute("kind")
        if kind in _KINDS_IGNORED:
            continue
        if kind not in kinds and label.text.strip():
            label.fail("TGA002", f"a label of kind {kind} is not supported here")
        if kind in result:
            label.fail("TGA001", f"there are two labels of kind {kind}")
        result[kind] = label
    return result


def _label(labels: Dict[str, Element], kind: str, absent: T, parse: Callable[[str], T]) -> T:
    return _labelled(labels[kind], labels[kind].text, parse) if kind in labels else absent


def _labelled(element: Element, text: Raw, parse: Callable[[Raw], T]) -> T:
    """What `parse` makes of the text of an element, its complaints with a place."""
    try:
        return parse(text)
    except ValueError as complaint:
        element.fail("TGA004", str(complaint))


def _system(nta: Element, templates: Dict[str, Automaton]) -> List[str]:
    system = nta.one("system")
    if system is None:
        nta.fail("TGA001", "there is no <system>")
    match = re.fullmatch(r"\s*system\b([\w\s,]*);\s*", _uncommented(system.text))
    if match is None:
        system.fail(
            "TGA002", "the system is not one line 'system a, b, c;' of templates", "instantiations are not supported"
        )
    order = match.group(1).replace(",", " ").split()
    times = Counter(order)
    for name in order:
        if name not in templates:
            system.fail("TGA003", f"the system names {name}, but there is no template of that name")
        if times[name] > 1:
            system.fail("TGA003", f"the system names {name} twice")
    return order
