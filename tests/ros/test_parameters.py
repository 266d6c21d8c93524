"""A node with a parameter that cannot be says which, and exits with status 3 before it does anything."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import Callable

import pytest
from ros_world import Ros, end

from tests.waiting import PATIENCE

pytestmark = pytest.mark.ros

ABOVE, LEAST = "expected a number greater than 0", "expected a number of at least 0"
WRONG = {
    "observer observer _time_unit:=0": f"~time_unit is 0; {ABOVE}",
    "observer observer _time_unit:=text": f"~time_unit is 'text'; {ABOVE}",
    "observer observer _on_uncovered:=nonsense": "~on_uncovered is 'nonsense'; expected one of plan, stop, warn",
    "observer observer _heartbeat:=-1": f"~heartbeat is -1; {ABOVE}",
    "observer observer _linger:=-1": f"~linger is -1; {LEAST}",
    "controller_bot1 controller_bot1 _again:=perhaps": "~again is 'perhaps'; expected true or false",
    "UI simulator _delays:=never": "~delays is 'never'; expected one of ",
    "UI sim_clock _speed:=0": f"~speed is 0; {ABOVE}",
    "UI recorder _received:=7": "~received is 7; expected true or false",
    "observer observer --plan=off": "unrecognized arguments: --plan=off",
    "observer observer --planner=": "--planner is ''; expected a command, or off",
    "pursue_reader pursue_reader _keep:=0": "~keep is 0; expected a whole number of at least 1",
    "communication_manager communication_manager --port=70000": "--port is '70000'; expected a whole number",
}  # fmt: skip


def test_a_parameter_that_cannot_be_is_refused_with_status_3(
    ros: Ros, built: Callable[..., Path], tmp_path: Path
) -> None:
    workspace = built("thesis/scenario_1")
    home = {"ROS_HOME": str(tmp_path / "home")}
    with ros.master() as there, contextlib.ExitStack() as cleanup:
        for number, (command, message) in enumerate(WRONG.items()):
            package, program, parameter = command.split()
            # Parameters stay with their master: each node has a name of its own.
            line = f"exec src/{package}/scripts/{program} {parameter} __name:=node{number}"
            log = tmp_path / str(number)
            node = ros.start(f"source devel/setup.bash; {line}", workspace, log, **there, **home)
            cleanup.callback(end, node)
            assert node.wait(PATIENCE) == 3, (command, log.read_text())
            assert message in log.read_text() and "Traceback" not in log.read_text(), (command, log.read_text())
