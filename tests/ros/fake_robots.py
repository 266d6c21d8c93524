"""Missions with fake robots that drive, stand and fail as those of move_base."""

from __future__ import annotations

import contextlib
import json
import math
import re
import subprocess
import time
from collections import Counter
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple
from xmlrpc.client import ServerProxy

import pytest
import yaml
from ros_world import Ros, end, generated, lay_over

from tests.waiting import PATIENCE

FAKE = Path(__file__).resolve().parent / "fake_move_base.py"
PUBLISHER = FAKE.with_name("publisher.py")
UNIT = 0.2
"""Seconds per time unit: a movement takes 1.8 to 2 s, bot1_inb 0.6 to 0.8 s, bot2_ina 1.2 to 1.4 s."""

SLACK = 100
"""Time units by which the robots may be late in their model: they move in real time, and a machine may stand still."""

TOLERANCE = 0.6
"""Metres from a place at which a robot is there: ~end_tolerance, and what it may move before amcl publishes again."""

ACTS = {"bot1": 3.5 * UNIT, "bot2": 6.5 * UNIT}
"""Seconds that a robot's action takes, if it has one; a partner does not report the end."""

POSES = "src/controller_bot*/config/poses.yaml"

LAUNCH = f"mission.launch simulate:=false time_unit:={UNIT} tolerance:=0.5"


def robots_workspace(ros: Ros, scenario: str, robots: Sequence[str]) -> Path:
    """The workspace of a scenario whose robots may be late, built once in a session; skips the test where move_base's
    messages are missing.

    A person has written down the poses: each place has an orientation, along the x axis.
    """
    wanted = "move_base_msgs.msg, actionlib_msgs.msg, tf2_ros"
    found = ros.run(f"python3 -c 'import {wanted}'", ros.home)
    if found.returncode:
        pytest.skip(f"no messages of move_base here: {found.stdout.strip().splitlines()[-1]}")

    def build(folder: Path) -> None:
        workspace = generated(scenario, folder, slack=dict.fromkeys(robots, SLACK))
        for file in workspace.glob(POSES):
            text, count = re.subn(r"(, 0\.0, 0\.0, 0\.0), 0\.0\]", r"\1, 1.0]", file.read_text())
            assert count == 3, text
            file.write_text(text)
        lay_over(ros, workspace)

    return ros.once(f"{Path(scenario).name}_of_robots", build)


