"""ROS for the tests: a clean environment, workspaces, a master of one's own, processes that end with the test."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Dict, Iterator, List

from pursue_gen.language import load
from pursue_gen.pipeline import IDEAL, Rules, solve_scenario
from pursue_gen.workspace import Options, write_workspace

SCENARIOS = Path(__file__).resolve().parent.parent.parent / "scenarios"
NEEDED = ("catkin_make", "catkin_test_results", "roscore", "roslaunch", "rosrun", "rostest")


def _setup() -> str:
    """What a user of ROS sources first; Debian's own packages need nothing."""
    for distribution in ("noetic", "one"):
        if Path(f"/opt/ros/{distribution}/setup.bash").is_file():
            return f"source /opt/ros/{distribution}/setup.bash; "
    return ""


def _environment(home: Path) -> Dict[str, str]:
    """Only what a fresh terminal has: other Pythons on PATH break catkin, variables of other masters the rest."""
    own = Path(sys.prefix) / "bin"  # a virtual environment made by the system's Python may hold `transitions`
    first = [str(own)] if sys.base_prefix == "/usr" and sys.prefix != "/usr" else []
    path = ":".join([*first, "/usr/local/bin", "/usr/bin", "/bin"])
    return {"PATH": path, "HOME": str(home), "LANG": "C.UTF-8", "ROS_LOG_DIR": str(home / "log"), "ROS_IP": "127.0.0.1"}


class Ros:
    """Commands in that environment, and masters."""

    def __init__(self, home: Path) -> None:
        self.home = home
        self.environment = _environment(home)

    def start(self, command: str, folder: Path, log: Path, **more: str) -> "subprocess.Popen[bytes]":
        """Starts a shell command in a session of its own; what it says goes to the log."""
        with open(log, "wb") as out:
            return subprocess.Popen(
                ["bash", "-c", _setup() + command],
                cwd=folder,
                env={**self.environment, **more},
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )

    def run(self, command: str, folder: Path, timeout: float, **more: str) -> "subprocess.CompletedProcess[str]":
        """Runs a shell command to its end; at the timeout it is killed with all its children, and the test fails."""
        with tempfile.TemporaryDirectory() as place:
            log = Path(place) / "log"
            process = self.start(command, folder, log, **more)
            try:
                status = process.wait(timeout)
            except subprocess.TimeoutExpired:
                said = log.read_text(errors="replace")
                raise AssertionError(f"{command}: not done after {timeout} s:\n{said[-8000:]}") from None
            finally:
                end(process)
            return subprocess.CompletedProcess(command, status, log.read_text(errors="replace"))

    @contextlib.contextmanager
    def master(self) -> Iterator[Dict[str, str]]:
        """A roscore on a free port; the variables that lead to it."""
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        there = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}"}
        core = self.start(f"exec roscore -p {port}", self.home, self.home / f"roscore-{port}.log", **there)
        try:
            deadline = time.monotonic() + 30
            while self.run("rosparam get /run_id", self.home, 30, **there).returncode:
                assert time.monotonic() < deadline, "roscore does not come up"
            yield there
        finally:
            end(core)


def end(process: "subprocess.Popen[bytes]") -> None:
    """Ends a process and its children: politely, then not."""
    for sign, patience in ((signal.SIGINT, 10), (signal.SIGTERM, 5), (signal.SIGKILL, 5)):
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, sign)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(patience)
            return


def generated(name: str, folder: Path, controllers: str = "distributed") -> Path:
    """Writes the workspace of scenarios/<name>.pur; a general controller plays the ideal game, as in the original."""
    scenario = load(str(SCENARIOS / f"{name}.pur"))
    rules = IDEAL if controllers == "general" else Rules()
    won = solve_scenario(scenario, rules)
    options = Options(controllers=controllers, reaction=rules.reaction)
    return write_workspace(scenario, won.network, won.objective, won.strategy, options, folder)


def make(ros: Ros, workspace: Path, *targets: str) -> Path:
    """Builds it with catkin_make."""
    done = ros.run(f"catkin_make {' '.join(targets)}", workspace, 300)
    assert done.returncode == 0, done.stdout
    return workspace


def judged(ros: Ros, workspace: Path) -> List[str]:
    """Runs the workspace's own launch tests; the results that catkin_test_results found, all of them good."""
    done = ros.run("catkin_make run_tests", workspace, 900)
    verdict = ros.run("catkin_test_results --verbose --all build/test_results", workspace, 60)
    assert verdict.returncode == 0, f"{verdict.stdout}\n{done.stdout[-20000:]}"
    return verdict.stdout.splitlines()
