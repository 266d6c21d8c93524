"""The timeline on the page: what each agent did from when to when."""

from __future__ import annotations

import json
from typing import Any

from pursue_runtime.model import Model
from pursue_runtime.state import SystemState
from pursue_runtime.ui.lanes import MOST, Lanes
from pursue_runtime.ui.promise import Objective, Promise
from tests.runtime.models import model_data, mover, state, worker

MODEL = Model(model_data(mover("bot", "robot", 9), worker("nurse", "human")))


def at(seq: int, status: str = "running", **locations: str) -> Any:
    return state(MODEL, seq, 100.0 + seq, dict.fromkeys(MODEL.clocks, 1.0), status=status, **locations)


def test_each_agent_has_a_lane_of_what_it_did_from_when_to_when() -> None:
    lanes = Lanes(MODEL)
    for seen, moment in (
        (at(0, "waiting"), 0.0), (at(1), 0.0), (at(2, bot="going_a_to_b"), 2.0), (at(2, bot="going_a_to_b"), 3.0),
        (at(3, bot="going_a_to_b", nurse="doing_screw_in_s"), 5.0), (at(4, bot="b", nurse="doing_screw_in_s"), 11.5),
    ):
        lanes.on_state(seen, moment)
        assert lanes.shown() is None, "while the mission goes on the map shows it"
    lanes.on_state(at(5, "won", bot="b"), 13.0)
    lanes.on_state(at(5, "won", bot="b"), 14.0)
    shown = lanes.shown()
    assert shown == {"begins": 0.0, "ends": 13.0, "lanes": [
        {"agent": "bot", "segments": [[0.0, "stands", "a"], [2.0, "moves", "a → b"], [11.5, "stands", "b"]]},
        {"agent": "nurse", "segments": [[0.0, "stands", "s"], [5.0, "acts", "screw at s"], [13.0, "stands", "s"]]},
    ]}
    json.dumps(shown)


def test_each_objective_has_a_lane_of_when_something_was_due() -> None:
    guard = {
        "name": "obj", "kind": "safety", "initial": "idle", "edges": [],
        "locations": {"idle": [], "atRisk": ["Cobj <= 40"], "lose": []},
    }  # fmt: skip
    data = model_data(mover("bot", "robot", 9), guard)
    data["clocks"].append("Cobj")
    data["objective"] = {"kind": "safety", "goal": None, "bad": ["obj", "lose"]}
    model = Model(data)
    given = (Objective("Whenever call happens, look happens.", ("obj",), name="look"), Objective("Optional.", ()))
    lanes = Lanes(model, Promise(given))
    for seq, (there, clock, moment) in enumerate(
        (("idle", 0.0, 0.0), ("atRisk", 0.0, 5.0), ("atRisk", 2.0, 7.0), ("idle", 9.0, 12.0), ("lose", 9.0, 60.0)), 1
    ):
        lanes.on_state(state(model, seq, 100.0 + moment, {"Cobj": clock}, obj=there), moment)
    lanes.on_state(state(model, 6, 161.0, {}, status="lost", obj="lose"), 61.0)
    shown = lanes.shown()
    assert shown is not None and [lane.get("promise") for lane in shown["lanes"]] == [None, "look"]
    assert shown["lanes"][1]["segments"] == [
        [0.0, "stands", "kept"], [5.0, "due", "due by 45.0"], [12.0, "stands", "kept"], [60.0, "broken", "broken"],
    ]  # fmt: skip


def test_a_mission_that_never_began_has_none_and_one_seen_late_begins_where_it_was_seen() -> None:
    lanes = Lanes(MODEL)
    lanes.on_state(at(7, bot="going_a_to_b"), 30.0)
    lanes.on_state(at(8, "stopped", bot="going_a_to_b"), 31.0)
    shown = lanes.shown()
    assert shown is not None and (shown["begins"], shown["ends"]) == (30.0, 31.0)
    never = Lanes(MODEL)
    never.on_state(at(0, "waiting"), 0.0)
    assert never.shown() is None


def test_a_lane_is_limited_and_states_of_strangers_do_no_harm() -> None:
    lanes = Lanes(MODEL)
    for number in range(2 * MOST):
        lanes.on_state(at(number, bot="a" if number % 2 else "b"), float(number))
    lanes.on_state(SystemState(9999, 1.0, {"who": "where"}, {}, {}, status="stopped"), 2.0 * MOST)
    shown = lanes.shown()
    assert shown is not None and max(len(lane["segments"]) for lane in shown["lanes"]) == MOST
