"""A patrol in order on ROS, and answers to where the robot is: the observer sees who arrives and who leaves."""

from __future__ import annotations

from pathlib import Path

import pytest
from launched_mission import PLAYED, launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace

pytestmark = pytest.mark.ros

WATCH = """\
poi "gate"
poi "hall"
connect gate and hall distance 2
agent "bot" controllable mobile 1 location gate
objective: patrol gate, hall in order every 20 by bot
objective: if bot at hall then no robot on_way within 5
objective: if bot on_way then bot at gate within 20
"""


def test_each_visit_counts_and_one_that_is_missed_loses_the_mission(ros: Ros, tmp_path: Path) -> None:
    """The test plays the robot, which arrives twice, and then does not come back in time."""
    read = parse(WATCH, "watch.pur", "watch")
    won = solve_scenario(read, DEFAULT)
    options = Options(reaction=DEFAULT.reaction)
    folder = write_workspace(read, won.network, won.objective, won.strategy, options, tmp_path / "ws")
    calm = {"mode": "still", "on_uncovered": "warn", "lost_after": 1000}
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), **PLAYED, **calm, use_sim_time=True, speed=2) as run:
        assert run.until_step("bot_gate2hall")["places"]["obj"] == "atRisk"
        run.publish("bot_going_gate_to_hall2hall")
        at_hall = run.until_step("bot_going_gate_to_hall2hall")
        assert [at_hall["places"][name] for name in ("obj2", "obj3", "obj4")] == ["idle", "idle", "atRisk"]
        assert run.until_step("bot_hall2gate")["places"]["obj2"] == "atRisk"
        run.publish("bot_going_hall_to_gate2gate")
        there = run.until_step("bot_going_hall_to_gate2gate")
        assert (there.status, there["places"]["obj"], there["places"]["obj4"]) == ("running", "idle", "idle")
        assert run.until_over() == "lost", run.output()
        assert "patrol gate, hall in order every 20 by bot" in run.now()["reason"]
