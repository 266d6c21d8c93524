"""What the page shows: the map, who does what between which moments, what can be said, what has happened."""

from __future__ import annotations

import json
from typing import Any, Dict, Optional

import pytest

from pursue_runtime.data import DataError
from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.ui.page import MAX_ENTRIES, Facts, FloorPlan, Page, read_floor_plan
from tests.runtime.models import model_data, mover, state, worker

MODEL = Model(
    model_data(mover("bot", "robot", 9), mover("thief", "agent", 20), worker("nurse", "human"), worker("boy", "agent"))
)
PLACES = {"a": (0.0, 0.0), "b": (9.0, 0.0), "s": (3.0, 4.0)}
PLAN = FloorPlan(PLACES, (("a", "b", 9.0),))


def page(**more: Any) -> Any:
    return Page(MODEL, PLAN, **more)


def view(shown: Any, now: Any, at: float = 0.0, phase: str = "running", verdict: Any = None) -> Dict[str, Any]:
    seen: Dict[str, Any] = shown.view(Facts(phase, (), now, at, at, verdict))
    json.dumps(seen, allow_nan=False)
    return seen


def agent(seen: Dict[str, Any], name: str) -> Dict[str, Any]:
    return next(agent for agent in seen["agents"] if agent["name"] == name)


def at(seq: int, stamp: float, clock: float = 50.0, clocks: Optional[Dict[str, float]] = None, **more: Any) -> Any:
    every = {name: clock for name in MODEL.clocks}
    return state(MODEL, seq, stamp, {**every, **(clocks or {})}, **more)


# The map

def test_the_scene_has_the_map_everybody_and_a_button_for_each_thing_that_nobody_controls() -> None:
    scene = page().scene()
    assert scene["places"] == {"a": [0.0, 0.0], "b": [9.0, 0.0], "s": [3.0, 4.0]}
    assert scene["ways"] == [["a", "b", 9.0]]
    assert [agent["kind"] for agent in scene["agents"]] == ["robot", "agent", "human", "agent"]
    buttons = {button["word"]: (button["agent"], button["label"], button["from"]) for button in scene["buttons"]}
    assert buttons == {
        "thief_a2b": ("thief", "a → b", ["a"]), "thief_b2a": ("thief", "b → a", ["b"]),
        "boy:screw": ("boy", "screw", ["s"]),
    }  # fmt: skip


def test_ends_are_reported_on_the_page_for_those_whose_ends_come_from_there() -> None:
    everybody = page(reporters=("boy", "bot", "nurse", "thief"))
    assert everybody.scene()["reporters"] == ["bot", "thief", "nurse", "boy"]
    under_way = {"bot": "going_a_to_b", "thief": "going_a_to_b", "boy": "doing_screw_in_s"}
    bot, thief, boy = view(everybody, at(3, 100.0, **under_way))["tasks"]
    assert (bot["text"], bot["label"], bot["word"]) == ("a → b", "Arrived", "bot_going_a_to_b2b")
    assert (thief["text"], thief["label"], thief["word"]) == ("a → b", "Arrived", "thief_going_a_to_b2b")
    assert (boy["text"], boy["label"], boy["word"]) == ("screw at s", "Done", "boy:screwDONE")
    assert page(reporters=("nurse",)).scene()["reporters"] == ["nurse"]
    assert view(page(reporters=("nurse",)), at(3, 100.0, **under_way))["tasks"] == []


def test_a_map_is_read_and_a_wrong_one_refused() -> None:
    poses = {"poses": {"a": [1, 2, 0, 0, 0, 0, 1], "b": [3, 4, 0, 0, 0, 0, 1]}}
    plan = read_floor_plan(poses, {"connections": [["a", "b", 3], ["a", "nowhere", 1]]})
    assert plan == FloorPlan({"a": (1.0, 2.0), "b": (3.0, 4.0)}, (("a", "b", 3.0),))
    one_way = read_floor_plan(poses, {"connections": [["a", "b", 3, "one_way"]]})
    assert (one_way.ways, one_way.one_ways) == ((("a", "b", 3.0),), (("a", "b"),))
    assert read_floor_plan(poses, {}).ways == ()
    for wrong in ({}, {"poses": {"a": [1]}}, {"poses": {"a": ["x", 0]}}, {"poses": 7}, {**poses, "robots": []}):
        with pytest.raises(DataError):
            read_floor_plan(wrong, {})


# Who does what

def test_a_movement_is_reported_with_its_ends_and_the_window_of_its_arrival() -> None:
    seen = view(page(), at(3, 120.0, clocks={"Cbot": 2.0}, bot="going_a_to_b"), at=20.0)
    bot = agent(seen, "bot")
    assert (bot["place"], bot["to"], bot["doing"]) == ("a", "b", "is on its way from a to b")
    assert (bot["since"], bot["low"], bot["high"]) == (18.0, 27.0, 28.0)
    (arrival,) = bot["next"]
    assert bot["awaited"] == arrival["may"] == "arrive at b"
    assert 27.0 < arrival["opens"] < 27.1 and arrival["closes"] == 28.0


