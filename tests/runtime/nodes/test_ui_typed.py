"""What a person types at the UI's terminal is published, starts the mission, or shows what can be typed."""

from __future__ import annotations

import io
import threading
from types import SimpleNamespace
from typing import Any, List, Optional

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.model import Model
from pursue_runtime.nodes import ui_terminal
from pursue_runtime.nodes.ui_terminal import Typed, typed_lines
from pursue_runtime.state import SystemState
from tests.runtime.models import model_data, mover, state, worker
from tests.waiting import until

MODEL = Model(model_data(mover("bot", "robot", 9), mover("thief", "agent", 20), worker("nurse", "human")))
NOW = state(MODEL, 7, 100.0, {"Cbot": 5.0, "Cthief": 5.0, "Cnurse": 5.0}, nurse="doing_screw_in_s")


class Screen:
    """A UI that remembers what is published and shown; `typed` is its person."""

    def __init__(self, now: Optional[SystemState] = NOW, running: bool = True, mode: str = "ask") -> None:
        self.published: List[str] = []
        self.shown: List[str] = []
        self.lock, self.verdict, self.is_running = threading.RLock(), None, running
        self.model, self.mission = MODEL, SimpleNamespace(state=now)
        self.options = SimpleNamespace(mode=mode)
        self.events = SimpleNamespace(publish=self.published.append)
        self.terminal = SimpleNamespace(line=self.shown.append)
        self.starts = 0
        self.ordered: List[str] = []
        self.orders = SimpleNamespace(typed=self.take)
        self.typed = Typed(self, ["nurse"])  # type: ignore[arg-type]

    def take(self, text: str) -> bool:
        if text.startswith("tea"):
            self.ordered.append(text)
        return text.startswith("tea")

    def can_start(self) -> bool:
        return not self.is_running

    def start(self) -> None:
        self.starts += 1


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """A ROS time without a master."""
    monkeypatch.setattr(rospy, "get_time", lambda: 100.0)


def test_a_number_is_what_is_offered_in_the_state_of_now() -> None:
    screen = Screen()
    screen.typed.on_line("1")
    assert screen.published == ["thief_a2b"]
    screen.mission.state = state(MODEL, 8, 100.0, {"Cthief": 5.0}, thief="b")
    screen.typed.on_line("1")
    assert screen.published == ["thief_a2b", "thief_b2a"]


def test_an_order_is_passed_on_once_the_mission_runs() -> None:
    screen = Screen()
    screen.typed.on_line(" tea within 5 min ")
    assert (screen.ordered, screen.published, screen.shown) == (["tea within 5 min"], [], [])
    ready = Screen(running=False)
    ready.typed.on_line("tea")
    assert ready.ordered == []


def test_an_end_carries_the_number_of_the_state_and_another_word_does_not() -> None:
    screen = Screen()
    screen.typed.on_line("done")
    screen.typed.on_line("bot_a2b")
    assert screen.published == ["screwDONE#7", "bot_a2b"]


def test_before_the_first_state_nothing_is_offered_and_words_go_out() -> None:
    screen = Screen(None)
    screen.typed.on_line("1")
    assert screen.published == [] and "no number 1" in screen.shown[-1]
    screen.typed.on_line("ping")
    assert screen.published == ["_ping_"]


def test_enter_starts_a_mission_that_is_ready_and_shows_the_menu_of_one_that_runs() -> None:
    ready = Screen(running=False)
    ready.typed.on_line(" ")
    assert (ready.starts, ready.shown) == (1, [])
    runs = Screen()
    for _ in range(2):
        runs.shown.clear()
        runs.typed.on_line("")
        assert runs.starts == 0 and any("thief_a2b" in line for line in runs.shown)


def test_the_menu_is_shown_where_it_has_changed_and_the_hint_with_what_is_new() -> None:
    screen = Screen()
    screen.typed.show()
    assert any("thief_a2b" in line for line in screen.shown) and any("type done" in line for line in screen.shown)
    assert any(line.endswith("screwDONE") for line in screen.shown), "at once: when it ends nobody knows"
    screen.shown.clear()
    screen.typed.show()
    assert screen.shown == []
    screen.mission.state = state(MODEL, 8, 101.0, {"Cthief": 6.0}, thief="b")
    screen.typed.show()
    assert any("thief_b2a" in line for line in screen.shown) and not any("type done" in line for line in screen.shown)
    still = Screen(mode="still")
    still.typed.show()
    assert not any("thief_a2b" in line for line in still.shown)


def test_after_the_end_nothing_is_published() -> None:
    screen: Any = Screen()
    screen.verdict = (0, "won")
    screen.typed.on_line("bot_a2b")
    screen.typed.on_line("")
    assert (screen.published, screen.starts) == ([], 0)
    assert len(screen.shown) == 2 and all("has ended" in line for line in screen.shown)


def test_lines_are_taken_as_they_are_typed(monkeypatch: pytest.MonkeyPatch) -> None:
    screen: Any = Screen()
    screen.ending = SimpleNamespace(end=lambda status: None)
    monkeypatch.setattr(ui_terminal, "sys", SimpleNamespace(stdin=io.StringIO("ping\nstop\n")))
    screen.typed.start()
    until(lambda: screen.published == ["_ping_", "_stop_"], "both were published")


def broken() -> io.TextIOWrapper:
    return io.TextIOWrapper(io.BytesIO(b"\xff\n"), "utf-8")


def closed() -> io.StringIO:
    stream = io.StringIO()
    stream.close()
    return stream


@pytest.mark.parametrize("stream", [broken(), closed()])
def test_where_the_terminal_is_gone_the_mission_goes_on_without_one(
    stream: io.TextIOBase, monkeypatch: pytest.MonkeyPatch
) -> None:
    logged: List[str] = []
    monkeypatch.setattr(rospy, "logwarn", lambda text, *_: logged.append(text))
    monkeypatch.setattr(ui_terminal, "sys", SimpleNamespace(stdin=stream))
    assert list(typed_lines()) == [] and "not read any more" in logged[0]


@pytest.mark.parametrize("stream, mode, is_read", [
    (io.StringIO(), "ask", True), (io.StringIO(), "still", False), (closed(), "ask", False), (None, "ask", False),
])
def test_who_is_asked_may_type(
    stream: Optional[io.StringIO], mode: str, is_read: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ui_terminal, "sys", SimpleNamespace(stdin=stream))
    monkeypatch.setattr(ui_terminal, "on_terminal", lambda: False)
    assert Screen(mode=mode).typed.is_read == is_read
