"""The parameters of a robot: which are taken, and what is said of those that cannot be."""

from __future__ import annotations

import math
from typing import Any

import pytest

from pursue_runtime.controller.settings import read_settings
from pursue_runtime.data import DataError


def test_a_robots_own_settings_win_over_the_nodes() -> None:
    own_ones = {"ends": "tf", "base_frame": "{robot}/base"}
    given_here = {"config": "", "ends": "pose", "end_tolerance": 1, "bot1": own_ones}
    own, other = (read_settings(robot, given_here) for robot in ("bot1", "bot2"))
    assert (own.ends, own.end_tolerance, own.base_frame) == ("tf", 1.0, "bot1/base")
    assert (other.ends, other.base_frame, other.goals) == ("pose", "bot2/base_link", "simple")


def test_a_robots_topics_and_frames_are_in_its_namespace() -> None:
    given_here = {"bot1": {"namespace": "tb3_0"}, "bot2": {"namespace": "/lab/tb3_1/", "base_frame": "{robot}/base"}}
    first, second, third = (read_settings(robot, given_here) for robot in ("bot1", "bot2", "bot3"))
    assert (first.topic("amcl_pose"), first.action, first.base_frame) == (
        "tb3_0/amcl_pose", "tb3_0/move_base", "tb3_0/base_link"
    )  # fmt: skip
    assert (second.topic("amcl_pose"), second.base_frame) == ("/lab/tb3_1/amcl_pose", "bot2/base")
    assert (third.topic("amcl_pose"), third.base_frame) == ("bot3/amcl_pose", "bot3/base_link")


def test_a_robot_may_have_no_namespace_and_all_may_have_one_with_their_names() -> None:
    alone = read_settings("bot", {"bot": {"namespace": ""}})
    assert (alone.topic("amcl_pose"), alone.base_frame) == ("amcl_pose", "base_link")
    assert read_settings("bot", {"namespace": "lab/{robot}"}).topic("scan") == "lab/bot/scan"


def test_goals_of_move_base_flex_go_to_its_action() -> None:
    flex = read_settings("bot", {"navigation": "move_base_flex", "goals": "action", "bot": {"namespace": "tb3_0"}})
    assert flex.action == "tb3_0/move_base_flex/move_base"


@pytest.mark.parametrize(
    ("given_here", "message"),
    [
        ({"ends": "results"}, "~ends of bot1 is 'results'; expected one of words, result, pose, tf"),
        ({"goals": "service"}, "~goals of bot1 is 'service'; expected one of simple, action"),
        ({"on_stop": True}, "~on_stop is True; expected a name"),
        ({"end_tolerance": -1}, "~end_tolerance is -1; expected a number that is not negative"),
        ({"end_settle": "soon"}, "~end_settle is 'soon'; expected a number"),
        ({"end_settle": math.inf}, "~end_settle is inf; expected a number"),
        ({"retries": 1.5}, "~retries is 1.5; expected a whole number"),
        ({"retries": True}, "~retries is True; expected a whole number"),
        ({"bot1": {"end": "pose"}}, "~bot1 is {'end': 'pose'}; expected some of goals, ends"),
        ({"bot1": "pose"}, "~bot1 is 'pose'; expected some of goals, ends"),
        ({"navigation": "nav2"}, "~navigation of bot1 is 'nav2'; expected one of move_base, move_base_flex"),
        ({"navigation": "move_base_flex"}, "move_base_flex takes no simple goals; expected goals:=action"),
        ({"namespace": "tb3_0"}, "who would all get the same goals; expected it below the robot's name, bot1: {"),
        ({"bot1": {"namespace": "tb3 0"}}, "~namespace of bot1 is 'tb3 0'; expected a name such as tb3_0"),
        ({"bot1": {"namespace": "tb3_0"}, "bot2": {"namespace": "tb3_0"}}, "is 'tb3_0', and so is that of bot2"),
        ({"bot1": {"namespace": "bot2"}, "bot2": {"ends": "tf"}}, "is 'bot2', and so is that of bot2"),
        ({"simulated": True, "bot1": {"namespace": "tb3_0"}}, "but it is simulated, in the namespace bot1"),
        ({"simulated": True, "ends": "pose"}, "bot1, which is simulated"),
        ({"simulated": True, "bot1": {"goals": "action"}}, "bot1, which is simulated"),
    ],
)
def test_settings_that_cannot_be_are_reported(given_here: Any, message: str) -> None:
    with pytest.raises(DataError) as told:
        read_settings("bot1", given_here)
    assert message in str(told.value)
