"""A scenario that is built or changed in Python has a text that says the same, or an error says that it has none."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from pursue_gen.diagnostics import PursueError
from pursue_gen.language import check, load, parse
from pursue_gen.language.conditions import At, Holds, Not, Who
from pursue_gen.language.scenario import (
    Agent,
    Always,
    Avoid,
    Connection,
    Event,
    Patrol,
    Poi,
    Pose,
    Reach,
    Ref,
    Scenario,
    Spot,
)
from pursue_gen.language.writer import scenario_text, written

from .test_diagnostic_pages import WITH_EXAMPLE, examples
from .test_formatter import OWN, meaning
from .texts import text

WAYS = {"pois": (Poi("a"), Poi("b")), "connections": (Connection("a", "b", 3),)}
BOT = Agent("bot", Ref("a"), controllable=True, mobile=2, can_do=(Ref("work"),))
BUILT = Scenario("lab", **WAYS, events=(Event("work", location=Ref("b"), duration=3),), agents=(BOT,))


def same(scenario: Scenario) -> None:
    """Tests that the text of the values alone is that scenario again."""
    bare = replace(scenario, text="", pois=tuple(replace(poi, pose=None, spots=()) for poi in scenario.pois))
    again = written(bare)
    assert meaning(again) == meaning(bare)
    assert scenario_text(again) == again.text


@pytest.mark.parametrize("file", OWN, ids=lambda file: file.stem)
def test_scenarios_of_the_project_are_written_as_they_were_read(file: Path) -> None:
    scenario = load(file)
    assert written(scenario) is scenario
    same(scenario)


@pytest.mark.parametrize("code", WITH_EXAMPLE)
def test_each_statement_of_the_language_is_written(code: str) -> None:
    same(parse(examples(code)[1], "example.pur"))


def test_poses_are_written_with_the_places() -> None:
    turned = Pose(1.5, -2, 0, 0, 0, 0.6, 0.8)
    spot = (Spot(Ref("bot"), turned),)
    poses = (Poi("a", turned), Poi("b", spots=spot), Poi("c", turned, spots=spot, label="the lab"))
    pois = written(replace(BUILT, pois=poses)).pois
    assert [(poi.pose, [one.pose for one in poi.spots], poi.label) for poi in pois] == [
        (turned, [], None), (None, [turned], None), (turned, [turned], "the lab")
    ]  # fmt: skip


def test_a_scenario_can_be_built_without_places_in_a_text() -> None:
    scenario = written(replace(BUILT, reach=(Reach((Ref("work"),), within=20),)))
    assert scenario.file == "lab.pur" and check(scenario) == ()
    assert scenario.text.splitlines()[-1] == "reach_objective: do work within 20"
    assert scenario.agents[0].span.line > 1


def test_what_is_changed_in_python_is_what_the_text_says() -> None:
    read = parse(text(), "test.pur")
    changed = written(replace(read, connections=(replace(read.connections[0], distance=Fraction(5, 2)),)))
    assert "connect a and b distance 2.5\n" in changed.text
    assert meaning(changed.connections) == meaning((Connection("a", "b", Fraction(5, 2)),))


@pytest.mark.parametrize("number", [2.5, Fraction(5, 2), 3, 0.1])
def test_numbers_are_those_that_people_see(number: Any) -> None:
    (way,) = written(replace(BUILT, connections=(Connection("a", "b", number),))).connections
    assert way.distance == Fraction(str(number))


def test_lists_are_taken_for_tuples() -> None:
    changed = replace(BUILT, pois=[Poi("a"), Poi("b")])  # type: ignore[arg-type] # as people type in a notebook
    assert written(changed) == written(BUILT)


def test_a_patrol_in_order_is_one_statement() -> None:
    def patrol(*order: str) -> Any:
        return tuple(Patrol(Ref(place), 9, Who(None, True), order=order) for place in order)

    scenario = replace(BUILT, safety=(*patrol("a", "b"), *patrol("b", "a"), Patrol(Ref("a"), 5, Who(Ref("bot")))))
    assert scenario_text(scenario).splitlines()[-3:] == [
        "objective: patrol a, b in order every 9 by any robot",
        "objective: patrol b, a in order every 9 by any robot",
        "objective: patrol a every 5 by bot",
    ]


@pytest.mark.parametrize(
    "change",
    [
        {"pois": (Poi('a" poi "c'), Poi("b"))},
        {"pois": (Poi("a"), Poi("b\npoi"))},
        {"pois": (Poi("a"), Poi("b", label='"'))},
        {"agents": (replace(BOT, can_do=(Ref("work, rest"),)),)},
        {"connections": (Connection("a", "b", 3, only_if=Holds(Ref("s // t"), True)),)},
        {"reach": (Avoid(Ref("work")),)},
        {"safety": (Patrol(Ref("a"), 9, Who(None, True), order=("a", "b")),)},
        {"safety": (Always(Not(Not(At(Who(Ref("bot")), Ref("a"))))),)},
        {"connections": (Connection("a", "b", float("nan")),)},
    ],
)
def test_what_no_text_can_say_is_an_error(change: Any) -> None:
    with pytest.raises(PursueError) as caught:
        scenario_text(replace(BUILT, **change))
    assert caught.value.diagnostics[0].hint
