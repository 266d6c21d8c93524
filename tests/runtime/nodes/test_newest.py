"""How far a mission has come, as the master keeps it."""

from __future__ import annotations

from typing import Any, List, cast

import pytest

from tests.waiting import until

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.nodes.newest import Newest
from pursue_runtime.nodes.node import Ending


class Master:
    """The one parameter, and every value that it has had."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, value: Any = None) -> None:
        self.values: List[Any] = [value]
        monkeypatch.setattr(rospy, "get_param", lambda *_: self.values[-1])
        monkeypatch.setattr(rospy, "set_param", lambda _, value: self.values.append(value))

    def newest(self, launch: str = "x") -> Newest:
        """The parameter as an observer of this launch finds it."""
        return Newest(launch, cast(Ending, None))


def test_an_observer_learns_how_far_the_one_before_it_had_come(monkeypatch: pytest.MonkeyPatch) -> None:
    master = Master(monkeypatch)
    first = master.newest()
    assert not first.begun and first.reached(0.0) == (0, False)
    first.note((7, False), 1000.0)
    until(lambda: len(master.values) == 2, "the parameter")
    first.note((7, False), 1001.0)
    first.note((7, True), 1002.0)
    until(lambda: master.newest().reached(0.0) == (7, True), "the end")
    assert len(master.values) == 3, "nothing new was to be kept"
    assert master.newest().begun and master.newest().reached(1002.0) == (0, False), "of the mission before"
    assert not master.newest("y").begun and master.newest("y").reached(0.0) == (0, False)


def test_the_next_mission_of_a_launch_begins_at_0(monkeypatch: pytest.MonkeyPatch) -> None:
    master = Master(monkeypatch)
    first = master.newest()
    first.note((7, True), 1000.0)
    first.close()
    until(lambda: master.values[-1] and not master.values[-1]["seq"], "the parameter")
    first.note((7, True), 1001.0)
    assert master.newest().begun and master.newest().reached(0.0) == (0, False)


@pytest.mark.parametrize("value", [7, "x", [], {}, {"launch": "x"}, {"launch": "x", "seq": "9", "stamp": 1.0}])
def test_a_parameter_with_other_values_says_nothing(monkeypatch: pytest.MonkeyPatch, value: Any) -> None:
    assert Master(monkeypatch, value).newest().reached(0.0) == (0, False)
