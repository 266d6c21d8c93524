"""`rosrun <scenario>_bringup run_mission` on ROS: the verdict is its exit status, and no process remains."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import time
from pathlib import Path
from typing import Callable, List, Tuple
from xmlrpc.client import ServerProxy

import pytest
from ros_world import Ros, end

from tests.waiting import PATIENCE

Build = Callable[..., Path]

pytestmark = pytest.mark.ros

COMMAND = "source devel/setup.bash; exec rosrun scenario_1_bringup run_mission"


def last_line(log: Path) -> str:
    return log.read_text(errors="replace").rstrip().rpartition("\n")[2]


def remaining(home: Path) -> List[str]:
    """The processes that were started with this ROS_HOME, and have not ended."""
    found, mark = [], f"ROS_HOME={home}".encode()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if mark in (process / "environ").read_bytes().split(b"\0"):
                found.append((process / "cmdline").read_text().replace("\0", " "))
        except OSError:
            continue  # it has ended meanwhile
    return found


def gone(home: Path) -> bool:
    """Waits until no process is left."""
    deadline = time.monotonic() + PATIENCE
    while remaining(home):
        if time.monotonic() > deadline:
            return False
        time.sleep(0.1)
    return True


@pytest.mark.parametrize("arguments, status, line", [
    ("mode:=trace trace:=/none.yaml", 3, r"not started: cannot read the trace /none\.yaml: .*"),
    ("nodes:=UI wait:=1", 3, r"not started: Not ready after 1 s: observer, .* The mission was not started\."),
    ("time_unit:=0 wait:=1", 3, r"not started: Not ready after 1 s: observer, .* The mission was not started\."),
    ("nodes:=nobody,UI", 5, r"launch failed: roslaunch exited with status 1, and the UI has given no verdict\."),
    ("again:=true", 5, "launch failed: again is not an argument here: one mission is played"),
])  # fmt: skip
def test_a_mission_that_does_not_begin_has_a_status_of_its_own(
    ros: Ros, built: Build, tmp_path: Path, arguments: str, status: int, line: str
) -> None:
    log = tmp_path / "log"
    with ros.master() as there:
        process = ros.start(f"{COMMAND} {arguments}", built("thesis/scenario_1"), log, ROS_HOME=str(tmp_path), **there)
        try:
            assert process.wait(2 * PATIENCE) == status, log.read_text(errors="replace")[-6000:]
        finally:
            end(process)
    assert re.fullmatch(line, last_line(log)), last_line(log)
    assert gone(tmp_path)


def test_a_mission_that_is_stopped_has_status_2_and_the_reason(ros: Ros, built: Build, tmp_path: Path) -> None:
    log, workspace = tmp_path / "log", built("thesis/scenario_1")
    with ros.master() as there:
        process = ros.start(f"{COMMAND} time_unit:=3", workspace, log, ROS_HOME=str(tmp_path), **there)
        try:
            until_it_runs(log)
            ros.run("rostopic pub -1 pursue/events std_msgs/String _stop_", workspace, **there)
            assert process.wait(2 * PATIENCE) == 2, log.read_text(errors="replace")[-6000:]
        finally:
            end(process)
    assert re.fullmatch(r"stopped: The mission was stopped, after .*: _stop_ was published\.", last_line(log))
    assert gone(tmp_path)


@pytest.mark.parametrize("sign", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_the_launch_with_its_master_and_no_process_remains(
    ros: Ros, built: Build, tmp_path: Path, sign: signal.Signals
) -> None:
    process, log, _ = with_own_master(ros, built("thesis/scenario_1"), tmp_path, "time_unit:=3")
    try:
        until_it_runs(log)
        os.kill(process.pid, sign)
        assert process.wait(2 * PATIENCE) == 4, log.read_text(errors="replace")[-6000:]
    finally:
        end(process)
    assert last_line(log) == f"interrupted: {sign.name} was received before the mission ended."
    assert gone(tmp_path)
    assert not re.search("ROS master (is gone|was started)|Traceback", log.read_text(errors="replace"))


def test_a_mission_whose_master_is_lost_has_status_2_and_the_reason(ros: Ros, built: Build, tmp_path: Path) -> None:
    process, log, master = with_own_master(ros, built("thesis/scenario_1"), tmp_path, "time_unit:=3")
    try:
        until_it_runs(log)
        os.kill(ServerProxy(master).getPid("/test")[2], signal.SIGKILL)  # type: ignore[index]
        assert process.wait(2 * PATIENCE) == 2, log.read_text(errors="replace")[-6000:]
    finally:
        end(process)
    assert last_line(log) == "stopped: The mission cannot go on: the ROS master is gone."
    assert gone(tmp_path)


def with_own_master(
    ros: Ros, workspace: Path, folder: Path, arguments: str
) -> "Tuple[subprocess.Popen[bytes], Path, str]":
    """run_mission with no master there, the file of its output, and the address of the master that it has brought."""
    command = f"{COMMAND} wait:={PATIENCE:g} {arguments}"
    process, there = ros.start_with_master(command, workspace, folder / "log", ROS_HOME=str(folder))
    return process, folder / "log", there["ROS_MASTER_URI"]


def until_it_runs(log: Path) -> None:
    """Waits until the first robot has set out."""
    deadline = time.monotonic() + PATIENCE
    while not re.search(r"\d\.\d  bot1 sets off from c to b", log.read_text(errors="replace") if log.exists() else ""):
        assert time.monotonic() < deadline, log.read_text(errors="replace")[-6000:]
        time.sleep(0.05)
