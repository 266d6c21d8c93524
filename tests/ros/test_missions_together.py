"""Two robots ride together: both get the action, and the ride ends when both have reported it, whoever is killed."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import ACTION, PLAYED, launched
from ros_world import Ros, lay_over

from pursue_gen.solving.rules import Rules
from pursue_gen.workspace import Options, write_workspace
from tests.together import HOTEL, scenario, solved

pytestmark = pytest.mark.ros


def test_the_ride_ends_when_both_robots_have_reported_it(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robots, and kills the observer and a controller between their reports."""
    won = solved(HOTEL)
    options = Options(reaction=Rules().reaction)
    folder = write_workspace(scenario(HOTEL), won.network, won.objective, won.strategy, options, tmp_path / "ws")
    robots, calm = ("porter", "waiter"), {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, lay_over(ros, folder), tmp_path, robots, **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        run.until_step("waiter_lobby2lift")
        run.publish("waiter_going_lobby_to_lift2lift")
        ride = run.until_step("ride")
        assert ride["places"]["porter"] == ride["places"]["waiter"] == "doing_ride_in_lift"
        run.until(lambda: {("porter", "ride"), ("waiter", "ride")} <= set(run.orders()))
        run.publish("porter:rideDONE")
        run.until(lambda: run.now().get("finished") == "porter")

        run.until_back("observer", run.kill("observer"))
        run.until_back("controller_waiter", run.kill("controller_waiter"))
        sent = [entry for entry in run.look() if entry["topic"] == ACTION and entry["robot"] == "waiter"]
        run.until(lambda: len([e for e in run.look() if e["topic"] == ACTION and e["robot"] == "waiter"]) > len(sent))
        assert run.orders().count(("waiter", "ride")) == 1, "the same order, sent again"
        now = run.now()
        assert (now.seq, now["finished"], now["places"]["waiter"]) == (ride.seq, "porter", "doing_ride_in_lift")

        run.publish("waiter:rideDONE")
        assert run.until_step("rideDONE")["places"]["waiter"] == "lift"
        run.until_step("waiter_lift2floor")
        run.publish("waiter_going_lift_to_floor2floor")
        served = run.until_step("serve")
        run.publish(f"waiter:_order_@{served.seq}")
        assert run.until_over() == "won", run.output()
        orders = run.orders()
    assert [what for robot, what in orders if robot == "porter"] == ["ride"]
    assert [what for robot, what in orders if robot == "waiter"][-1] == "serve"
