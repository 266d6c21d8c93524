"""The page says what is to be achieved, what of it is achieved, and which time is guaranteed for how long."""

from __future__ import annotations

from typing import Any, Dict, List

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.ui.promise import Guarantee, Objective, Promise, objectives_now, read_promise, with_written
from pursue_runtime.ui.statuses import Status
from tests.runtime.models import model_data, mover, state

GUARD = {
    "name": "obj", "kind": "safety", "initial": "idle", "locations": {"idle": [], "atRisk": ["Cobj <= 50"], "lose": []},
    "edges": [{"from": "atRisk", "to": "lose", "word": "obj_atRisk2lose", "sync": "own", "controllable": False}],
}  # fmt: skip
DATA = model_data(mover("bot", "robot", 9), mover("thief", "agent", 20))
DATA["automata"].append(GUARD)
DATA["clocks"].append("Cobj")
DATA["variables"]["Sassumed"] = 1
DATA["assumptions"] = [{"variable": "Sassumed", "says": "thief never does ring"}]
DATA["objective"] = {"kind": "reach-while-safe", "goal": ["reachObj", "win"], "bad": ["obj", "lose"]}
MODEL = Model(DATA)
STATUSES = (
    Status("reachObj", "do screw", {"unlocked": "screw to be done", "win": "reached"}),
    Status("obj", "patrol a every 50 by bot", {"idle": "bot is there", "atRisk": "a visit is due", "lose": "broken"}),
)
SETTINGS: Dict[str, Any] = {
    "objectives": [
        {"says": "screw happens.", "of": ["reachObj"]},
        {"says": "bot is at a at least every 50 units.", "of": ["obj"]},
        {"says": "Optional 1: fetch happens.", "of": []},
    ],
    "guarantee": 21.5,
}
PROMISE = read_promise(SETTINGS)


def become(**places: str) -> List[str]:
    shown = objectives_now(PROMISE, STATUSES, MODEL, state(MODEL, 3, 120.0, {"Cobj": 8.5}, **places), 20.0)
    assert [each["says"] for each in shown] == [each["says"] for each in SETTINGS["objectives"]]
    due = ["" if each["due"] is None else f", at {each['due']:g} of {each['limit']:g}" for each in shown]
    return [f"{each['is']}: {each['now']}{when}" for each, when in zip(shown, due)]


def test_each_objective_is_said_with_what_has_become_of_it() -> None:
    assert become() == ["open: screw to be done", "kept: bot is there", "not promised: "]
    assert become(obj="atRisk") == ["open: screw to be done", "kept: a visit is due, at 61.5 of 50", "not promised: "]
    assert become(reachObj="win", obj="lose") == ["reached: ", "broken: ", "not promised: "]


def test_the_time_at_worst_is_that_of_the_workspaces_own_strategy() -> None:
    promise = read_promise({"objectives": [{"says": "bot is at a.", "of": ["obj"], "worst": 41.3}]})
    here = state(MODEL, 3, 120.0, {"Cobj": 8.5})
    told = [objectives_now(promise, STATUSES, MODEL, each, 20.0)[0]["says"] for each in (here, here._replace(plan=1))]
    assert told == ["bot is at a. At worst after 41.3.", "bot is at a."]
    timed = read_promise({"counts": "seconds", "objectives": [{"says": "bot is at a.", "of": ["obj"], "worst": 41.3}]})
    assert timed.objectives[0].now(here, timed.counts) == "bot is at a. At worst after 41.3 seconds."


def test_what_was_written_is_said_while_it_waits_for_its_answer() -> None:
    watch = {
        "name": "obj9", "kind": "safety", "initial": "idle", "locations": {"idle": [], "atRisk": ["Cobj9 <= 5"]},
        "edges": [{"from": "idle", "to": "atRisk", "word": "order1", "sync": "receive", "controllable": True}],
    }  # fmt: skip
    model = MODEL.extended({
        "automata": [watch], "heard": [], "clocks": ["Cobj9"], "variables": {}, "written": [
            {"event": "order1", "says": "bot at a", "within": 5.0}
        ], "objective": {"goal": None, "bad": None, "says": {}, "promises": {}},
    })  # fmt: skip
    here = state(model, 1, 100.0, {})
    assert with_written(PROMISE, model, here) is PROMISE
    due = here._replace(locations={**here.locations, "obj9": "atRisk"}, clocks={**here.clocks, "Cobj9": 2.0})
    *_, said = objectives_now(with_written(PROMISE, model, due), [], model, due, 10.0)
    assert (said["says"], said["due"], said["limit"]) == ("bot at a within 5", 13.0, 5.0)


