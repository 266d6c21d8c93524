"""The socket for tools that are no ROS nodes: what they hear, and what becomes of those that do not listen."""

from __future__ import annotations

import json
import socket
from typing import Any, Callable, Dict, Iterator, List

import pytest

from pursue_runtime.http_server import Background, bind
from pursue_runtime.manager.forwarder import MAX_LINE, Forwarder
from pursue_runtime.manager.manager import RequestLog
from tests.waiting import PATIENCE, connected, until


class Stage:
    """A forwarder on a free port."""

    def __init__(self, **options: int) -> None:
        self.lines: List[str] = []
        self.record = RequestLog(self.lines.append, self.lines.append)
        self.forwarder = Forwarder(bind("127.0.0.1", 0, "~pubsubport"), self.record, **options)
        self.background = Background((self.forwarder,), self.record.count)
        self.background.start()
        self.held: List[socket.socket] = []

    def connect(self) -> socket.socket:
        self.held.append(connected(self.forwarder.port))
        return self.held[-1]

    def wait(self, subscribers: int) -> None:
        until(lambda: self.forwarder.subscribers == subscribers, f"{subscribers} subscribers")

    def send(self, topic: str, data: str, latched: bool = False) -> None:
        self.background.call(self.forwarder.send, topic, data, latched)

    def close(self) -> None:
        self.background.close()
        for there in self.held:
            there.close()


@pytest.fixture
def stage() -> Iterator[Callable[..., Stage]]:
    started: List[Stage] = []

    def start(**options: int) -> Stage:
        started.append(Stage(**options))
        return started[-1]

    yield start
    for each in started:
        each.close()


def lines(there: socket.socket, count: int) -> List[Dict[str, Any]]:
    with there.makefile("rb") as file:
        return [json.loads(file.readline()) for _ in range(count)]


def test_every_subscriber_receives_every_message_in_a_line_of_its_own(stage: Callable[..., Stage]) -> None:
    here = stage()
    listeners = [here.connect() for _ in range(3)]
    here.wait(3)
    here.send("pursue/events", "bot1_a2b")
    here.send("pursue/system_state", "seq=1\nbot1=a\n\nCbot1=0.5 é")
    for there in listeners:
        assert lines(there, 2) == [
            {"topic": "pursue/events", "data": "bot1_a2b"},
            {"topic": "pursue/system_state", "data": "seq=1\nbot1=a\n\nCbot1=0.5 é"},
        ]


def test_a_newcomer_receives_the_last_of_latched_topics_and_no_other_message(stage: Callable[..., Stage]) -> None:
    here = stage()
    here.send("state", "1", latched=True)
    here.send("state", "2", latched=True)
    here.send("events", "old")
    there = here.connect()
    here.wait(1)
    here.send("events", "new")
    assert lines(there, 2) == [{"topic": "state", "data": "2"}, {"topic": "events", "data": "new"}]


def test_whoever_goes_leaves_room_and_there_is_no_more(stage: Callable[..., Stage]) -> None:
    here = stage(subscribers=2)
    first = here.connect()
    here.connect()
    here.wait(2)
    assert here.connect().recv(10) == b""
    assert here.record.counts == {"turned away": 1}
    first.close()
    here.wait(1)
    there = here.connect()
    here.wait(2)
    here.send("t", "x")
    assert lines(there, 1) == [{"topic": "t", "data": "x"}]


def test_who_does_not_read_is_given_up_and_others_hear_on(stage: Callable[..., Stage]) -> None:
    here = stage(backlog=1 << 16)
    with socket.socket() as idle:
        idle.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        idle.settimeout(PATIENCE)
        idle.connect(("127.0.0.1", here.forwarder.port))
        reader = here.connect()
        here.wait(2)
        with reader.makefile("rb") as file:
            for number in range(2000):
                here.send("t", f"{number} " + "x" * 20000)
                assert json.loads(file.readline())["data"].startswith(f"{number} ")
                if here.forwarder.subscribers == 1:
                    break
        assert here.forwarder.subscribers == 1
        assert here.record.counts["given up"] == 1


def test_what_subscribers_send_is_ignored_and_too_much_of_it_ends_the_connection(stage: Callable[..., Stage]) -> None:
    here = stage()
    there = here.connect()
    there.sendall(b'{"topic": "pursue/events", "data": "_stop_"}\n\x00\xff')
    here.wait(1)
    here.send("t", "x")
    assert lines(there, 1) == [{"topic": "t", "data": "x"}], "and nothing of it comes back"
    with pytest.raises(OSError):
        for _ in range(10000):
            there.sendall(b"x" * 10000)
    here.wait(0)


def test_a_message_that_is_too_long_is_not_forwarded_and_said(stage: Callable[..., Stage]) -> None:
    here = stage()
    there = here.connect()
    here.wait(1)
    here.send("t", "x" * MAX_LINE, latched=True)
    here.send("t", "short")
    assert lines(there, 1) == [{"topic": "t", "data": "short"}]
    assert "too long" in here.lines[0] and "xxx" not in here.lines[0]


def test_the_end_closes_all_and_the_port_is_free(stage: Callable[..., Stage]) -> None:
    here = stage()
    there = here.connect()
    here.wait(1)
    here.background.close()
    assert there.recv(10) == b""
    here.send("t", "nobody hears this, and nothing happens")
    for taken in bind("127.0.0.1", here.forwarder.port, "~pubsubport"):
        taken.close()
