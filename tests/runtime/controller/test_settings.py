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
        ({"simulated": True, "ends": "pose"}, "bot1, which is simulated"),
        ({"simulated": True, "bot1": {"goals": "action"}}, "bot1, which is simulated"),
    ],
)
def test_settings_that_cannot_be_are_reported(given_here: Any, message: str) -> None:
    with pytest.raises(DataError) as told:
        read_settings("bot1", given_here)
    assert message in str(told.value)
