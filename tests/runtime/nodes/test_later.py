"""What does not belong to a reaction is done after it, in order, and nothing of it is lost."""

from __future__ import annotations

import threading
from typing import Any, List

import pytest

from tests.waiting import PATIENCE

pytest.importorskip("rospy", reason="ROS is not installed")

import rospy

from pursue_runtime.nodes.alarm import Later
from pursue_runtime.nodes.node import FAILED


class Ending:
    """Takes the place of a node's end: `statuses` are those that it was ended with."""

    def __init__(self) -> None:
        self.statuses: List[int] = []
        self.ended = threading.Event()

    def end(self, status: int) -> None:
        """Ends the node."""
        self.statuses.append(status)
        self.ended.set()


def test_the_end_of_the_node_comes_after_all_that_was_passed_before() -> None:
    ending: Any = Ending()
    later, done = Later("texts", ending), []  # type: ignore[var-annotated]
    for number in range(1000):
        later.do(lambda number=number: done.append(number))  # type: ignore[misc]
    later.do(lambda: ending.end(0))
    assert ending.ended.wait(PATIENCE)
    assert (done, ending.statuses) == (list(range(1000)), [0])


def test_what_fails_ends_the_node(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rospy, "is_shutdown", lambda: False)
    monkeypatch.setattr(rospy, "logfatal", lambda *text: None)
    ending: Any = Ending()
    Later("texts", ending).do(lambda: 1 // 0)
    assert ending.ended.wait(PATIENCE)
    assert ending.statuses == [FAILED]


def test_what_is_passed_in_a_reaction_is_done_after_it() -> None:
    """Two threads react at the same time: what both have passed waits for the second one."""
    ending: Any = Ending()
    later, done = Later("log", ending), threading.Event()
    inside, go_on = threading.Event(), threading.Event()

    def react() -> None:
        with later:
            inside.set()
            assert go_on.wait(PATIENCE)

    other = threading.Thread(target=react)
    with later:
        other.start()
        assert inside.wait(PATIENCE)
        later.do(done.set)
    assert not done.wait(0.1), "the other reaction goes on"
    go_on.set()
    assert done.wait(PATIENCE)
    other.join(PATIENCE)


def test_a_reaction_that_fails_keeps_nothing_back() -> None:
    ending: Any = Ending()
    later, done = Later("log", ending), threading.Event()
    with pytest.raises(RuntimeError), later:
        later.do(done.set)
        raise RuntimeError
    assert done.wait(PATIENCE)
