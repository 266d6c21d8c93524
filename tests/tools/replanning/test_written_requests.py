"""Orders that people write: the planner's answer is that to an order of the scenario with the same objective."""

from __future__ import annotations

from typing import Any, Dict

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from pursue_gen.diagnostics import PursueError
from pursue_gen.tools.replanning import replan
from pursue_runtime.model import Model
from pursue_runtime.observer.ordering import effect, read_order
from tests.runtime.observer.test_ordering import GAME, MODEL, TEA


def menu(age: float, first: str, within: int) -> Dict[str, Any]:
    """A request for `tea2`, behind another order, in a scenario that promises it within that time."""
    text = TEA.replace("if tea2 then serve2 within 60", f"if tea2 then serve2 within {within}")
    return {**_behind(age, first, "tea2", within), "game": {**GAME, "scenario": text}}


def written(age: float, first: str, within: int) -> Dict[str, Any]:
    """The same, where the scenario does not have that order."""
    text = TEA.replace('event "tea2" on_order\n', "").replace("objective: if tea2 then serve2 within 60\n", "")
    data = _behind(age, first, "", within)
    data["locations"].pop("obj2"), data["clocks"].pop("Cobj2")
    asked = {"says": "do serve2", "within": within, "waited": 0.0}
    return {**data, "game": {**GAME, "scenario": text}, "asked": asked}


def _behind(age: float, first: str, second: str, within: int) -> Dict[str, Any]:
    position, clocks = MODEL.initial().aged(age), {}
    for text in filter(None, (first, second)):
        done = effect(MODEL, position, read_order(text, 0.0, 1.0, MODEL))
        position, clocks = done.after(position, 0.0), done.clocks
    data = {"format": 1, **position._asdict(), "ahead": 1.0, "excused": [], "window": 2.0}
    return {**data, **({"sooner": clocks} if second else {})}


@given(st.integers(0, 40), st.sampled_from(["", "tea1", "tea1 within 20", "tea1 within 14"]), st.integers(5, 60))
@settings(max_examples=40, deadline=None)
def test_the_answer_is_that_to_an_order_of_the_scenario(age: int, first: str, within: int) -> None:
    one, other = replan(menu(age / 4, first, within), 5000), replan(written(age / 4, first, within), 5000)
    assert one["won"] == other["won"]
    assert other["won"] or "serve2 within" in other["why"] or "no plan" in other["why"]
    if not other["won"] and "possible" in other:
        later = replan(written(age / 4, first, within + int(other["possible"]) + 1), 5000)
        assert later["won"]


def test_a_plan_says_what_it_adds_and_the_next_request_has_it() -> None:
    answer = replan(written(5.0, "tea1", 60), 5000)
    adds = answer["adds"]
    assert [each["name"] for each in adds["automata"]] == ["order_desk", "obj2"]
    assert (adds["clocks"], adds["variables"]) == (["Cobj2"], {})
    assert adds["written"] == [{"event": "order1", "says": "do serve2", "within": 60.0}]
    assert adds["objective"]["says"]["obj2"] == "serve2 within 60"
    data = written(5.0, "tea1", 60)
    data["written"] = [data.pop("asked")]
    data["locations"]["obj2"], data["clocks"]["Cobj2"] = "atRisk", 0.0
    again = replan(data, 5000)
    assert again["won"] and again["adds"] == adds


def test_a_scenario_without_orders_gets_a_desk_and_its_model_knows_what_is_heard() -> None:
    text = "\n".join(line for line in TEA.splitlines() if "tea" not in line) + '\nagent "guest" location room1\n'
    game = {**GAME, "scenario": f"{text}objective: bot never_with guest\n"}
    data = written(5.0, "", 60)
    data["locations"]["guest"], data["values"]["Pguest"], data["clocks"]["Cguest"] = "room1", 2, 5.0
    data["values"].pop("order_desk_open"), data["locations"].pop("order_desk")
    data = {**data, "game": game, "asked": {"says": "not bot at kitchen", "within": 60, "waited": 0.0}}
    adds = replan(data, 5000)["adds"]
    assert adds["variables"] == {"order_desk_open": 0} and [each["kind"] for each in adds["automata"]] == [
        "orders", "safety",
    ]  # fmt: skip
    assert ["bot", "going_room2_to_kitchen", "kitchen", "bot_going_room2_to_kitchen2kitchen"] in adds["heard"]
    model = MODEL.extended(adds)
    heard, before = ({edge.sync for edge in each.automaton("bot").edges if edge.target == "kitchen"} for each in
                     (model, MODEL))  # fmt: skip
    assert (heard, before) == ({"send"}, {"own"})


def test_what_would_need_another_model_of_who_is_under_way_is_refused() -> None:
    """Two things that a robot can do at one place: what tells them apart has to be there from the start on."""
    text = TEA.replace('event "serve2" location room2', 'event "serve2" location room1')
    data = {**written(5.0, "", 60), "game": {**GAME, "scenario": text}}
    answer = replan({**_with_all(data), "asked": {"says": "bot doing serve1", "within": 60, "waited": 0.0}}, 5000)
    assert not answer["won"] and "cannot begin to tell this apart" in answer["why"]


def _with_all(data: Dict[str, Any]) -> Dict[str, Any]:
    data["locations"]["obj2"], data["clocks"]["Cobj2"] = "idle", 5.0
    return data


@pytest.mark.parametrize(
    ("key", "value", "why"),
    [
        ("written", 3, "written is 3"),
        ("written", [{"says": "bot at room1"}], "the order has no within"),
        ("written", [{"says": "bot at room9", "within": 3}], "written: column 8: there is no POI room9"),
        ("asked", {"says": 1, "within": 3, "waited": 0}, "says is 1"),
        ("asked", {"says": "x", "within": -3, "waited": 0}, "within is -3"),
        ("asked", {"says": "x", "within": 3}, "waited is None"),
    ],
)
def test_a_request_that_cannot_be_used_is_refused(key: str, value: object, why: str) -> None:
    with pytest.raises(PursueError, match=why):
        replan({**written(2.0, "", 60), key: value})


def test_a_model_becomes_another_for_all_who_hold_it() -> None:
    adds = replan(written(5.0, "tea1", 60), 5000)["adds"]
    model = Model.__new__(Model)
    model.become(MODEL)
    model.become(model.extended(adds))
    assert [each.event for each in model.written] == ["order1"] and "order1" not in model.orders
    assert model.shown("order1") == "do serve2 within 60" and MODEL.written == ()
