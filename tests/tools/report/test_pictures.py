"""Graphs by graphviz: well-formed, every part there, no names of programs or machines, the same each time; PNGs."""

from __future__ import annotations

import struct
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path
from typing import List, Tuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.drawing import look
from pursue_gen.language import load
from pursue_gen.tga import translate
from pursue_gen.tga.network import Automaton, Edge, Location
from pursue_gen.tools.report import automata, graphviz
from pursue_gen.tools.report import png as png_module
from pursue_gen.tools.report.png import png

SVG = "{http://www.w3.org/2000/svg}"
NETWORK = translate(load(Path(__file__).resolve().parents[3] / "scenarios" / "catch_the_thief" / "one_officer.pur"))
needs_dot = pytest.mark.skipif(not graphviz.installed(), reason="graphviz is not installed: apt install graphviz")
needs_png = pytest.mark.skipif(not png_module.available(), reason="nothing makes PNGs: apt install librsvg2-bin")


def drawn(automaton: Automaton) -> ElementTree.Element:
    graph = automata.graph(automaton)
    assert graph is not None
    return ElementTree.fromstring(graphviz.draw(graph) or "")


@needs_dot
@pytest.mark.parametrize("name", [automaton.name for automaton in NETWORK.automata])
def test_every_location_and_edge_is_drawn_and_dashed_where_it_is_not_ours(name: str) -> None:
    automaton = NETWORK.automaton(name)
    picture = drawn(automaton)
    words = [element.text for element in picture.iter(f"{SVG}text")]
    assert {location.name for location in automaton.locations} <= set(words)
    edges = [group for group in picture.iter(f"{SVG}g") if group.get("class") == "edge"]
    dashed = {g.attrib["id"] for g in edges if any(path.get("stroke-dasharray") for path in g.iter(f"{SVG}path"))}
    assert len(edges) == len(automaton.edges)
    assert dashed == {f"automaton-{name}-e{k}" for k, edge in enumerate(automaton.edges) if not edge.controllable}


@needs_dot
@given(st.lists(st.text(min_size=1, max_size=12), min_size=1, max_size=4, unique=True))
@settings(deadline=None, max_examples=15)
def test_hostile_names_stay_names(names: List[str]) -> None:
    shown = [f'{name}"];<b>&' for name in names]
    locations = tuple(Location(name) for name in shown)
    picture = drawn(Automaton("odd", locations, shown[0], (Edge(shown[0], shown[-1]),)))
    assert len([g for g in picture.iter(f"{SVG}g") if g.get("class") == "node"]) == len(names)
    assert not list(picture.iter(f"{SVG}b"))


@needs_dot
def test_pictures_are_the_same_each_time_and_name_no_program() -> None:
    graph = automata.graph(NETWORK.automata[0])
    assert graph is not None
    text = graphviz.draw(graph) or ""
    assert text == graphviz.draw(graph)
    assert "graphviz" not in text.lower() and "<!--" not in text and text.startswith("<svg ")
    ids = [element.attrib["id"] for element in ElementTree.fromstring(text).iter() if "id" in element.attrib]
    assert len(ids) == len(set(ids)) and all(ident.startswith("automaton-police") for ident in ids)


def test_an_automaton_that_nobody_could_read_is_no_picture() -> None:
    many = tuple(Edge("a", "a") for _ in range(automata.MOST_EDGES + 1))
    assert automata.graph(Automaton("big", (Location("a"),), "a", many)) is None


def test_without_graphviz_the_section_has_tables_and_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nonexistent")
    scenario = load(Path(__file__).resolve().parents[3] / "scenarios" / "catch_the_thief" / "one_officer.pur")
    body = automata.section(NETWORK, scenario).body_html
    assert "<svg" not in body and "apt install graphviz" in body and "going_a_to_b" in body


def pixels(content: bytes) -> Tuple[int, int, bytes]:
    """Width, height and the raw data of a PNG."""
    assert content.startswith(b"\x89PNG\r\n\x1a\n")
    width, height = struct.unpack(">II", content[16:24])
    data, place = b"", 8
    while place < len(content):
        (length,) = struct.unpack(">I", content[place : place + 4])
        if content[place + 4 : place + 8] == b"IDAT":
            data += content[place + 8 : place + 8 + length]
        place += length + 12
    return width, height, zlib.decompress(data)


@needs_png
def test_a_png_has_the_size_of_its_picture_and_something_on_it() -> None:
    full = look.svg(60, 40, "t", "d", [look.mark(look.agent_looks(["a"])["a"], 30, 20, 10)])
    empty = look.svg(60, 40, "t", "d", [])
    width, height, data = pixels(png(full, 3.0))
    assert (width, height) == (180, 120)
    assert len(set(data)) > 5 and data != pixels(png(empty, 3.0))[2]
