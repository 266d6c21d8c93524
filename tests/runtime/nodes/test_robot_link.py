"""A robot gets its order before a line about it is written."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any, Dict, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy
from rospy.topics import _PublisherImpl
from std_msgs.msg import String

from pursue_runtime.controller.goal import ABORTED, Answer, Goal, Movement
from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.data import DataError
from pursue_runtime.nodes import robot_link
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
    return RobotLink("bot", Settings(simulated=True, namespace="bot"), ending, log, nothing, nothing, nothing, nothing)


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


FLEX = Settings("action", "result", position="none", namespace="tb3_0", navigation="move_base_flex")


def status(goal: str, number: int, text: str = "") -> Any:
    """A GoalStatus."""
    stamp = SimpleNamespace(to_sec=lambda: 1.0)
    return SimpleNamespace(goal_id=SimpleNamespace(id=goal, stamp=stamp), status=number, text=text)


def test_a_goal_that_move_base_flex_aborted_counts_from_its_result_on(
    happened: List[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    heard: Dict[str, Any] = {}
    answers: List[Answer] = []
    kinds = SimpleNamespace(
        MoveBaseActionGoal=lambda header: SimpleNamespace(goal_id=SimpleNamespace(), goal=SimpleNamespace()),
        MoveBaseActionResult="result",
    )
    monkeypatch.setitem(sys.modules, "mbf_msgs", SimpleNamespace())
    monkeypatch.setitem(sys.modules, "mbf_msgs.msg", kinds)
    monkeypatch.setattr(robot_link, "subscribe", lambda topic, kind, take, *_, **__: heard.update({topic: take}))
    nothing: Any = lambda *_: None
    ending: Any = None
    link = RobotLink("bot", FLEX, ending, nothing, answers.append, answers.extend, nothing, nothing)
    link.go(Goal("bot-1", Movement("going_a_to_b", Place("b", 1.0, 2.0))), [1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0])
    assert happened == ["published on tb3_0/move_base_flex/move_base/goal"]
    listed = SimpleNamespace(status_list=[status("bot-1", ABORTED, "Nothing"), status("bot-2", 1)])
    heard["tb3_0/move_base_flex/move_base/status"](listed)
    assert answers == [Answer("bot-2", 1.0, 1)]
    answers.clear()
    result = SimpleNamespace(status=status("bot-1", ABORTED, "Nothing"), result=SimpleNamespace(outcome=56))
    heard["tb3_0/move_base_flex/move_base/result"](result)
    heard["tb3_0/move_base_flex/move_base/status"](listed)
    assert [(answer.goal, answer.outcome) for answer in answers] == [
        ("bot-1", "No path found"), ("bot-1", "No path found"), ("bot-2", "")
    ]  # fmt: skip


def test_the_messages_of_move_base_flex_are_not_among_debians(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "mbf_msgs", None)
    with pytest.raises(DataError) as told:
        robot_link.needed("mbf_msgs", "mbf_msgs.msg", "navigation: move_base_flex")
    assert str(told.value).startswith("navigation: move_base_flex needs the ROS package mbf_msgs")
    assert str(told.value).endswith("install ros-noetic-mbf-msgs")