def test_objectives_are_not_said_twice() -> None:
    statuses = (*STATUSES, Status("Sassumed", "open", {"1": "true"}))
    page = Page(MODEL, FloorPlan({}, ()), statuses=statuses, promise=PROMISE)
    seen = page.view(Facts("running", (), state(MODEL, 3, 120.0, {}), 20.0, 20.0))
    assert [each["is"] for each in seen["objectives"]] == ["open", "kept", "not promised"]
    assert seen["statuses"] == {"open": "true"}


def test_the_guaranteed_time_is_that_of_ui_yaml_where_everybody_keeps_to_the_model() -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    now = state(MODEL, 1, 100.0, {}, event="_start_")
    guarantee.on_state(now)
    assert guarantee.now(now) == {"most": 21.5, "void": ""}
    gone = state(MODEL, 2, 102.0, {"Cbot": 0.0}, event="bot_a2b", agent="bot", bot="going_a_to_b")
    guarantee.on_state(gone)
    there = state(MODEL, 3, 111.5, {"Cbot": 0.0}, event="bot_going_a_to_b2b", agent="bot", bot="b")
    guarantee.on_state(there)
    assert guarantee.now(there)["void"] == ""


@pytest.mark.parametrize("arrival, void", [
    (108.0, "bot was earlier than its model"), (114.0, "bot was later than its model"),
])
def test_an_arrival_that_the_model_does_not_have_voids_the_guaranteed_time(arrival: float, void: str) -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    guarantee.on_state(state(MODEL, 1, 100.0, {}, event="_start_"))
    guarantee.on_state(state(MODEL, 2, 102.0, {"Cbot": 0.0}, event="bot_a2b", agent="bot", bot="going_a_to_b"))
    there = state(MODEL, 3, arrival, {"Cbot": 0.0}, event="bot_going_a_to_b2b", agent="bot", bot="b")
    guarantee.on_state(there)
    guarantee.on_state(there._replace(seq=4, event="", agent=""))
    assert guarantee.now(there)["void"] == void, "and nothing restores it"


@pytest.mark.parametrize("change, void", [
    ({"late": ("bot",)}, "bot was late"), ({"lost": ("bot",)}, "bot was lost"), ({"held": ("bot",)}, "bot was held"),
    ({"displaced": ("bot",)}, "bot was not in its place"), ({"status": "holding"}, "the mission was held"),
    ({"values": {**MODEL.initial().values, "Sassumed": 0}}, "an assumption was broken: thief never does ring"),
])
def test_what_leaves_the_model_voids_the_guaranteed_time_until_the_next_mission(change: Any, void: str) -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    start = state(MODEL, 1, 100.0, {}, event="_start_")
    guarantee.on_state(start)
    guarantee.on_state(start._replace(stamp=105.0, **change))
    later = state(MODEL, 2, 106.0, {})
    guarantee.on_state(later)
    assert guarantee.now(later) == {"most": 21.5, "void": void}
    guarantee.on_state(start._replace(stamp=200.0))
    assert guarantee.now(start) == {"most": 21.5, "void": ""}


def test_a_guarantee_of_no_time_is_one_and_what_is_no_time_is_refused() -> None:
    assert read_promise({"guarantee": 0}).most == 0.0
    for wrong in (-1, float("nan"), float("inf")):
        with pytest.raises(DataError, match="expected a number of time units"):
            read_promise({"guarantee": wrong})


def test_under_another_plan_the_guaranteed_time_is_not_known() -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    found = guarantee.now(state(MODEL, 7, 100.0, {})._replace(plan=1))
    assert found["most"] is None and "new plan" in found["void"]


TAKES = {"most": 12.0, "early": 1.0, "late": 2.0, "stamp": 110.0, "ahead": 1.0, "excused": ["thief"]}


def replanned(stamp: float, takes: Any, seq: int = 3, **more: Any) -> Any:
    """The guaranteed time when a new plan has come into force at this stamp, and the state that it has with that."""
    guarantee = Guarantee(PROMISE, MODEL)
    guarantee.on_state(state(MODEL, 1, 100.0, {}, event="_start_"))
    guarantee.on_state(state(MODEL, 2, 109.0, {}, status="holding")._replace(late=("thief",)))
    guarantee.add_plan(7, {"plan": 7, "takes": takes})
    now = state(MODEL, seq, stamp, {})._replace(plan=7, late=("thief",), **more)
    guarantee.on_state(now, stamp - 100.0)
    return guarantee, now


