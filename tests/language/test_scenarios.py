"""The scenarios that come with the project, and the published ones, are read without an error."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Dict, List, Tuple

import pytest

from pursue_gen.language import check, load
from pursue_gen.language.scenario import Respond

ROOT = Path(__file__).resolve().parents[2]
PUBLISHED = ("CT1", "CT2a", "CT3a", "CT3b", "CT4", "CT5", "EB1", "EB2", "EB2x", "EB3", "EB4", "WC1", "WC2a")


@pytest.mark.parametrize("path", sorted((ROOT / "scenarios").rglob("*.pur")), ids=lambda path: path.stem)
def test_own_scenarios_have_no_findings_but_lasting_events_of_two(path: Path) -> None:
    scenario = load(path)
    assert {finding.code for finding in check(scenario)} <= {"PML158"}


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_scenarios_have_no_findings_but_lasting_events_of_two(name: str, reference_dir: Path) -> None:
    scenario = load(reference_dir / name / "scenario.pur")
    assert scenario.name == "scenario"
    of_two = [event for event in scenario.events if event.collaborative and event.duration is not None]
    assert [finding.code for finding in check(scenario)] == ["PML158"] * len(of_two)


THESIS: Dict[str, Tuple[List[str], Dict[Tuple[str, str], int], Dict[str, object], Dict[str, object], str]] = {
    "scenario_1": (
        ["a", "b", "c"],
        {("a", "c"): 3, ("c", "b"): 3},
        {"bot1_inb": ("b", 3, False), "bot2_ina": ("a", 6, False)},
        {"bot1": (3, "c", ["bot1_inb"], []), "bot2": (3, "c", ["bot2_ina"], [])},
        "bot2_ina",
    ),
    "scenario_2": (
        ["a", "b", "c"],
        {("a", "b"): 3, ("a", "c"): 3, ("c", "b"): 3},
        {"bot1_inb": ("b", 3, False), "bot2_ina": ("a", 6, True)},
        {
            "bot1": (3, "c", ["bot1_inb"], []),
            "bot2": (3, "c", ["bot2_ina"], []),
            "bot3": (3, "c", [], ["bot2_ina"]),
        },
        "bot2_ina",
    ),
    "scenario_3": (
        ["a", "b", "c"],
        {("a", "b"): 3, ("a", "c"): 3, ("c", "b"): 3},
        {"bot1_inb": ("b", 3, False), "bot2_ina": ("a", 3, False), "bot3_Finish": (None, 2, False)},
        {
            "bot1": (3, "c", ["bot1_inb"], []),
            "bot2": (3, "c", ["bot2_ina"], []),
            "bot3": (2, "c", ["bot3_Finish"], []),
        },
        "bot3_Finish",
    ),
    "scenario_4": (
        ["a", "b", "c"],
        {("a", "b"): 3, ("a", "c"): 3, ("c", "b"): 3},
        {"bot1_inb": ("b", 3, False), "bot2_ina": ("a", 6, True), "bot4_Finish": (None, 2, False)},
        {
            "bot1": (3, "c", ["bot1_inb"], []),
            "bot2": (3, "c", ["bot2_ina"], []),
            "bot3": (3, "c", [], ["bot2_ina"]),
            "bot4": (2, "c", ["bot4_Finish"], []),
        },
        "bot4_Finish",
    ),
    "catch_the_thief": (
        ["a", "b", "c", "d"],
        {("a", "b"): 3, ("b", "c"): 6, ("c", "d"): 3, ("d", "a"): 6},
        {"catch": (None, None, True)},
        {
            "polBot1": (1, "a", ["catch"], []),
            "polBot2": (1, "a", ["catch"], []),
            "thief": (2, "c", [], ["catch"]),
        },
        "catch",
    ),
}


@pytest.mark.parametrize("name", sorted(THESIS))
def test_thesis_scenarios_say_what_the_listings_say(name: str) -> None:
    pois, ways, events, agents, goal = THESIS[name]
    scenario = load(ROOT / "scenarios" / "thesis" / f"{name}.pur")
    assert [poi.name for poi in scenario.pois] == pois
    assert {(way.a, way.b): way.distance for way in scenario.connections} == ways
    assert {
        event.name: (event.location.name if event.location else None, event.duration, event.collaborative)
        for event in scenario.events
    } == events
    assert {
        agent.name: (
            agent.mobile,
            agent.location.name,
            [ref.name for ref in agent.can_do],
            [ref.name for ref in agent.reacts_to],
        )
        for agent in scenario.agents
    } == agents
    assert [agent.name for agent in scenario.agents if not agent.controllable] == (["thief"] if goal == "catch" else [])
    (reach,) = scenario.reach
    assert ([ref.name for ref in reach.events], reach.after, reach.within) == ([goal], 0, None)
    assert not scenario.safety
    assert all(poi.pose is None for poi in scenario.pois) == name.startswith("scenario")


def test_the_office_robot_has_the_deadline_that_it_can_keep() -> None:
    scenario = load(ROOT / "scenarios" / "ecobot" / "ecobot.pur")
    (safety,) = scenario.safety
    assert isinstance(safety, Respond) and safety.deadline == 46


def test_a_part_of_any_kind_is_replaced_and_nothing_else() -> None:
    scenario = load(sorted((ROOT / "scenarios").rglob("*.pur"))[0])
    for kind in ("pois", "events", "agents", "safety", "reach", "connections"):
        for old in getattr(scenario, kind):
            new = replace(old, span=replace(old.span, line=999))
            changed = scenario.with_instead(old, new)
            assert new in getattr(changed, kind) and old not in getattr(changed, kind)
            assert changed.with_instead(new, old) == scenario
