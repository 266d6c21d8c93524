"""The node that shows a mission in rviz."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Callable

import pytest
from ros_world import PUBLISH_EVENT, Ros, end

from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

SOURCE = "source devel/setup.bash; exec"
WAITING = 'text: "scenario_1: waiting"'


def test_the_map_and_the_state_are_latched_on_pursue_markers_and_what_is_missing_is_named(
    ros: Ros, built: Build, tmp_path: Path
) -> None:
    workspace = built("thesis/scenario_1")
    found = ros.run("python3 -c 'import visualization_msgs.msg'", workspace)
    if found.returncode:
        pytest.skip("no visualization_msgs here")
    (tmp_path / "visualization_msgs.py").write_text("raise ImportError('not installed')\n")
    shown = tmp_path / "shown"

    def until(text: str, behind: str) -> None:
        deadline = time.monotonic() + PATIENCE
        while text not in shown.read_text().partition(behind)[2] and time.monotonic() < deadline:
            time.sleep(0.2)

    with ros.master() as there:
        commands = {"observer": "rosrun observer observer", "markers": "rosrun UI markers"}
        commands["shown"] = "rostopic echo /pursue/markers"
        nodes = [
            ros.start(f"{SOURCE} {command}", workspace, tmp_path / name, **there) for name, command in commands.items()
        ]
        try:
            until("---", WAITING)
            ros.run(f"python3 {PUBLISH_EVENT} _start_", workspace, **there)
            until('ns: "next"', WAITING)  # by the strategies of all controllers, which are not there
            lacking = f"export PYTHONPATH={tmp_path}:$PYTHONPATH; exec rosrun UI markers __name:=lacking"
            done = ros.run(f"source devel/setup.bash; {lacking}", workspace, **there)
        finally:
            for node in nodes:
                end(node)
    first, *others = shown.read_text().split("action: 3")[1:]  # it removes what was shown before
    last = next((each for each in [first, *others] if WAITING in each), "")
    assert last, (tmp_path / "markers").read_text()
    assert any('ns: "next"' in each and "next: go to b" in each for each in others), shown.read_text()[-2000:]
    assert all(f'ns: "{group}"' in last for group in ("places", "labels", "ways", "agents", "names"))
    assert done.returncode == 3 and "needs the ROS package visualization_msgs, which is not here" in done.stdout