@pytest.mark.parametrize(("stamp", "most"), [(109.9, None), (110.0, 22.0), (113.0, 25.0), (113.1, None)])
def test_a_new_plan_guarantees_its_own_time_from_when_it_comes_into_force(stamp: float, most: Any) -> None:
    guarantee, now = replanned(stamp, TAKES)
    assert guarantee.now(now)["most"] == most and bool(guarantee.now(now)["void"]) == (most is None)


@pytest.mark.parametrize("takes", [None, {}, 7, {**TAKES, "most": "x"}, {**TAKES, "most": float("inf")},
                                   {**TAKES, "excused": 7}])  # fmt: skip
def test_a_plan_that_tells_no_time_has_none(takes: Any) -> None:
    guarantee, now = replanned(111.0, takes)
    assert guarantee.now(now) == {"most": None, "void": "a new plan is in force, which leads to the goal"}


@pytest.mark.parametrize(("late", "provided"), [
    (["bot"], ", provided that bot goes on"), (["bot", "thief"], ", provided that bot and thief go on"),
    (7, ""), ([], ""),
])
def test_a_plan_that_relies_on_who_is_late_says_so(late: Any, provided: str) -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    guarantee.add_plan(1, {"plan": 1, "awaited": late})
    guarantee.on_state(state(MODEL, 1, 100.0, {}, event="_start_"))
    now = state(MODEL, 2, 130.0, {})._replace(plan=1, late=("bot",))
    guarantee.on_state(now, 30.0)
    why = f"a new plan is in force, which leads to the goal{provided}"
    assert guarantee.now(now) == {"most": None, "void": why}


def test_a_state_that_was_missed_leaves_the_time_of_the_plan_unknown() -> None:
    guarantee, now = replanned(111.0, TAKES, seq=4)
    assert guarantee.now(now)["most"] is None


def test_the_time_of_a_plan_relies_on_all_but_those_that_are_away_until_they_are_back() -> None:
    guarantee, now = replanned(111.0, TAKES)
    assert guarantee.now(now) == {"most": 23.0, "void": ""}
    late = now._replace(seq=4, late=("thief", "bot"))
    guarantee.on_state(late, 12.0)
    assert guarantee.now(late)["void"] == "bot was late"
    guarantee, now = replanned(111.0, TAKES)
    guarantee.on_state(now._replace(seq=4, late=()), 12.0)
    again = now._replace(seq=5, late=("thief",))
    guarantee.on_state(again, 13.0)
    assert guarantee.now(again)["void"] == "thief was late"


def test_what_was_broken_before_a_plan_does_not_void_its_time() -> None:
    broken = {**MODEL.initial().values, "Sassumed": 0}
    guarantee, now = replanned(111.0, TAKES, values=broken)
    assert guarantee.now(now)["void"] == ""
    guarantee, now = replanned(111.0, TAKES)
    guarantee.on_state(now._replace(seq=4, values=broken), 12.0)
    assert "an assumption was broken" in guarantee.now(now)["void"]
    start = state(MODEL, 1, 200.0, {}, event="_start_")
    guarantee.on_state(start)
    assert guarantee.now(start) == {"most": 21.5, "void": ""}, "the next mission"


def test_who_was_not_there_from_the_start_does_not_know_whether_it_holds() -> None:
    guarantee = Guarantee(PROMISE, MODEL)
    now = state(MODEL, 5, 100.0, {})
    guarantee.on_state(now)
    assert "not known" in guarantee.now(now)["void"]


def test_without_a_goal_there_is_no_time_to_it() -> None:
    data = {**DATA, "objective": {"kind": "safety", "goal": None, "bad": ["obj", "lose"]}}
    assert Guarantee(PROMISE, Model(data)).now(state(MODEL, 1, 100.0, {})) == {}


def test_a_file_of_before_promises_nothing_and_a_wrong_one_is_refused() -> None:
    assert read_promise({}) == Promise()
    assert read_promise({"objectives": [{"says": "x", "of": ["y"]}]}) == Promise((Objective("x", ("y",)),))
    wrong: Any
    for wrong in ({"objectives": 7}, {"objectives": [7]}, {"objectives": [{"says": "x"}]}, {"guarantee": "soon"},
                  {"guarantee": float("inf")}, {"guarantee": [1]}, {"guarantee": -1}):
        with pytest.raises(DataError, match=r"ui\.yaml"):
            read_promise(wrong)
