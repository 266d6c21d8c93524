"""Signals to the UI alone, and to nodes that start; and how a launch ends: nothing that looks like a failure."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from pathlib import Path
from typing import Callable, List

import pytest
from launched_mission import launched
from ros_world import Ros

from pursue_runtime.ui.verdict import read_verdict
from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

INTERRUPTED_AT = """
import os, runpy, signal, sys
script, moment, sign = sys.argv[1], sys.argv[2], int(sys.argv[3])
sys.argv = [script, *sys.argv[4:]]
calls = 0

def count(frame, event, _):
    global calls
    calls += event == "call"
    if moment in (str(calls), frame.f_code.co_name):
        sys.setprofile(None)
        os.kill(os.getpid(), sign)

sys.setprofile(count)
runpy.run_path(script, run_name="__main__")
"""
"""A node that gets a signal at this call of a function, by its number or the function's name."""

MOMENTS = ("3000", "start_node", "start_node", "10000", "30000", "get_param", "100000")
"""From the first imports over rospy's init_node to when the node is ready; every second one is SIGTERM. Those that do
not come so far are interrupted then."""


@pytest.fixture(scope="module")
def scenario(built: Build) -> Path:
    """The workspace."""
    return built("thesis/scenario_1")


@pytest.mark.parametrize("sign", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_a_signal_to_the_ui_alone_leaves_the_mission_to_go_on(
    ros: Ros, scenario: Path, tmp_path: Path, sign: signal.Signals
) -> None:
    verdict = tmp_path / "verdict"
    with launched(ros, scenario, tmp_path, use_sim_time=True, speed=3, verdict=str(verdict)) as run:
        run.until_step("bot1_c2b")
        process = run.kill("UI", sign)
        run.until_back("UI", process)
        assert run.until_over() == "won", run.output()
    assert (read_verdict(str(verdict)) or ("", ""))[0] == "won"
    assert run.crashes() == [], run.output()


def test_a_launch_whose_mission_is_won_ends_by_itself_and_says_nothing_of_failures(
    ros: Ros, scenario: Path, tmp_path: Path
) -> None:
    with launched(ros, scenario, tmp_path, use_sim_time=True, speed=10) as run:
        assert run.until_over() == "won" and run.launch is not None
        assert run.launch.wait(PATIENCE) == 0
    assert "The goal is reached" in run.output()
    assert not re.search(r"REQUIRED|has died|\x1b\[31m|Traceback|[Ee]rror", run.output()), run.output()


@pytest.mark.parametrize("node", ["observer", "controller_bot1", "UI", "simulator"])
def test_a_node_that_is_interrupted_while_it_starts_prints_no_traceback(
    ros: Ros, scenario: Path, tmp_path: Path, node: str
) -> None:
    package = "UI" if node == "simulator" else node
    (script,) = (scenario / "src" / package / "scripts").glob(node)
    program = tmp_path / "interrupted_at.py"
    program.write_text(INTERRUPTED_AT)
    with ros.master() as there:
        started: List["subprocess.Popen[bytes]"] = []
        for number, moment in enumerate(MOMENTS):
            sign = (signal.SIGINT, signal.SIGTERM)[number % 2]
            command = f"exec python3 {program} {script} {moment} {sign:d} __name:={node}_{number}"
            command = f"source devel/setup.bash; {command}"
            home = str(tmp_path / "home")
            started.append(ros.start(command, scenario, tmp_path / f"{number}.log", ROS_HOME=home, **there))
        deadline = time.monotonic() + 15.0
        while any(process.poll() is None for process in started) and time.monotonic() < deadline:
            time.sleep(0.1)
        for process in started:
            if process.poll() is None:
                os.kill(process.pid, signal.SIGINT)
        for process in started:
            process.wait(PATIENCE)
    for number, moment in enumerate(MOMENTS):
        output = (tmp_path / f"{number}.log").read_text(errors="replace")
        assert "Traceback" not in output, (moment, output)
