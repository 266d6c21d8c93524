"""Each automaton of the game: a picture by graphviz, and the same as a table."""

from __future__ import annotations

from typing import List, Optional, Tuple

from pursue_gen.drawing.look import safe
from pursue_gen.language.scenario import Scenario
from pursue_gen.synthesis.plan_text import assign_text, guard_text, sync_text
from pursue_gen.tga.network import Automaton, Edge, Location, Network
from pursue_gen.tga.positions import positions
from pursue_gen.tools.report import graphviz
from pursue_gen.tools.report.graphviz import Graph, arrow, node
from pursue_gen.tools.report.html import Section, figure, table

MOST_EDGES = 150
"""An automaton with more edges is no picture that anybody can read."""

_LINES = (
    "A double frame is where it starts. Under a location stands how long it may be there (its invariant). At an edge "
    "stand when it may be taken (the guard), the event, and what it sets. Full lines: our side decides; dashed lines: "
    "nobody of ours does, the robot or somebody else reports it (as UPPAAL draws it)."
)


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
    parts = [f"<p>{safe(_LINES)}</p>", f"<p class='quiet'>{safe(_numbers(scenario))}</p>"]
    if not graphviz.installed():
        parts.append(f"<p>There are no pictures here, only tables: {safe(graphviz.HOW_TO_GET)}.</p>")
    for k, automaton in enumerate(network.automata):
        opened = " open" if k == 0 else ""
        count = f"{len(automaton.locations)} locations, {len(automaton.edges)} edges"
        parts.append(f"<details{opened}><summary><strong>{safe(automaton.name)}</strong>: {count}</summary>")
        parts += [*_picture(automaton), _tables(automaton), "</details>"]
    return Section("automata", "The timed automata", "\n".join(parts))


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
    return f"{result} C and a name: a clock, in time units."


def _picture(automaton: Automaton) -> List[str]:
    drawn = graph(automaton)
    if drawn is None:
        return [f"<p>More than {MOST_EDGES} edges: too many for a picture.</p>"]
    picture = graphviz.draw(drawn)
    if picture is None:
        return ["<p>Graphviz could not draw this one in time.</p>"] if graphviz.installed() else []
    return [figure(picture, f"Automaton {automaton.name}")]


def _tables(automaton: Automaton) -> str:
    begins = automaton.initial
    locations = [(o.name, _invariant(o), "starts here" if o.name == begins else "") for o in automaton.locations]
    edges = [_edge_row(edge) for edge in automaton.edges]
    heads = ("from", "to", "event", "may be taken when", "sets", "who decides")
    first = table(("location", "invariant", ""), locations, f"Locations of {automaton.name}")
    return f"<details><summary>As a table</summary>{first}{table(heads, edges, f'Edges of {automaton.name}')}</details>"


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
