"""A controller publishes no command for a robot that cannot get the order, or is not where the action begins; what it
takes from states, says again to an observer, and calls back."""

from __future__ import annotations

import threading
from types import SimpleNamespace
from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.nodes import exeggutor
from pursue_runtime.nodes.exeggutor import LOOKS, Exeggutor
from pursue_runtime.state import HOLDING, LOST, RUNNING, STOPPED, WAITING, WON, SystemState
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


@pytest.mark.parametrize("status, here", [(RUNNING, "a"), (HOLDING, "a"), (WAITING, ""), (WON, ""), (STOPPED, "")])
def test_a_robot_has_a_place_in_a_mission_that_is_under_way_and_goes_on_where_it_runs(status: str, here: str) -> None:
    made = executor()
    made._ways, made._places = {"bot": {}}, {"bot": {"a": Place("a", 0.0, 0.0)}}
    view = made._view("bot", SystemState(3, 100.0, {"bot": "a"}, {}, {}, status=status, held=("bot",)))
    assert (view.location, view.running, view.held) == (here, status == RUNNING, True)
    assert (view.post is not None) == bool(here)


def test_it_looks_where_robots_are_and_looks_again_after_a_while(monkeypatch: pytest.MonkeyPatch) -> None:
    made, looks = executor(), []  # type: ignore[var-annotated]
    monkeypatch.setattr(exeggutor.time, "monotonic", lambda: 50.0)
    made._place, made._act = lambda *_: looks.append("placed"), lambda: looks.append("acted")
    look = lambda: looks.append("looked")
    made._links = {"bot": SimpleNamespace(watch=lambda: None, look=look, has_lost_position=False)}
    made._on_alarm()
    assert looks == ["looked", "acted"] and made._next_look == 50.0 + LOOKS


def test_an_observer_that_connects_hears_every_report_again_and_then_that_these_are_all() -> None:
    made, said = executor(), []  # type: ignore[var-annotated]
    made._robots = {name: SimpleNamespace(say_again=lambda name=name: said.append(name)) for name in ("bot1", "bot2")}
    made._act, made.on_observer = lambda: said.append("published"), lambda: said.append("all")
    made._say_again()
    assert said == ["bot1", "bot2", "published", "all"]


@pytest.mark.parametrize("status, on_stop, goal, cancelled", [
    (RUNNING, "cancel", "g1", ["g1"]), (LOST, "cancel", "g1", ["g1"]), (WON, "cancel", "g1", []),
    (RUNNING, "keep", "g1", []), (RUNNING, "cancel", "", []),
])  # fmt: skip
def test_a_node_that_ends_calls_back_whom_it_has_sent_unless_all_is_well(
    status: str, on_stop: str, goal: str, cancelled: List[str]
) -> None:
    made, told = executor(), []  # type: ignore[var-annotated]
    made._robots = {"bot": SimpleNamespace(goal=goal, settings=SimpleNamespace(on_stop=on_stop))}
    made._links, made._status = {"bot": SimpleNamespace(cancel=told.append)}, status
    made._call_back()
    assert told == cancelled