class Robots:
    """Fake robots at the initial point c of the scenario, and what they have heard."""

    def __init__(self, ros: Ros, workspace: Path, logs: Path, there: Dict[str, str], **more: Dict[str, Any]) -> None:
        files = {str(file.parent.parent.name)[len("controller_"):]: file for file in workspace.glob(POSES)}
        poses = {bot: yaml.safe_load(file.read_text())["poses"] for bot, file in files.items()}
        usual = {"travel": 9.5 * UNIT}
        robots = {
            name: {"start": own["c"][:2], "acts": ACTS.get(name, -1.0), **usual, **more.get(name, {})}
            for name, own in poses.items()
        }
        self.log = logs / "robots"
        self.poses = [(poi, x, y) for own in poses.values() for poi, (x, y, *_) in own.items()]
        self._ros, self._workspace, self._there = ros, workspace, there
        self.goals = {f"{x:.2f} {y:.2f}": poi for poi, x, y in self.poses}
        with ServerProxy(there["ROS_MASTER_URI"]) as master:
            assert master.setParam("/test", "/fake_move_base/robots", robots)[0] == 1  # type: ignore[index]
        self.process = ros.start(f"exec python3 {FAKE}", workspace, self.log, **there)
        self._publisher: "Optional[subprocess.Popen[str]]" = None

    def heard(self, robot: str) -> List[str]:
        """What this robot has heard, goals by their names."""
        told = re.findall(rf"^{robot} (goal|lost|cancel|action) ?(.*)$", self.log.read_text(), re.MULTILINE)
        return [f"{what} {self.goals.get(detail, detail.split(' ')[0])}".strip() for what, detail in told]

    def publish(self, topic: str, kind: str, message: str) -> None:
        """Publishes a message (in YAML), as a person does, to all that are subscribed."""
        if self._publisher is None:
            environment = {**self._ros.sourced(self._workspace / "devel/setup.bash"), **self._there}
            self._publisher = subprocess.Popen(
                ["python3", str(PUBLISHER)], env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
            )
        line = json.dumps([topic, kind, message]) + "\n"
        assert self._publisher.stdin is not None and self._publisher.stdout is not None
        self._publisher.stdin.write(line)
        self._publisher.stdin.flush()
        assert self._publisher.stdout.readline() == line

    def end(self) -> None:
        """Ends their processes."""
        end(self.process)
        if self._publisher is not None:
            self._publisher.kill()
            self._publisher.communicate()

    def order(self, robot: str, what: str) -> None:
        """Has the robot do this, for the test."""
        self.publish(f"{robot}/test", "std_msgs/String", f"'{what}'")
        found = re.compile(rf"^{robot} test {re.escape(what)}$", re.MULTILINE)
        wait_for(lambda: bool(found.search(self.log.read_text())), self.log, f"{robot} does not {what}")

    def at(self, robot: str) -> Tuple[float, float]:
        """Where it stopped last, by its own account."""
        told = re.findall(rf"^{robot} stands (\S+) (\S+)$", self.log.read_text(), re.MULTILINE)
        return tuple(map(float, told[-1])) if told else (math.inf, math.inf)  # type: ignore[return-value]

    def actions(self, robot: str) -> List[str]:
        """The actions that it was told, and at which place it was then (by the tolerance of a position)."""
        told = re.findall(rf"^{robot} action (\w+) (\S+) (\S+)$", self.log.read_text(), re.MULTILINE)
        return [f"{action} at {self.place(float(x), float(y))}" for action, x, y in told]

    def place(self, x: float, y: float) -> str:
        """The place within the tolerance of this position."""
        near = [poi for poi, px, py in self.poses if math.hypot(px - x, py - y) <= TOLERANCE]
        return near[0] if near else f"{x} {y}"


@contextlib.contextmanager
def playing(ros: Ros, workspace: Path, logs: Path, arguments: str, **robots: Dict[str, Any]) -> Iterator[Any]:
    """A mission with fake robots: (robots, what roslaunch says, its process)."""
    bringup = next((workspace / "src").glob("*_bringup")).name
    with ros.master() as there:
        fakes = Robots(ros, workspace, logs, there, **robots)
        command = f"source devel/setup.bash; exec roslaunch {bringup} {LAUNCH} {arguments}"
        mission = ros.start(command, workspace, logs / "launch", **there)
        try:
            yield fakes, logs / "launch", mission
        finally:
            end(mission)
            fakes.end()


def played(ros: Ros, workspace: Path, logs: Path, arguments: str, **robots: Dict[str, Any]) -> Any:
    """Plays it to its end: (robots, what was said)."""
    with playing(ros, workspace, logs, arguments, **robots) as (fakes, log, mission):
        deadline = time.monotonic() + 2 * PATIENCE
        while mission.poll() is None and time.monotonic() < deadline:
            time.sleep(0.1)
    return fakes, log.read_text()


def wait_for(condition: Callable[[], bool], log: Path, what: str) -> None:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline, f"{what}; it was said:\n{log.read_text()[-8000:]}"
        time.sleep(0.05)


def well(said: str) -> None:
    """The goal was reached, each end counted once, and none was told where it cannot be; but one that is not answered
    for half a second, on a busy machine, is told again."""
    assert "The goal is reached" in said, said[-8000:]
    assert not re.search(r'File ".*/controller_\w+/scripts/', said), said[-8000:]
    again = {word for word, times in Counter(re.findall(r"reports (\w+)", said)).items() if times > 1}
    assert set(re.findall(r"(\S+): it cannot happen", said)) <= again, said[-8000:]
    for word in ("bot1_going_c_to_b2b", "bot2_going_c_to_a2a"):
        assert len(re.findall(rf"state \d+: {word}", said)) == 1, said[-8000:]
