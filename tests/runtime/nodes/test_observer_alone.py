"""What the observer publishes, notes and closes at the end, without a master."""

from __future__ import annotations

import contextlib
import threading
from types import SimpleNamespace
from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from std_msgs.msg import String

from pursue_runtime.event_words import FINISH
from pursue_runtime.nodes import observer as observer_module
from pursue_runtime.nodes.observer import Observer
from pursue_runtime.observer.returning import Returning
from pursue_runtime.state import SystemState


@pytest.fixture
def observer(monkeypatch: pytest.MonkeyPatch) -> Any:
    """An observer whose parts note what they are asked to do."""
    made: Any = Observer.__new__(Observer)
    done: List[Any] = []
    note = lambda name: lambda *given, **_: done.append((name, *given))
    made.done, made.lock, made.over, made.last_report, made.proposed = done, threading.RLock(), False, {}, 0
    made.published_at, made.plain_words = 0.0, None
    made.log_lines = contextlib.nullcontext()
    made.mission = SimpleNamespace(
        status="running", seq=4, name="m1", proposal=None, in_force=None, plan_request=None, silent=set(),
        state=lambda now: SystemState(4, now, {}, {}, {}, status=made.mission.status),
        model=SimpleNamespace(scenario="s"), reason="",
    )  # fmt: skip
    made.inbox = SimpleNamespace(
        returning=None, next_moments=lambda _: (105.0, None), notice_absence=lambda _: None,
        call=lambda name, *given, now: done.append(("call", name, *given)) or [],
    )  # fmt: skip
    made.newest = SimpleNamespace(note=note("newest"), close=note("newest closed"))
    made.journal = SimpleNamespace(last=0.0, sync_soon=lambda: None, end=note("journal ended"))
    made.planner = SimpleNamespace(request_plan=lambda _: None)
    made.repeats = SimpleNamespace(on_publish=lambda *_: None, next_moment=lambda: None)
    made.alarm = SimpleNamespace(set=note("alarm"))
    made.after_reaction = SimpleNamespace(do=lambda action: action())
    made.ending = SimpleNamespace(end=note("end"), wait=lambda linger: 0, renewed=False, renew=note("renew"))
    made.printer = SimpleNamespace(on_state=lambda _: None)
    made.states, made.texts, made.events, made.plans = (
        SimpleNamespace(publish=note(topic)) for topic in ("states", "texts", "events", "plans")
    )
    made.missions = SimpleNamespace(changed=lambda: False)
    made.source = SimpleNamespace(mission="m1")
    made.settings = SimpleNamespace(heartbeat=1.0, silence=20.0, again=False, launch="l1", linger=0.0)
    monkeypatch.setattr(observer_module, "message_of", lambda state: state.status)
    monkeypatch.setattr(observer_module.rospy, "get_time", lambda: 100.0)
    monkeypatch.setattr(observer_module.rospy, "loginfo", lambda *_: None)
    monkeypatch.setattr(observer_module.time, "sleep", lambda _: None)
    monkeypatch.setattr(observer_module.time, "monotonic", lambda: 50.0)
    return made


def once(monkeypatch: pytest.MonkeyPatch, observer: Any) -> List[Any]:
    """One round of the thread that publishes the state again: what is done."""
    rounds = iter((False, True))
    monkeypatch.setattr(observer_module.rospy, "is_shutdown", lambda: next(rounds))
    observer.keep_publishing()
    return list(observer.done)


@pytest.mark.parametrize("status, noted", [
    ("waiting", []), ("running", [("newest", (4, False), 100.0)]), ("won", [("newest", (4, True), 100.0)]),
])  # fmt: skip
def test_the_master_is_told_how_far_a_mission_has_come_that_has_begun(
    observer: Any, monkeypatch: pytest.MonkeyPatch, status: str, noted: List[Any]
) -> None:
    observer.mission.status = status
    assert [each for each in once(monkeypatch, observer) if each[0] == "newest"] == noted


def test_who_has_not_reported_for_too_long_is_silent_unless_the_observer_was_away_itself(
    observer: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    observer.last_report = {"controller_bot1": 29.0, "controller_bot2": 31.0}
    calls = [each for each in once(monkeypatch, observer) if each[0] == "call"]
    assert calls == [("call", "silent", "controller_bot1")]
    observer.done.clear()

    def notice(_: float) -> None:
        observer.inbox.returning = Returning(90.0, None, 50.0, 1.0)

    observer.inbox.notice_absence = notice
    observer.inbox.next_moments = lambda _: (None, 51.0)
    assert once(monkeypatch, observer) == [("newest", (4, False), 100.0), ("alarm", None, 1.0)]


@pytest.mark.parametrize("status, last", [("won", [("end", 0)]), ("lost", [("end", 1)]), ("running", [])])
def test_the_last_state_ends_the_node_once_and_a_won_mission_has_a_last_word(
    observer: Any, status: str, last: List[Any]
) -> None:
    observer.mission.status = status
    for _ in range(2):
        observer.publish([observer.mission.state(100.0)])
    assert [each for each in observer.done if each[0] == "end"] == last
    assert [each[1] for each in observer.done if each[0] == "events"] == ([FINISH] if status == "won" else [])


@pytest.mark.parametrize("again, launch, status, closed", [
    (True, "l1", "won", True), (False, "", "won", True), (False, "l1", "won", False), (True, "l1", "running", False),
])  # fmt: skip
def test_a_mission_is_over_for_good_where_another_one_may_follow(
    observer: Any, again: bool, launch: str, status: str, closed: bool
) -> None:
    observer.settings.again, observer.settings.launch, observer.mission.status = again, launch, status
    observer.run()
    assert ("newest closed" in [each[0] for each in observer.done]) is closed


def test_the_word_of_a_controller_that_does_not_receive_the_states_is_dropped(
    observer: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    connected: List[str] = []
    monkeypatch.setattr(observer_module, "is_connected", lambda _, node: node in connected)
    observer.log_soon = lambda *_: None
    observer.last_report = {"controller_bot1": 50.0}
    message = String("bot1:bot1_a2b@4")
    for node in ("/controller_bot1", "/somebody"):
        message._connection_header = {"callerid": node}
        observer.on_word(message)
    connected.append("/controller_bot1")
    message._connection_header = {"callerid": "/controller_bot1"}
    observer.on_word(message)
    assert [each for each in observer.done if each[0] == "call"] == [("call", "hear", message.data)] * 2
