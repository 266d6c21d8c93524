"""The page and the terminal say who waits for which door or lift, and who rides in one."""

from __future__ import annotations

from typing import Any, Dict

from pursue_runtime.doors.opened import Opened
from pursue_runtime.model import Model
from pursue_runtime.state import LOST, RUNNING, SystemState
from pursue_runtime.ui.environment import TraceEnvironment
from pursue_runtime.ui.mission_view import MissionView
from pursue_runtime.ui.page import Facts, FloorPlan, Page
from pursue_runtime.ui.waits import AtDoors
from tests.runtime import models
from tests.runtime.models import model_data, mover

UP = "going_h0_to_h1"
LIFT = {"within": 40, "takes": 20, "floors": ["h0", "h1"], "rides": {"bot": {UP: ["h0", "h1"]}}}
DOOR = {"within": 8, "asked_by": {"bot": ["going_a_to_b"]}}
SETTINGS: Dict[str, Any] = {"doors": {"d1": DOOR}, "lifts": {"l1": LIFT}}


def at_doors() -> AtDoors:
    return AtDoors(SETTINGS, lambda name: {"l1": "the lift"}.get(name, name))


def state(location: str, status: str = RUNNING) -> SystemState:
    return SystemState(3, 0.0, {"bot": location}, {}, {}, status=status, mission="m")


def opened(*gates: str) -> Opened:
    return Opened("m", 3, {gate: frozenset({"bot"}) for gate in gates})


def test_a_robot_waits_for_a_door_until_it_is_open_for_it() -> None:
    there = at_doors()
    assert there.says(state("going_a_to_b")) == {"bot": "waits for d1 to open"}
    there.take(opened("d1"))
    assert there.says(state("going_a_to_b")) == {} == there.says(state("a"))


def test_it_waits_for_a_lift_gets_in_rides_and_gets_out() -> None:
    there = at_doors()
    said = []
    for gates in ((), ("l1 at h0",), (), ("l1 at h1",)):
        there.take(opened(*gates))
        said.append(there.says(state(UP))["bot"])
    assert said == ["waits for the lift", "gets into the lift", "rides in the lift", "gets out of the lift"]
    there.take(opened())
    assert there.says(state("h1")) == {} and there.says(state(UP)) == {"bot": "waits for the lift"}


def test_the_page_and_the_progress_line_say_it() -> None:
    model = Model(model_data(mover("bot", "robot", 9)))
    ride = {**LIFT, "floors": ["a", "b"], "rides": {"bot": {"going_a_to_b": ["a", "b"]}}}
    there = AtDoors({"lifts": {"l1": ride}}, str)
    now = models.state(model, 2, 1.0, {}, bot="going_a_to_b")
    seen = Page(model, FloorPlan({}, ()), at_doors=there).view(Facts("running", (), now, 1.0, 1.0))
    assert seen["agents"][0]["notes"] == ["waits for l1"]
    view = MissionView(model, TraceEnvironment(()), at_doors=there)
    view.on_state(now, 1.0)
    assert "(waits for l1)" in view.progress(1.0)


def test_nothing_is_said_when_the_mission_is_over_or_without_doors() -> None:
    assert at_doors().says(state(UP, LOST)) == {}
    assert at_doors().has_some and not AtDoors({}, str).has_some