def test_an_action_is_reported_where_it_is_done() -> None:
    nurse = agent(view(page(), at(3, 120.0, clocks={"Cnurse": 1.0}, nurse="doing_screw_in_s"), at=20.0), "nurse")
    assert (nurse["place"], nurse["to"], nurse["doing"]) == ("s", "", "is doing screw at s")
    assert nurse["awaited"] == "finish screw"
    assert (nurse["low"], nurse["high"]) == (22.0, 23.0)


def test_whoever_stands_is_reported_with_what_may_come_and_when() -> None:
    seen = view(page(), at(1, 100.0, clock=0.0), at=0.0)
    thief = agent(seen, "thief")
    assert (thief["doing"], thief["awaited"], thief["since"]) == ("is at a", "", None)
    assert [choice["may"] for choice in thief["next"]] == ["go to b"]
    assert 1.0 < thief["next"][0]["opens"] < 1.1 and thief["next"][0]["closes"] is None
    assert seen["open"]["thief_a2b"] == [thief["next"][0]["opens"], None]


def test_who_is_not_controlled_is_not_said_to_go_anywhere() -> None:
    under_way = at(3, 120.0, clocks={"Cbot": 2.0}, bot="going_a_to_b", thief="going_a_to_b")
    seen = view(page(), under_way, at=20.0)
    assert agent(seen, "bot")["doing"] == "is on its way from a to b"
    assert agent(seen, "thief")["doing"] == "is on its way from a to b"


def test_what_the_mission_waits_for() -> None:
    shown = page()
    busy = at(2, 100.0, clocks={"Cthief": 1.0}, bot="going_b_to_a", thief="going_a_to_b", nurse="doing_screw_in_s")
    everybody = "Waits for bot to arrive at a, thief to arrive at b and nurse to finish screw."
    assert view(shown, busy)["turn"] == everybody
    without = view(shown, busy._replace(lost=("thief",)))
    assert "thief" not in without["turn"] and agent(without, "thief")["lost"]
    quiet = view(shown, at(2, 100.0))["turn"]
    assert quiet == "Waits for the next command of the strategy, or for what thief or boy may do."
    assert "holds" in view(shown, at(2, 100.0, status="holding"))["turn"]
    assert view(shown, at(2, 100.0, status="won"))["turn"] == ""


def test_what_has_to_be_known_of_an_agent_is_said() -> None:
    now = at(2, 100.0, bot="going_a_to_b", nurse="doing_screw_in_s")
    now = now._replace(held=("bot",), lost=("thief",), displaced=("boy", "nurse"), returning=("boy",))
    seen = view(page(), now._replace(out_of_service=("bot",)))
    assert seen["out_of_service"] == ["bot"]
    assert {each["name"]: each["notes"] for each in seen["agents"]} == {
        "bot": ["held, until it is resumed", "out of service"], "thief": ["counts as lost"],
        "nurse": ["is not known to be there"], "boy": ["is sent back there"],
    }  # fmt: skip


def test_rules_leave_nothing_to_press() -> None:
    assert "boy:screw" not in view(page(), at(1, 100.0, values={"Prule": 1}))["open"]


@pytest.mark.parametrize("status, live", [
    ("waiting", False), ("running", True), ("holding", True), ("won", False), ("lost", False), ("stopped", False),
])
def test_every_status_can_be_shown(status: str, live: bool) -> None:
    seen = view(page(), at(4, 100.0, status=status, reason="for a reason"), verdict=(1, "It is over."))
    assert (seen["status"], seen["live"], seen["reason"]) == (status, live, "for a reason")
    assert (seen["verdict"], seen["good"]) == ("It is over.", False)
    assert bool(seen["open"]) is live


def test_before_the_first_state_everybody_is_at_the_start() -> None:
    seen = view(page(), None, phase="waiting for the nodes")
    assert (seen["status"], seen["phase"], seen["at"]) == ("waiting", "waiting for the nodes", 0.0)
    assert agent(seen, "thief")["place"] == "a"


def test_people_get_instructions_and_when_it_is_planned_to_be_done() -> None:
    shown = page(reporters=("nurse",))
    (task,) = view(shown, at(3, 100.0, clocks={"Cnurse": 1.0}, nurse="doing_screw_in_s"), at=7.0)["tasks"]
    assert (task["agent"], task["text"], task["word"]) == ("nurse", "do screw at s", "nurse:screwDONE")
    assert (task["since"], task["low"], task["high"]) == (6.0, 9.0, 10.0)
    assert view(shown, at(4, 100.0))["tasks"] == []
    assert view(shown, at(4, 100.0, nurse="doing_screw_in_s", status="stopped"))["tasks"] == []


