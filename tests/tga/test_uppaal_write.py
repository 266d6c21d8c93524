"""UPPAAL's files: what is written is well-formed, follows the flat DTD, and reads back equal."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path
from typing import List

import pytest
from hypothesis import given

from pursue_gen.language import load
from pursue_gen.solving.periods import with_period
from pursue_gen.tga import ends_reported, translate
from pursue_gen.tga.network import Automaton, Edge, Guard, Kind, Location, Network, Objective, Sync, Test
from pursue_gen.tga.uppaal import read_network, read_query, write_network, write_query
from tests.conftest import ROOT
from tests.tga.networks import BOTH, REACH, REFERENCES, SAFETY, networks

CONTENT = {
    "nta": "(imports )?(declaration )?(template )+(instantiation )?system (queries )?",
    "declaration": "",
    "template": "name (parameter )?(declaration )?(location )*(branchpoint )*(init )?(transition )*",
    "name": "",
    "location": "(name )?(label )*(urgent )?(committed )?",
    "init": "",
    "transition": "source target (label )*(nail )*",
    "source": "",
    "target": "",
    "label": "",
    "nail": "",
    "system": "",
    "queries": "(query )*",
    "query": "formula comment ",
    "formula": "",
    "comment": "",
}
"""The content of each element in UPPAAL's flat DTD: the names of its children, as a regular expression."""

ATTRIBUTES = {
    "name": {"x", "y"},
    "location": {"id", "x", "y"},
    "init": {"ref"},
    "transition": {"controllable"},
    "source": {"ref"},
    "target": {"ref"},
    "label": {"kind", "x", "y"},
    "nail": {"x", "y"},
}
KINDS = {"location": {"invariant"}, "transition": {"guard", "synchronisation", "assignment"}}
TEXTUAL = {"declaration", "name", "label", "system", "formula", "comment"}


def assert_follows_the_dtd(text: str) -> None:
    root = ET.fromstring(text.encode("utf-8"))
    assert root.tag == "nta"
    ids: List[str] = []
    references: List[str] = []
    for element in root.iter():
        children = "".join(f"{child.tag} " for child in element)
        assert re.fullmatch(CONTENT[element.tag], children), f"<{element.tag}> holds {children}"
        assert set(element.attrib) <= ATTRIBUTES.get(element.tag, set())
        assert element.tag in TEXTUAL or not (element.text or "").strip()
        assert not (element.tail or "").strip()
        ids += [element.attrib["id"]] if "id" in element.attrib else []
        references += [element.attrib["ref"]] if "ref" in element.attrib else []
        for label in element.findall("label"):
            assert label.attrib["kind"] in KINDS[element.tag]
            assert (label.text or "").strip()
        kinds = [label.attrib["kind"] for label in element.findall("label")]
        assert len(set(kinds)) == len(kinds)
        assert element.attrib.get("controllable", "true") in ("true", "false")
    assert len(set(ids)) == len(ids)
    assert set(references) <= set(ids)
    assert all(re.fullmatch(r"[A-Za-z_][\w.]*", identifier) for identifier in ids)


@given(networks())
def test_what_is_written_follows_the_dtd_and_reads_back_equal(network: Network) -> None:
    text = write_network(network, SAFETY)
    assert_follows_the_dtd(text)
    assert read_network(text, "TGA.xml") == network
    assert write_network(network, SAFETY) == text


@pytest.mark.parametrize("name", REFERENCES)
def test_references_read_back_equal(reference_dir: Path, name: str) -> None:
    folder = reference_dir / name
    network = read_network((folder / "TGA.xml").read_text(encoding="utf-8"), "TGA.xml")
    objective = read_query((folder / "TCTL.q").read_text(encoding="utf-8"), "TCTL.q")
    text = write_network(network, objective)
    assert_follows_the_dtd(text)
    assert read_network(text, "TGA.xml") == network
    assert read_query(write_query(objective), "TCTL.q") == objective


