"""A robot that the goal needs is late: the other one, which has its own work, does it meanwhile."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from launched_mission import ENDED, PLAYED, LaunchedMission, launched
from ros_world import Ros, generated, lay_over
from test_missions_with_blocked_ways import PLANNER

from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

MEET = """
poi "hall"
poi "store"
poi "west"
connect hall and store distance 2
connect hall and west distance 5
event "inspect" location west duration 3
event "load" collaborative together location hall duration 3
agent "bot1" controllable mobile 2 location store can_do load
agent "bot2" controllable mobile 2 location hall can_do inspect reacts_to load
reach_objective: do inspect and load
"""

ENDS = {"going_hall_to_west": 10, "going_west_to_hall": 10, "doing_inspect_in_west": 3, "doing_load_in_hall": 3}
"""When a robot ends what it does, on its clock; bot1 comes to the hall when the test says so."""


def play(run: LaunchedMission, arrives: bool) -> bool:
    """End what is due; True once the mission is over, or bot2 is back at the hall while bot1 is still under way."""
    state = run.now()
    done = [event for event in run.steps() if event in ("inspect", "load")]
    places = state.get("places", {})
    for robot in ("bot1", "bot2"):
        place = places.get(robot, "")
        if place in ENDS and state["clocks"][f"C{robot}"] > ENDS[place] + 0.3:
            does = f"{place.split('_')[1]}DONE" if place.startswith("doing") else f"{robot}_{place}2{place[-4:]}"
            run.publish(f"{robot}:{does}")
    if arrives and places.get("bot1") == "going_store_to_hall":
        run.publish("bot1_going_store_to_hall2hall")
    is_back = places.get("bot2") == "hall" and "inspect" in done and not arrives
    return state.status in ENDED or is_back


def test_the_one_at_its_place_does_its_work_while_the_other_is_late(ros: Ros, tmp_path: Path) -> None:
    (tmp_path / "meet.pur").write_text(MEET)
    meet = lay_over(ros, generated(str(tmp_path / "meet"), tmp_path / "ws", slack={"bot2": 1000}))
    robots = ["bot1", "bot2"]
    with launched(ros, meet, tmp_path, robots, **PLAYED, time_unit=0.5, lost_after=900, planner=PLANNER) as run:
        for arrives in (False, True):
            deadline = time.monotonic() + 2 * PATIENCE
            while not play(run, arrives):
                assert time.monotonic() < deadline, f"{run.now()}\n{run.steps()}\n{run.output()[-6000:]}"
                time.sleep(0.05)
            if not arrives:
                state = run.now()
                assert (state.status, state["places"]["bot1"]) == ("running", "going_store_to_hall"), state
                assert state["late"] == "bot1" and "plan" in state
        assert run.until_over() == "won", run.output()
    assert not [state for state in run.states() if state.status == "holding"], "nobody was held up"
    assert re.search(r"plan \d+ relies on bot1, which is late, until it counts as lost", run.output())
