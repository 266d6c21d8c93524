"""What the UI does with what it receives, without a master."""

from __future__ import annotations

import json
import threading
from types import SimpleNamespace
from typing import Any, Dict, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from pursue_runtime.nodes import ui as ui_module
from pursue_runtime.nodes.ui import NOT_STARTED, TRIES, UI, VANISHED
from pursue_runtime.nodes.ui_state import GATHERING, READY, RUNNING, STARTING
from pursue_runtime.state import SystemState

STATE = SystemState(3, 100.0, {}, {}, {}, status="running")


class Noting:
    """Takes any call, and notes its name and what it was given."""

    def __init__(self, done: List[Any], **values: Any) -> None:
        self.__dict__.update(values, done=done)

    def __getattr__(self, name: str) -> Any:
        return lambda *given, **named: self.done.append((name, *given, *named.values()))


@pytest.fixture
def ui(monkeypatch: pytest.MonkeyPatch) -> Any:
    """A UI whose parts note what they are asked to do; the state that comes counts, and ends nothing."""
    made: Any = UI.__new__(UI)
    made.lock, made.done, made.verdict, made.phase, made.tries = threading.RLock(), [], None, GATHERING, 0
    made.observer, made.finish_received = "/observer", None
    source = SimpleNamespace(mission="m1")
    made.membership = SimpleNamespace(takes=lambda state: state is STATE, source=source, leave=lambda: None)
    made.mission = SimpleNamespace(
        on_state=lambda *_: [], state=None, verdict=lambda: None, first_line=lambda _: "", elapsed=lambda _: 0.0,
        start=None, add_plan=lambda *given: made.done.append(("add_plan", *given)), due=lambda *_: ["word"],
        next_moments=lambda _: (105.0, None), progress=lambda _: "",
    )  # fmt: skip
    made.strategies = {}
    made.page = Noting(made.done, url="", stays=False)
    made.terminal = Noting(made.done, is_terminal=False)
    made.events = SimpleNamespace(publish=lambda word: made.done.append(("publish", word)))
    made.alarm, made.typed = Noting(made.done), Noting(made.done, is_read=False)
    made.readiness = SimpleNamespace(update=lambda *_: None, missing=lambda: ["bot"])
    made.options = SimpleNamespace(verdict="", mode="still", autostart=False)
    made.states = SimpleNamespace(get_num_connections=lambda: 1)
    made.ending = Noting(made.done, renewed=False, reason="", wait=lambda linger: 0)
    monkeypatch.setattr(ui_module.rospy, "get_time", lambda: 100.0)
    monkeypatch.setattr(ui_module.time, "monotonic", lambda: 50.0)
    monkeypatch.setattr(ui_module, "listeners", lambda _: [])
    monkeypatch.setattr(ui_module, "save_verdict", lambda *given: made.done.append(("verdict", *given)))
    return made


def status(node: str) -> Any:
    return SimpleNamespace(values=[], hardware_id=node, name=node, message="")


def names(done: List[Any]) -> List[str]:
    return [each[0] for each in done]


def test_the_page_shows_who_is_not_ready_yet(ui: Any) -> None:
    ui.on_diagnostics(SimpleNamespace(status=[status("bot")]))
    assert names(ui.done) == ["on_robots", "show"] and ui.phase == GATHERING


def test_the_first_state_under_way_begins_the_mission_and_one_that_does_not_count_changes_nothing(ui: Any) -> None:
    ui.on_state(STATE._replace(seq=4), "/somebody")
    assert ui.observer == "/observer" and ui.done == []
    ui.on_state(STATE, "/another")
    assert (ui.observer, ui.phase, ui.verdict) == ("/another", RUNNING, None) and ("publish", "word") in ui.done


def test_a_state_with_a_verdict_ends_the_mission_once(ui: Any) -> None:
    ui.mission.verdict = lambda: (1, "The mission was stopped.")
    ui.on_state(STATE, "/observer")
    assert ui.verdict == (1, "The mission was stopped.") and ("end", 1) in ui.done
    ui.done.clear()
    ui.on_state(STATE, "/observer")
    assert ui.done == [("after_end", STATE)]


PLAN: Dict[str, Any] = {"format": 1, "plan": 2, "mission": "m1", "strategies": {}, "cover": {}}
PEOPLE: Dict[str, Any] = {
    "format": 1, "controller": "UI", "commands_agents": ["nurse"], "reaction": 0.1, "strategy": [],
}  # fmt: skip


@pytest.mark.parametrize("mission, people, learned", [("m1", PEOPLE, True), ("m1", None, False), ("m2", PEOPLE, False)])
def test_what_people_do_by_a_new_plan_of_this_mission_is_learned(
    ui: Any, mission: str, people: object, learned: bool
) -> None:
    ui.phase = RUNNING
    ui.on_plan(SimpleNamespace(data=json.dumps({**PLAN, "mission": mission, "people": people})))
    assert ("add_plan" in names(ui.done), "on_plan" in names(ui.done)) == (learned, mission == "m1")


@pytest.mark.parametrize("word, node, counts", [
    ("Finish!", "/observer", True), (" Finish!\n", "/observer", True), ("Finish!", "/bot", False),
    ("bot_a2b", "/observer", False),
])  # fmt: skip
def test_the_last_word_is_the_observers(ui: Any, word: str, node: str, counts: bool) -> None:
    ui.phase = RUNNING
    ui.on_word(SimpleNamespace(data=word, _connection_header={"callerid": node}))
    assert (ui.finish_received is not None) is counts


def test_it_sleeps_until_its_next_word_or_until_an_observer_that_is_gone_has_no_state(ui: Any) -> None:
    ui.phase = RUNNING
    ui.act()
    assert ui.done[-1] == ("set", 105.0, None)
    ui.finish_received = 50.0 - VANISHED / 2
    ui.act()
    assert ui.done[-1] == ("set", 105.0, VANISHED / 2)


def test_an_observer_that_never_answers_ends_the_mission_before_it_begins(ui: Any) -> None:
    ui.phase = READY
    for _ in range(TRIES):
        ui.start()
    assert ui.phase == STARTING and ui.done.count(("publish", "_start_")) == TRIES and ui.verdict is None
    ui.start()
    assert ui.verdict is not None and ("end", 1) in ui.done
    assert [each[2] for each in ui.done if each[0] == "verdict"] == [NOT_STARTED]


@pytest.mark.parametrize("verdict, status", [(None, 1), ((0, ""), 0), ((1, ""), 1)])
def test_a_master_that_is_lost_ends_the_node_with_its_verdict(ui: Any, verdict: Any, status: int) -> None:
    ui.phase, ui.verdict = RUNNING, verdict
    ui.master_lost("the ROS master is gone")
    assert ui.done[-1] == ("end", status)


def test_another_mission_begins_in_the_same_process(ui: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ui.ending.renewed, ui.verdict, started = True, (0, ""), []  # type: ignore[var-annotated]
    ui.page.close = lambda why: {"KEPT": "yes"}
    monkeypatch.setattr(ui_module, "restart_process", started.append)
    ui.run()
    assert started == [{"KEPT": "yes"}]
