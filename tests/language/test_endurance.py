"""Batteries by time as a text: what they are read as, what is said of them, and what is wrong with them."""

from __future__ import annotations

from typing import List

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.language import parse
from pursue_gen.language.checks import check_reading
from pursue_gen.language.document import Document
from pursue_gen.language.occurrences import occurrences
from pursue_gen.language.parser import read
from pursue_gen.language.scenario import Endurance
from pursue_gen.language.sentences import speed_words
from pursue_gen.language.writer import scenario_text

HOUSE = """\
poi "dock"
poi "hall"
connect dock and hall distance 3
event "wipe" location hall duration 2 to 4
event "ring" location hall
agent "bot" controllable mobile 1 location dock can_do wipe
agent "guest" location hall can_do ring
{}
objective: if ring then wipe within 30
"""
BATTERY = "battery bot lasts {}, charges in {} at dock"
FULL = BATTERY.format(60, 20)


def codes(statement: str, text: str = HOUSE) -> List[str]:
    return [finding.code for finding in check_reading(read(text.format(statement), "x.pur", "x"))]


def battery(statement: str = FULL) -> Endurance:
    last = parse(HOUSE.format(statement), "x.pur", "x").safety[-1]
    assert isinstance(last, Endurance)
    return last


def test_it_is_a_promise_behind_the_objectives_wherever_it_stands() -> None:
    assert [each.word for each in parse(HOUSE.format(FULL), "x.pur", "x").objectives] == ["objective", ""]
    assert (battery().agent.name, battery().lasts, battery().charge, battery().dock.name) == ("bot", 60, 20, "dock")
    assert battery('battery "bot" lasts 2.5, charges in 1 at dock').lasts == 2.5
    assert codes(FULL) == []


def test_parts_that_cannot_be_written_say_which_can() -> None:
    (found,) = check_reading(read(HOUSE.format(FULL.replace(" at", " in 3 parts at")), "x.pur", "x"))
    assert found.message == "in 3 parts: one would be 20 of lasts 60, charged in 20/3"
    assert "in 2, 4, 5, 8, 10, 16 or 20 parts" in found.hint


def test_what_is_said_of_parts() -> None:
    parts = battery(FULL.replace(" at", " in 4 parts at"))
    assert (parts.parts, parts.part, parts.part_charge) == (4, 15, 5)
    assert parts.sentence(str).endswith("is full after 20 units there; each of 4 equal parts of that counts.")
    assert parts.in_words == "battery lasts 60, full after 20 in 4 parts at dock"


def test_what_is_said_of_it() -> None:
    scenario = parse(HOUSE.format(FULL), "x.pur", "x")
    said = "The battery of bot lasts 60 units away from dock, and is full after 20 units there."
    assert battery().sentence(str) == said
    assert speed_words(scenario.agents[0], scenario).endswith("battery lasts 60, full after 20 at dock")
    assert "empty: not at dock within 60" in battery().broken(str)
    assert [battery().status(place) for place in ("idle", "atCharger", "atChargerEmpty", "atRisk", "lose")] == [
        "full, bot is at dock", "bot charges at dock", "bot charges at dock, and has to stay there until it is full",
        "bot has to be back at dock in time", "empty",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("statement", "found"),
    [
        (FULL.replace("bot", "guest"), ["PML310", "PML230"]),
        (f"{FULL}\n{BATTERY.format(30, 1)}", ["PML311"]),
        (f"{FULL}\nbattery bot capacity 9 uses 1 per unit", ["PML311"]),
        (BATTERY.format(0, 20), ["PML312"]),
        (BATTERY.format(60, 0), ["PML312"]),
        (BATTERY.format(3, 2), ["PML316"] * 2),
        (FULL.replace("dock", "cellar"), ["PML110"]),
        (FULL.replace("bot", "bat"), ["PML110"]),
        (f"optional 1 {FULL}", ["PML010"]),
        (FULL.replace(" at", " in 4 parts at"), []),
        (FULL.replace(" at", " in 1 parts at"), []),
        (FULL.replace(" at", " in 0 parts at"), ["PML312"]),
        (FULL.replace(" at", " in 21 parts at"), ["PML312"]),
        (FULL.replace(" at", " in 3 parts at"), ["PML312"]),
    ],
)
def test_what_is_wrong_with_it(statement: str, found: List[str]) -> None:
    assert codes(statement) == found


def test_a_robot_that_others_keep_busy_may_have_one() -> None:
    text = HOUSE.replace("event", 'event "lift" collaborative together location hall duration 2\nevent', 1)
    text = text.replace("can_do wipe", "can_do wipe reacts_to lift").replace("can_do ring", "can_do ring, lift")
    assert codes("battery bot capacity 60 uses 1 per unit", text) == ["PML314"] and codes(FULL, text) == []


@pytest.mark.parametrize("name", ["battery", "lasts", "charges", "parts"])
def test_its_words_are_names_as_well(name: str) -> None:
    assert codes(FULL, HOUSE.replace("ring", name)) == []
    assert codes(FULL.replace("dock", name), HOUSE.replace("dock", name)) == []


def test_the_word_behind_the_comma_is_no_name() -> None:
    found = [(each.name, each.kind) for each in occurrences(Document(FULL).statements)]
    assert found == [("bot", "agent"), ("dock", "POI")]


@given(st.integers(1, 10_000), st.integers(1, 10_000), st.sampled_from(("", " in 4 parts")), st.booleans())
def test_a_scenario_of_which_it_is_a_part_is_written_as_it_is_read(
    lasts: int, charge: int, parts: str, quoted: bool
) -> None:
    statement = BATTERY.format(lasts, f"{charge}{parts}").replace("bot", '"bot"' if quoted else "bot")
    scenario = parse(HOUSE.format(statement), "x.pur", "x")
    again = parse(scenario_text(scenario), "x.pur", "x")
    assert [each.full_text for each in again.objectives] == [each.full_text for each in scenario.objectives]
