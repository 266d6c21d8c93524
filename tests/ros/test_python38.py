"""Nodes run under Python 3.8, that of ROS Noetic, with the oldest packages that do."""

from __future__ import annotations

import os
from functools import partial
from pathlib import Path
from typing import Callable, Dict

import pytest
from launched_mission import launched
from ros_world import Ros

from pursue_runtime.needs import PYYAML
from tests.python38 import ros_for_it

pytestmark = pytest.mark.ros

NODES = ("observer", "controller_bot1", "controller_bot2", "controllerObj", "simulator", "UI", "sim_clock")


class Ros38(Ros):
    """ROS whose nodes find a Python 3.8 first; its own programs name the system's."""

    python, modules = "", Path()

    def for_missions(self, workspace: Path) -> Dict[str, str]:
        """The variables for missions of a workspace."""
        found = super().for_missions(workspace)
        path, modules = f"{Path(self.python).parent}:{found['PATH']}", f"{found['PYTHONPATH']}:{self.modules}"
        return {**found, "PATH": path, "PYTHONPATH": modules}


@pytest.fixture
def ros38(ros: Ros, python38: str) -> Ros38:
    """The same ROS, for nodes under Python 3.8, which start as a user's do."""
    found = Ros38(ros.home, ros.shared)
    found.python, found.modules = python38, ros_for_it()
    return found


def test_a_mission_is_won_by_nodes_under_python_38(ros38: Ros38, built: Callable[..., Path], tmp_path: Path) -> None:
    """What they import beside ROS is as old as can be; in the system's folder of modules it is newer."""
    workspace = built("thesis/scenario_1")
    version = ros38.run("source devel/setup.bash; python3 -c 'import yaml; print(yaml.__version__)'", workspace)
    assert version.stdout.strip() == PYYAML.oldest
    options = {"use_sim_time": True, "speed": 4, "autostart": False}
    with launched(ros38, workspace, tmp_path, **options) as run:
        run.until(lambda: "All nodes are ready" in run.output())
        programs = {node: os.readlink(f"/proc/{run.until(partial(run.pid, node))}/exe") for node in NODES}
        assert set(programs.values()) == {os.path.realpath(ros38.python)}, programs
        run.publish("_start_")
        assert run.until_over() == "won", run.output()
        assert run.crashes() == []
