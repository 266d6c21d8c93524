"""Missions with fake robots whose people disturb them: each is won, and each action is done once, at its place.

`PURSUE_MISSIONS=10` plays ten of them instead of two.
"""

from __future__ import annotations

import os
import random
import time
from pathlib import Path
from typing import Any, Callable, Dict

import pytest
from fake_robots import UNIT, Robots, playing, robots_workspace, wait_for
from ros_world import Ros

pytestmark = pytest.mark.ros

MISSIONS = int(os.environ.get("PURSUE_MISSIONS", "2"))
TARGETS = {"bot1": "b", "bot2": "a"}
RESUME = "'{robot}:_resume_'"


@pytest.fixture(scope="module")
def workspace(ros: Ros) -> Path:
    return robots_workspace(ros, "thesis/scenario_1", tuple(TARGETS))


class Person:
    """A person who disturbs the robots of a mission."""

    def __init__(self, robots: Robots, log: Path, mission: Any, chance: random.Random) -> None:
        self.robots, self.log, self.mission, self.chance = robots, log, mission, chance

    def wait(self, done: Callable[[], bool], what: str) -> None:
        """Waits until it is so, or the mission is over."""
        wait_for(lambda: done() or self.mission.poll() is not None, self.log, what)

    def after(self, robot: str, what: str) -> None:
        """Waits until the robot has heard this, and a moment more."""
        self.wait(lambda: what in self.robots.heard(robot), f"{robot} has not heard: {what}")
        time.sleep(self.chance.uniform(0.0, 5 * UNIT))

    def resume(self, robot: str) -> None:
        """Lets a robot go on that is held. One that was called back before it said that it has its goal is not."""
        self.wait(lambda: f"publish {robot}:_resume_" in self.log.read_text(), f"{robot} is not held")
        if self.mission.poll() is None:
            self.robots.publish("pursue/events", "std_msgs/String", RESUME.format(robot=robot))

    def restarts(self, robot: str) -> None:
        """move_base is killed on the way, and started again."""
        self.after(robot, f"goal {TARGETS[robot]}")
        self.robots.order(robot, f"restart {self.chance.uniform(0.1, 1.0):.1f}")

    def cancels(self, robot: str) -> None:
        """The robot is called back on the way, and goes on later."""
        self.after(robot, f"goal {TARGETS[robot]}")
        self.robots.publish(f"{robot}/move_base/cancel", "actionlib_msgs/GoalID", "{}")
        self.resume(robot)

    def sends_elsewhere(self, robot: str) -> None:
        """The robot is sent elsewhere on the way, and taken back."""
        self.after(robot, f"goal {TARGETS[robot]}")
        place = "{x: -8.0, y: 8.0}"
        pose = f"{{header: {{frame_id: map}}, pose: {{position: {place}, orientation: {{w: 1.0}}}}}}"
        self.robots.publish(f"{robot}/move_base_simple/goal", "geometry_msgs/PoseStamped", pose)

    def carries(self, robot: str) -> None:
        """The robot is carried away, on the way or when it has arrived."""
        self.after(robot, f"goal {TARGETS[robot]}")
        time.sleep(self.chance.uniform(0.0, 10 * UNIT))
        x, y, yaw = (self.chance.uniform(-9.0, 9.0) for _ in range(3))
        self.robots.order(robot, f"put {x:.1f} {y:.1f} {yaw / 3:.1f}")


@pytest.mark.parametrize("seed", range(MISSIONS))
def test_whatever_people_do_each_action_is_done_once_at_its_place(
    ros: Ros, workspace: Path, tmp_path: Path, seed: int
) -> None:
    chance = random.Random(seed)
    goals, ends = ("action", "simple")[seed % 2], ("result", "pose", "tf")[seed % 3]
    slow: Dict[str, Any] = {robot: {"travel": 6.0, "boot": chance.uniform(0.0, 1.5)} for robot in TARGETS}
    slow["bot1"]["acts"] = 3.0
    arguments = f"goals:={goals} ends:={ends} on_uncovered:=warn lost_after:=2000"
    with playing(ros, workspace, tmp_path, arguments, **slow) as (robots, log, mission):
        person = Person(robots, log, mission, chance)
        deeds = [person.restarts, person.cancels, person.sends_elsewhere, person.carries]
        for deed in chance.sample(deeds, 2):
            deed(chance.choice(sorted(TARGETS)))
        wait_for(lambda: mission.poll() is not None, log, "the mission does not end")
    said = log.read_text()
    assert "The goal is reached" in said, said[-8000:]
    assert robots.actions("bot1") == ["bot1_inb at b"] and robots.actions("bot2") == ["bot2_ina at a"]
