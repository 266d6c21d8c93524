"""An alarm rings at its moment, in real or simulated time, and when its patience is over; what was set last counts."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace
from typing import Any, Callable, List

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.nodes import alarm as alarms
from pursue_runtime.nodes.alarm import Alarm

NEVER = 1e6  # seconds


class Rings:
    """Counts the calls of an alarm, in whose thread `does` is called."""

    def __init__(self, does: Callable[[], object] = lambda: None) -> None:
        self.count = 0
        self._does = does
        self._rung = threading.Semaphore(0)

    def __call__(self) -> None:
        self.count += 1
        self._does()
        self._rung.release()

    def wait(self) -> None:
        assert self._rung.acquire(timeout=PATIENCE)

    @property
    def more(self) -> bool:
        """Whether it rings once more, soon."""
        return self._rung.acquire(timeout=0.1)


@pytest.fixture(autouse=True)
def shut_down(monkeypatch: pytest.MonkeyPatch) -> List[bool]:
    """A ROS time without a master, which is the real one; whether the node shuts down."""
    is_down = [False]
    monkeypatch.setattr(rospy.rostime, "is_wallclock", lambda: True)
    monkeypatch.setattr(rospy, "get_time", time.time)
    monkeypatch.setattr(rospy, "is_shutdown", lambda: is_down[0])
    monkeypatch.setattr(rospy, "logfatal", lambda *text: None)
    return is_down


def made(rings: Rings) -> Alarm:
    ending: Any = SimpleNamespace(end=lambda status: None)
    return Alarm(rings, ending)


def test_it_rings_once_at_its_moment_and_not_before() -> None:
    began, at = time.time(), []  # type: ignore[var-annotated]
    rings = Rings(lambda: at.append(time.time()))
    alarm = made(rings)
    assert not rings.more, "nothing was set"
    alarm.set(began + 0.3)
    rings.wait()
    assert at[0] >= began + 0.3 and not rings.more


def test_it_rings_when_its_patience_is_over_though_its_moment_is_far() -> None:
    rings = Rings()
    alarm = made(rings)
    alarm.set(time.time() + NEVER, patience=NEVER)
    assert not rings.more
    alarm.set(time.time() + NEVER, patience=0.05)
    rings.wait()


def test_what_is_set_last_counts() -> None:
    rings = Rings()
    alarm = made(rings)
    alarm.set(time.time() + NEVER)
    assert not rings.more
    alarm.set(time.time())  # it sleeps until the other moment
    rings.wait()
    alarm.set(time.time() + 0.2)
    alarm.set()
    assert not rings.more and not rings.more and not rings.more


def test_it_can_be_set_again_by_what_it_calls() -> None:
    alarms_made: List[Alarm] = []
    rings = Rings(lambda: alarms_made[0].set(patience=0.01))
    alarms_made.append(made(rings))
    alarms_made[0].set(patience=0.0)
    for _ in range(3):
        rings.wait()


def test_in_simulated_time_it_rings_when_the_clock_is_there(monkeypatch: pytest.MonkeyPatch) -> None:
    ticks: List[Callable[[Any], None]] = []
    monkeypatch.setattr(rospy.rostime, "is_wallclock", lambda: False)
    monkeypatch.setattr(rospy, "get_time", lambda: 0.0)
    monkeypatch.setattr(alarms, "subscribe", lambda topic, kind, callback, *_, **__: ticks.append(callback))
    rings = Rings()
    alarm = made(rings)

    def tick(seconds: float) -> None:
        ticks[0](SimpleNamespace(clock=SimpleNamespace(to_sec=lambda: seconds)))

    tick(5.0)
    assert not rings.more, "nothing was set"
    alarm.set(7.0)
    tick(6.9)
    assert not rings.more
    tick(7.0)
    rings.wait()
    alarm.set(7.0)
    rings.wait()
    alarm.set(8.0, patience=0.01)
    rings.wait()


def test_it_ends_with_the_node(shut_down: List[bool]) -> None:
    rings = Rings()
    alarm = made(rings)
    shut_down[0] = True
    alarm.set(patience=0.0)
    rings.wait()
    alarm.set(patience=0.0)
    assert not rings.more