@pytest.mark.parametrize("path", sorted((ROOT / "scenarios").rglob("*.pur")), ids=lambda path: path.stem)
def test_our_scenarios_read_back_equal(path: Path) -> None:
    network = ends_reported(translate(with_period(load(path), 30)), {})
    text = write_network(network, REACH)
    assert_follows_the_dtd(text)
    assert read_network(text, "TGA.xml") == network


SEVERAL = Objective(
    Kind.REACH_WHILE_SAFE, goal=(("reachObj", "win"), ("reachObj2", "win")), bad=(("obj", "lose"), ("obj2", "lose"))
)


def test_several_locations_stand_in_one_query() -> None:
    query = "control: A[ not(obj.lose or obj2.lose) U (reachObj.win and reachObj2.win) ]\n"
    assert write_query(SEVERAL) == query
    assert write_query(replace(SEVERAL, kind=Kind.REACH)) == "control: A<> (reachObj.win and reachObj2.win)\n"
    assert write_query(replace(SEVERAL, kind=Kind.SAFETY)) == "control: A[] not(obj.lose or obj2.lose)\n"


@pytest.mark.parametrize(
    "objective",
    [
        REACH,
        SAFETY,
        BOTH,
        Objective(Kind.SAFETY, bad=(("o", "x"),)),
        SEVERAL,
        replace(SEVERAL, kind=Kind.REACH, bad=()),
        replace(SEVERAL, kind=Kind.SAFETY, goal=()),
        replace(SEVERAL, goal=(("reachObj", "win"),), bad=(("reachObj", "late"), ("orU", "and_"), ("obj", "lose"))),
    ],
)
def test_queries_read_back_equal(objective: Objective) -> None:
    assert read_query(write_query(objective), "TCTL.q") == objective


def test_the_query_stands_in_the_network_too() -> None:
    formula = ET.fromstring(write_network(one_automaton(Edge("a", "a")), BOTH)).findtext("queries/query/formula")
    assert formula == "control: A[ not(obj.lose) U reachObj.win ]"


def one_automaton(*edges: Edge) -> Network:
    automaton = Automaton("m", (Location("a"), Location("b", named=False)), "a", edges)
    return Network(("x",), (("p", 0),), ("c",), (automaton,))


def test_nameless_locations_keep_their_name_as_id() -> None:
    root = ET.fromstring(write_network(one_automaton(), REACH))
    nameless = [location for location in root.iter("location") if location.find("name") is None]
    assert [location.attrib["id"] for location in nameless] == ["b"]


def test_signs_of_xml_are_escaped() -> None:
    guard = Guard(integers=((Test("p", 1), Test("p", -2)), (Test("p", 3),)))
    text = write_network(one_automaton(Edge("a", "b", guard, Sync("c", True), (("p", -7),), ("x",), False)), REACH)
    (transition,) = ET.fromstring(text).iter("transition")
    assert {label.attrib["kind"]: label.text for label in transition.iter("label")} == {
        "guard": "(p == 1 || p == -2) && p == 3",
        "synchronisation": "c!",
        "assignment": "p = -7, x = 0",
    }
    assert transition.attrib == {"controllable": "false"}
    assert "&&" not in text


def test_the_file_is_for_people_too() -> None:
    lines = write_network(one_automaton(Edge("a", "b")), REACH).splitlines()
    assert lines[:5] == [
        '<?xml version="1.0" encoding="utf-8"?>',
        "<!DOCTYPE nta",
        "  PUBLIC '-//Uppaal Team//DTD Flat System 1.6//EN'",
        "  'http://www.it.uu.se/research/group/darts/uppaal/flat-1_6.dtd'>",
        "<nta>",
    ]
    assert '\t\t<location id="m.a" x="0" y="0">' in lines
    assert '\t\t\t<source ref="m.a"/>' in lines
