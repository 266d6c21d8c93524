"""Each automaton of the game: a picture by graphviz, and the same as a table."""

from __future__ import annotations

from typing import List, Optional, Tuple

from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import unit_name
from pursue_gen.synthesis.plan_text import assign_text, guard_text, sync_text
from pursue_gen.tga.network import Automaton, Edge, Location, Network
from pursue_gen.tga.positions import positions
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.graphviz import Graph, arrow, node
from pursue_gen.tools.report.html import Section, rendered

MOST_EDGES = 150
"""An automaton with more edges is no picture that anybody can read."""

def graph(automaton: Automaton) -> Optional[Graph]:
    """The picture of an automaton; None where it would be too large to be read."""
    if len(automaton.edges) > MOST_EDGES:
        return None
    ident = f"automaton-{automaton.name}"
    numbers = {location.name: k for k, location in enumerate(automaton.locations)}
    lines = [_location(f"{ident}-l{k}", location, automaton) for k, location in enumerate(automaton.locations)]
    for k, edge in enumerate(automaton.edges):
        source, target = (f"{ident}-l{numbers[name]}" for name in (edge.source, edge.target))
        style = "solid" if edge.controllable else "dashed"
        lines.append(arrow(source, target, f"{ident}-e{k}", "\n".join(_parts(edge)), style=style))
    description = f"{len(automaton.locations)} locations, {len(automaton.edges)} edges; dashed edges are not ours"
    return Graph(ident, f"Automaton {automaton.name}", description, lines)


def section(network: Network, scenario: Scenario) -> Section:
    """All automata, in system order."""
    drawn = [(automaton, graph(automaton)) for automaton in network.automata]
    values = {
        "numbers": _numbers(scenario),
        "how_to_get": "" if graphviz.installed() else graphviz.HOW_TO_GET,
        "automata": [(automaton, picture and graphviz.draw(picture)) for automaton, picture in drawn],
        "most_edges": MOST_EDGES,
        "locations": _location_rows,
        "edges": lambda automaton: [_edge_row(edge) for edge in automaton.edges],
    }
    return Section("automata", "The timed automata", rendered("automata", **values))


def _numbers(scenario: Scenario) -> str:
    """What the numbers mean that stand for places."""
    codes = positions(scenario.pois, scenario.connections)
    some = scenario.pois[:30]
    names = ", ".join(f"{codes.at(poi.name)} {poi.name}" for poi in some) + (
        " …" if len(some) < len(scenario.pois) else ""
    )
    result = f"P and an agent's name: where it is. {names}."
    if scenario.connections:
        a, b = scenario.connections[0].a, scenario.connections[0].b
        result += f" On the way it is a negative number: {codes.going(a, b)} is from {a} to {b}."
    return f"{result} C and a name: a clock, in {unit_name(scenario.unit)}."


def _location_rows(automaton: Automaton) -> List[Tuple[str, str, str]]:
    begins = automaton.initial
    return [(o.name, _invariant(o), "starts here" if o.name == begins else "") for o in automaton.locations]


def _location(ident: str, location: Location, automaton: Automaton) -> str:
    invariant = _invariant(location)
    label = f"{location.name}\n{invariant}" if invariant else location.name
    return node(ident, label, peripheries=2 if location.name == automaton.initial else 1)


def _invariant(location: Location) -> str:
    return " && ".join(f"{bound.clock} {bound.op} {bound.bound}" for bound in location.invariant)


def _parts(edge: Edge) -> List[str]:
    """The lines of an edge's label, without those that say nothing."""
    sync = "" if edge.sync is None else sync_text(edge)
    return [part for part in (_none(guard_text(edge.guard)), sync, _none(assign_text(edge))) if part]


def _edge_row(edge: Edge) -> Tuple[str, ...]:
    owner = "our side" if edge.controllable else "not ours"
    return edge.source, edge.target, sync_text(edge), _none(guard_text(edge.guard)), _none(assign_text(edge)), owner


def _none(text: str) -> str:
    return "" if text == "1" else text
