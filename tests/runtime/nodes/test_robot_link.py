"""A robot gets its order before a line about it is written."""

from __future__ import annotations

from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy
from rospy.topics import _PublisherImpl
from std_msgs.msg import String

from pursue_runtime.controller.goal import Goal, Movement
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.nodes.robot_link import RobotLink
from pursue_runtime.orders import Order


@pytest.fixture
def happened(monkeypatch: pytest.MonkeyPatch) -> List[str]:
    """What is published and logged, in its order; nothing goes to ROS."""
    found: List[str] = []

    class Publisher:
        """Takes the place of rospy's."""

        def __init__(self, topic: str, *_: object, **__: object) -> None:
            self.resolved_name = topic
            self.impl = _PublisherImpl(topic, String)

        def get_num_connections(self) -> int:
            return 0

        def publish(self, message: object) -> None:
            found.append(f"published on {self.resolved_name}")

    monkeypatch.setattr(rospy, "Publisher", Publisher)
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time(1))
    return found


def link(happened: List[str]) -> RobotLink:
    """The link to a robot; what it logs is noted."""
    ending: Any = None
    log = lambda level, text: happened.append(f"{level}: {text}")
    nothing = lambda *_: None
    return RobotLink("bot", Settings(simulated=True), ending, log, nothing, nothing, nothing, nothing)


def test_an_action_is_sent_before_it_is_logged(happened: List[str]) -> None:
    link(happened).do(Order("bot", "answer", 3, "b", at_once=True))
    assert happened == [
        "published on bot/pursue/actions",
        "warn: no subscriber on bot/pursue/actions yet",
        "info: bot does answer",
    ]


def test_a_goal_is_sent_before_it_is_logged(happened: List[str]) -> None:
    goal = Goal("bot-1", Movement("going_a_to_b", Place("b", 1.0, 2.0)))
    link(happened).go(goal, [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    assert happened[0] == "published on bot/move_base_simple/goal"
    assert happened[-1] == "info: bot goes to b (1.00, 2.00)"
