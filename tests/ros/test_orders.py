"""A mission on ROS is not won before the robot's side has acknowledged what it was ordered to do."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest
from launched_mission import launched
from ros_world import Ros, lay_over

from pursue_gen.language import parse
from pursue_gen.solving.rules import DEFAULT
from pursue_gen.solving.solution import solve_scenario
from pursue_gen.workspace import Options, write_workspace
from pursue_runtime.orders import parse_order

pytestmark = pytest.mark.ros

BELL = """\
poi "desk"
poi "door"
connect desk and door distance 2
event "ring" location desk
agent "bot" controllable mobile 1 location desk can_do ring
reach_objective: do ring after 4
"""


def test_no_mission_is_won_whose_robot_was_never_told(ros: Ros, tmp_path: Path) -> None:
    """The robot's side does not answer when the order is due; then the controller is killed, and only then it does."""
    read = parse(BELL, "bell.pur", "bell")
    won = solve_scenario(read, DEFAULT)
    folder = write_workspace(
        read, won.network, won.objective, won.strategy, Options(reaction=DEFAULT.reaction), tmp_path / "ws"
    )
    with launched(ros, lay_over(ros, folder), tmp_path, ("bot",), silence=600) as run:
        run.until(lambda: run.now().status == "running")
        simulator = run.kill("simulator", signal.SIGSTOP)
        run.until_step("ring")
        state = run.now()
        order = parse_order(state["orders"])
        assert (state.status, state["places"]["reachObj"]) == ("running", "win")
        assert order is not None and (order.agent, order.event, order.at_once) == ("bot", "ring", True)
        before = run.kill("controller_bot")
        run.until(lambda: run.pid("controller_bot") not in (0, before))
        assert run.now().status == "running"
        os.kill(simulator, signal.SIGCONT)
        assert run.until_over() == "won", run.output()
        assert run.orders() == [("bot", "ring")]
