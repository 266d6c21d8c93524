"""Simulated time is published in the steps of its pace; on a busy machine late steps are not made up for."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.nodes import sim_clock


class World:
    """A time that passes while the clock sleeps, and when a message takes `takes[n]` seconds."""

    def __init__(self, takes: List[float]) -> None:
        self.now, self.takes, self.published = 100.0, takes, []  # type: ignore[var-annotated]

    def publish(self, _: object) -> None:
        self.published.append(round(self.now, 6))
        if len(self.published) > len(self.takes):
            raise rospy.ROSException("the node is going down")
        self.now += self.takes[len(self.published) - 1]

    def sleep(self, seconds: float) -> None:
        self.now += seconds


@pytest.mark.parametrize(
    "takes, moments",
    [
        ([0.0, 0.0, 0.0], [100.0, 100.5, 101.0, 101.5]),
        ([0.2, 0.2, 0.2], [100.0, 100.5, 101.0, 101.5]),
        ([0.0, 2.0, 0.0], [100.0, 100.5, 102.5, 103.0]),
    ],
)
def test_a_step_comes_a_period_after_the_one_before_or_at_once_where_that_has_passed(
    monkeypatch: pytest.MonkeyPatch, takes: List[float], moments: List[float]
) -> None:
    world, saved = World(takes), []  # type: ignore[var-annotated]
    monkeypatch.setattr(sim_clock, "time", SimpleNamespace(monotonic=lambda: world.now, sleep=world.sleep))
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    clock: Any = SimpleNamespace(period=0.5, message=lambda real: real)
    memory: Any = SimpleNamespace(save=lambda simulated: saved.append(round(simulated, 6)))
    sim_clock.tick(clock, world, memory)  # type: ignore[arg-type]
    assert world.published == moments == saved
