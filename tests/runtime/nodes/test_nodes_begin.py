"""How nodes begin, without a master: what they are connected to, and what they know before anything has come."""

from __future__ import annotations

from types import ModuleType, SimpleNamespace
from typing import Any, List, Sequence

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.nodes import controller, drive_legs, observer, ui, ui_state, witness
from pursue_runtime.nodes.node import WARN
from pursue_runtime.state import SystemState, format_state

STATE = SystemState(7, 100.0, {"bot": "a"}, {}, {}, status="running")


class Anything:
    """Takes any call, and gives the like of itself."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return Anything()

    def __call__(self, *_: Any, **__: Any) -> Any:
        return Anything()

    def __mul__(self, _: Any) -> float:
        return 1.0


def replaced(monkeypatch: pytest.MonkeyPatch, module: ModuleType, names: Sequence[str]) -> List[Any]:
    """Have these parts of a module replaced, and rospy's; what is made of Newcomers is listed."""
    made: List[Any] = []
    for name in names:
        monkeypatch.setattr(module, name, Anything())
    for name in ("Publisher", "get_param", "get_name", "loginfo"):
        monkeypatch.setattr(module.rospy, name, lambda *_, **__: Anything())
    monkeypatch.setattr(module, "Newcomers", lambda *given: made.append(given), raising=False)
    return made


def test_a_controller_begins_without_an_observer_and_is_not_ready(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = ("own_source", "Missions", "Exeggutor", "StatePrinter", "Alarm", "Witness", "subscribe_states", "subscribe",
             "Diagnostics", "Ending", "flag", "Follower")  # fmt: skip
    replaced(monkeypatch, controller, parts)
    made: Any = controller.Controller(Anything(), "")  # type: ignore[arg-type]
    assert made.observer == ""
    states = SimpleNamespace(refused="", malformed=0)
    made.follower = SimpleNamespace(report=lambda: (None, None, None, ""), filter=states)
    assert made.report()[:3] == (False, WARN, "no state from the observer yet")


def test_the_ui_says_again_what_an_observer_has_not_heard_that_connects(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = "AtDoors", "MissionView", "Readiness", "Terminal", "Turns", "strategies_of", "UIOrders"
    replaced(monkeypatch, ui_state, shown)
    parts = ("Alarm", "Typed", "UIPage", "Traffic", "subscribe_states", "subscribe", "Diagnostics")
    newcomers = replaced(monkeypatch, ui, parts)
    options: Any = SimpleNamespace(nodes=("bot",), wait=1.0)
    made: Any = ui.UI(options, *(Anything() for _ in range(5)))  # type: ignore[arg-type]
    ((_, is_observer, say_again),) = newcomers
    made.observer = "/observer"
    assert is_observer("/observer") and not is_observer("/bot") and say_again == made.say_again


def test_an_observer_begins_with_the_mission_of_its_source(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = ("read_settings", "Ending", "Later", "own_source", "Missions", "Newest", "Witnesses", "Mission", "Model",
             "read_cover", "Journal", "Planner", "ServedFirst", "StatePrinter", "Alarm", "StateRepeats", "subscribe",
             "start_thread", "Diagnostics", "take_up", "Inbox", "PlainWords", "last_mission", "mission_seen",
             "message_of", "format_state", "OrderDesk")  # fmt: skip
    replaced(monkeypatch, observer, parts)
    source = SimpleNamespace(mission="m1", read=lambda name: {"controllers": ["controller_bot1"]})
    monkeypatch.setattr(observer.Observer, "_source", lambda _: source)
    for name in ("_journal", "_journal_name", "take_up", "await_clock", "publish", "now"):
        monkeypatch.setattr(observer.Observer, name, lambda *_: Anything())
    made = observer.Observer(Anything(), {"config": ""})  # type: ignore[arg-type]
    assert (made.source, made.controllers) == (source, ["controller_bot1"]) and made.is_controller("/controller_bot1")


def test_the_last_drive_is_there_for_who_comes_later(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = ("own_source", "check_no_mission", "scenario_folder", "reserve_file", "Later", "Alarm",
             "subscribe", "Ending", "stamp", "rosbag", "json", "String")  # fmt: skip
    replaced(monkeypatch, drive_legs, parts)
    monkeypatch.setattr(drive_legs, "driven_robots", lambda *_: [])
    latched: List[Any] = []
    monkeypatch.setattr(drive_legs.rospy, "get_param", lambda *_: {})
    for name in ("resolve_name", "on_shutdown"):
        monkeypatch.setattr(drive_legs.rospy, name, lambda *_: None)
    publisher = lambda topic, _, queue_size, latch: latched.append((topic, latch))
    monkeypatch.setattr(drive_legs.rospy, "Publisher", publisher)
    monkeypatch.setattr(drive_legs, "reserve_file", lambda *_: "drives.bag")
    drive_legs.DriveLegs(Anything(), {"config": "", "file": "drives.bag"})  # type: ignore[arg-type]
    assert latched == [(drive_legs.DRIVES, True)]


def test_a_witness_publishes_what_it_has_seen_to_whoever_is_there_or_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    sent: List[Any] = []
    made: List[Any] = []

    def publisher(topic: str, _: Any, subscriber_listener: Any, **__: Any) -> Any:
        made.append((topic, subscriber_listener))
        return SimpleNamespace(publish=lambda message: sent.append(("all", message)))

    monkeypatch.setattr(witness.rospy, "Publisher", publisher)
    monkeypatch.setattr(witness, "message_of", format_state)
    monkeypatch.setattr(witness, "publish_to_one", lambda _, peer, message: peer(message))
    newest: List[SystemState] = []
    there = witness.Witness(lambda: newest[-1] if newest else None)
    assert made == [("pursue/seen", there)] and sent == [("all", format_state(witness.NOTHING))]
    newest.append(STATE)
    there.peer_subscribe("", None, lambda message: sent.append(("one", message)))
    there.publish()
    assert sent[1:] == [("one", format_state(STATE)), ("all", format_state(STATE))]