# What has happened

def test_the_log_tells_events_in_words_each_once() -> None:
    shown = page()
    told = []
    told += shown.on_state(at(1, 100.0, event="_start_"), 0.0)
    going = at(2, 101.5, event="thief_a2b", agent="thief", thief="going_a_to_b")
    told += shown.on_state(going, 1.5)
    told += shown.on_state(going._replace(stamp=102.5), 2.5)
    told += shown.on_state(at(3, 122.0, event="thief_going_a_to_b2b", agent="thief", thief="b"), 22.0)
    told += shown.on_state(at(4, 123.0, event="screw", agent="boy", thief="b", boy="doing_screw_in_s"), 23.0)
    told += shown.on_state(at(5, 127.0, event="screwDONE", agent="boy", thief="b"), 27.0)
    assert [(entry["at"], entry["text"]) for entry in told] == [
        (0.0, "the mission starts"), (1.5, "thief sets off from a to b"), (22.0, "thief arrives at b"),
        (23.0, "boy begins screw"), (27.0, "boy finishes screw"),
    ]
    assert told == shown.log
    assert [entry["n"] for entry in told] == [1, 2, 3, 4, 5]


@pytest.mark.parametrize("event", ["_start_", ""])
def test_the_start_is_reported_once_however_the_observer_says_it(event: str) -> None:
    shown = page()
    shown.on_state(at(0, 99.0, status="waiting"), 0.0)
    for stamp in (100.0, 101.0):
        shown.on_state(at(1, stamp, event=event), stamp - 100.0)
    assert [entry["text"] for entry in shown.log] == ["the mission starts"]


def test_the_log_tells_of_holding_of_lost_agents_and_of_new_plans() -> None:
    shown = page()
    shown.on_state(at(1, 100.0, event="_start_"), 0.0)
    shown.on_state(at(2, 101.0, status="holding", reason="bot is lost")._replace(lost=("bot",)), 1.0)
    shown.on_state(at(2, 102.0, status="holding", reason="bot is lost")._replace(lost=("bot",)), 2.0)
    shown.on_state(at(3, 103.0)._replace(lost=("bot",), plan=1), 3.0)
    shown.on_state(at(4, 104.0)._replace(plan=1), 4.0)
    assert [entry["text"] for entry in shown.log[1:]] == [
        "bot counts as lost", "the mission holds: bot is lost", "plan 1 is in force", "the mission goes on",
        "bot is back",
    ]


def test_the_log_has_each_part_of_a_reason_once_while_the_mission_holds() -> None:
    shown = page()
    shown.on_state(at(1, 100.0, event="_start_"), 0.0)
    late, moment = "{bot} is late", 1
    for reason in (f"{late}; looking", f"{late}; no plan; waiting", f"{late}; looking", f"{late}; no plan; waiting"):
        moment += 1
        shown.on_state(at(moment, 100.0 + moment, status="holding", reason=reason), float(moment))
    shown.on_state(at(moment + 1, 110.0), 10.0)
    shown.on_state(at(moment + 2, 111.0, status="holding", reason=late), 11.0)
    assert [entry["text"] for entry in shown.log[1:]] == [
        "the mission holds: bot is late; looking", "the mission holds: no plan; waiting", "the mission goes on",
        "the mission holds: bot is late",
    ]


def test_the_log_says_once_what_the_end_of_the_mission_waits_for() -> None:
    shown = page()
    shown.on_state(at(1, 100.0, event="_start_"), 0.0)
    for stamp in (101.0, 102.0):
        shown.on_state(at(1, stamp, reason="the mission ends as soon as all is answered"), stamp - 100.0)
    assert [entry["text"] for entry in shown.log].count("the mission ends as soon as all is answered") == 1


def test_the_log_keeps_what_is_new() -> None:
    shown = page()
    for number in range(MAX_ENTRIES + 5):
        shown.note(float(number), "x")
    assert len(shown.log) == MAX_ENTRIES
    assert shown.log[-1]["n"] == MAX_ENTRIES + 5


def test_states_of_strangers_do_no_harm() -> None:
    shown = page()
    strange = SystemState(9, 1.0, {"who": "where"}, {"n": 1}, {}, "what", "who")
    assert [entry["text"] for entry in shown.on_state(strange, 3.0)] == ["what"]
    hostile = SystemState(10, 1.0, {"bot": "<script>"}, {"Prule": 0}, dict.fromkeys(MODEL.clocks, 0.0))
    assert agent(view(shown, hostile), "bot")["place"] == ""
