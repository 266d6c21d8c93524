"""A controller publishes no command for a robot that cannot get the order, or is not where the action begins."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.nodes.exeggutor import Exeggutor
from pursue_runtime.strategy import Command

GO = Command("bot_a2b", "bot", "a", "going_a_to_b", ())
FETCH = Command("fetch", "bot", "a", "doing_fetch_in_a", ())
CATCH = Command("catch", "bot", "a", "a", ())
SHOUT = Command("shout", "bot", "going_a_to_b", "going_a_to_b", ())
UNLOCK = Command("reachObj_unlock", "reachObj", "initial_location", "unlocked", ())


def executor(placed: bool = True, goals: str = "", actions: str = "") -> Any:
    """One whose robot is at its place or not, and whose topics lack subscribers for these reasons."""
    made: Any = Exeggutor.__new__(Exeggutor)
    made._lock, made._unreachable = threading.RLock(), {}
    made._robots = {"bot": SimpleNamespace(is_placed=lambda now: placed, trouble="")}
    made._links = {"bot": SimpleNamespace(missing_subscriber=lambda is_goal: goals if is_goal else actions)}
    return made


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ROS time without a master."""
    monkeypatch.setattr(rospy, "get_time", lambda: 100.0)


def test_a_robot_in_its_place_that_is_connected_may_begin_anything() -> None:
    assert all(executor().may_begin(command) for command in (GO, FETCH, CATCH, SHOUT, UNLOCK))


def test_no_action_begins_elsewhere_but_on_the_way_and_a_movement_does() -> None:
    away = executor(placed=False)
    assert all(away.may_begin(command) for command in (GO, SHOUT, UNLOCK))
    assert not any(away.may_begin(command) for command in (FETCH, CATCH))


def test_who_is_not_connected_gets_no_command_and_the_operator_reads_why() -> None:
    why = "cannot get an order: no node is subscribed to bot/pursue/actions"
    deaf = executor(actions=why)
    assert deaf.may_begin(GO) and not deaf.may_begin(CATCH) and not deaf.may_begin(SHOUT)
    assert deaf.troubles() == {"bot": why}
    assert deaf.may_begin(GO) and deaf.troubles() == {}
    assert not executor(goals="no goals").may_begin(GO) and deaf.may_begin(UNLOCK)
