"""What the page shows of a text: everything that it can be read as, with the findings of `pursue-gen check`."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import as_json
from pursue_gen.solving.inputs import findings_in
from pursue_gen.tools.draw.view import forms, view
from tests.conftest import ROOT, thesis_scenario

FLOOR = """poi "a" label "The hall" //[1, 2, 0, 0, 0, 1, 0] bot [3, 4, 0, 0, 0, 0, 1]
poi "b"
connect a and b distance 2.50 one_way only_if nurse at b
event "work" label "Work" collaborative location b duration 3 to 4.5 at_most 2 times
agent "bot" controllable location a can_do work
agent "nurse" human controllable mobile 1.5 location b reacts_to work
rule "r": work /* now */ before work
optional 1 objective: avoid work
"""


def named(parts: List[Dict[str, Any]]) -> Dict[str, Dict[str, Any]]:
    return {part["name"]: part for part in parts}


def test_a_text_is_shown_as_its_parts() -> None:
    shown = view(FLOOR)
    hall = named(shown["places"])["a"]
    assert (hall["label"], hall["x"], hall["y"], hall["yaw"], hall["given"]) == ("The hall", 1, 2, 180, True)
    assert hall["spots"] == [{"robot": "bot", "x": 3, "y": 4}] and (hall["from"], hall["to"]) == (1, 1)
    assert not named(shown["places"])["b"]["given"] and shown["computed"]
    (way,) = shown["ways"]
    assert (way["a"], way["b"], way["distance"], way["one_way"]) == ("a", "b", "2.50", True)
    assert way["only_if"] == "nurse at b"
    work = named(shown["events"])["work"]
    assert (work["duration"], work["at_most"], work["location"]) == ("3 to 4.5", "2", "b")
    assert work["collaborative"] and not work["together"]
    bot, nurse = named(shown["agents"])["bot"], named(shown["agents"])["nurse"]
    assert (bot["kind"], bot["mobile"], bot["can_do"]) == ("robot", "", ["work"])
    assert (nurse["kind"], nurse["mobile"], nurse["reacts_to"]) == ("person", "1.5", ["work"])
    assert [(one["kind"], one["single"]) for one in shown["others"]] == [("RULE", False), ("OBJECTIVE", True)]
    assert shown["errors"] and shown["wanted"] == []


def test_what_is_wanted_is_said_in_sentences() -> None:
    shown = view(thesis_scenario("catch_the_thief").read_text(encoding="utf-8"))
    assert shown["wanted"] == ["catch happens."]


def test_what_is_declared_twice_is_shown_once() -> None:
    shown = view('poi "a"\npoi "a"\nagent "x" location a\nagent "x" location a\nconnect a and a distance 1\n')
    assert (len(shown["places"]), len(shown["agents"]), shown["ways"]) == (1, 1, [])


@pytest.mark.parametrize("name", ["1", "catch_the_thief", ""])
def test_findings_are_those_of_check(name: str, tmp_path: Path) -> None:
    file = thesis_scenario(name) if name else tmp_path / "floor.pur"
    if not name:
        file.write_text(FLOOR, encoding="utf-8")
    found = view(file.read_text(encoding="utf-8"), str(file))["findings"]
    assert [{key: one[key] for key in one if key not in ("start", "end")} for one in found] == [
        as_json(one) for one in findings_in(file)
    ]
    assert found or name


def test_forms_have_a_hole_between_two_pieces_of_words() -> None:
    for form in forms():
        assert len(form["words"]) == len(form["holes"]) + 1
        assert form["kind"] not in ("POI", "CONNECT", "EVENT", "AGENT")


WORDS = "poi connect agent event label only_if and optional human".split()
PIECES = st.sampled_from(['"', "//", "/*", "*/", "[", ":", ",", "\n", "3", "é\U0001f600", *WORDS])
TEXTS = [FLOOR, (ROOT / "scenarios" / "thesis" / "scenario_3.pur").read_text(encoding="utf-8")]


@given(st.sampled_from(TEXTS), st.lists(st.tuples(st.integers(0, 2000), st.integers(0, 40), PIECES), max_size=4))
def test_any_text_can_be_shown(text: str, cuts: List[Any]) -> None:
    for at, length, piece in cuts:
        text = text[:at] + piece + text[at + length :]
    shown = view(text)
    lines = text.count("\n") + 1
    for kind in ("places", "ways", "agents", "events", "others"):
        for part in shown[kind]:
            assert 1 <= part["from"] <= part["to"] <= lines
    places = named(shown["places"])
    assert all(way["a"] in places and way["b"] in places for way in shown["ways"])
    for finding in shown["findings"]:
        if "start" in finding:
            assert 0 <= finding["start"] <= finding["end"] <= len(text.encode("utf-16-le")) // 2
