"""A message is written by the thread that publishes it, in the order of publishing; who does not read delays nobody."""

from __future__ import annotations

import socket
import threading
from types import SimpleNamespace
from typing import Any, Iterator, List, Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.waiting import PATIENCE, until

pytest.importorskip("rospy", reason="ROS is not installed")

from rospy.impl.tcpros_pubsub import QueuedConnection

from pursue_runtime.nodes.publishing import AtOnce, ServedFirst


class Transport:
    """rospy's side of a connection, without the protocol; `threads` has written through `write_data`."""

    def __init__(self, ours: socket.socket) -> None:
        self.socket, self.done, self.stat_bytes, self.stat_num_msg = ours, False, 0, 0
        self.threads: List[str] = []

    def set_cleanup_callback(self, callback: object) -> None:
        """rospy's callback for the end of the connection."""
        self.cleanup: Any = callback

    def write_data(self, data: bytes) -> bool:
        self.threads.append(threading.current_thread().name)
        self.socket.sendall(data)
        self.stat_bytes += len(data)
        self.stat_num_msg += 1
        return True


class Link:
    """A connection to a subscriber, which reads when it is told to."""

    def __init__(self, queue_size: int = 1000) -> None:
        ours, self.theirs = socket.socketpair()
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
        self.theirs.settimeout(PATIENCE)
        self.transport = Transport(ours)
        self.connection = QueuedConnection(self.transport, queue_size)
        self.write = AtOnce(self.connection).write
        until(self.is_idle, "the thread of the connection waits")

    def is_idle(self) -> bool:
        """True while the connection's thread has nothing to do."""
        with self.connection._lock:
            return not self.connection._queue and bool(self.connection._cond_data_available._waiters)

    def read(self, size: int) -> bytes:
        """So many bytes."""
        found = b""
        while len(found) < size:
            found += self.theirs.recv(size - len(found))
        return found

    def close(self) -> None:
        self.transport.done = True
        for end in (self.theirs, self.transport.socket):
            end.close()
        self.transport.cleanup(self.transport)
        self.connection._thread.join(PATIENCE)


@pytest.fixture
def link() -> Iterator[Link]:
    made = Link()
    yield made
    made.close()


def test_a_message_does_not_wait_for_a_thread(link: Link) -> None:
    for number in range(3):
        assert link.write(b"state %d" % number)
        assert link.read(7) == b"state %d" % number
    assert link.transport.threads == []
    assert (link.transport.stat_num_msg, link.transport.stat_bytes) == (3, 21)


def test_a_subscriber_that_does_not_read_holds_nothing_up(link: Link) -> None:
    messages = [bytes([65 + number % 26]) * 3000 for number in range(200)]
    for message in messages:
        assert link.write(message)
    assert link.transport.stat_num_msg < 100, "the others wait"
    assert link.read(200 * 3000) == b"".join(messages)
    until(link.is_idle, "the thread has sent everything")
    assert link.transport.stat_num_msg == 200 and link.transport.stat_bytes == 200 * 3000
    before = len(link.transport.threads)
    assert link.write(b"next") and link.read(4) == b"next" and len(link.transport.threads) == before


@given(st.lists(st.tuples(st.integers(1, 9000), st.booleans()), max_size=30))
def test_everything_comes_once_and_in_order(steps: List[Tuple[int, bool]]) -> None:
    link, unread = Link(), b""
    for number, (size, reads) in enumerate(steps):
        message = bytes([number % 251]) * size
        assert link.write(message)
        unread += message
        if reads:
            some = len(unread) // 2
            assert link.read(some) == unread[:some]
            unread = unread[some:]
    assert link.read(len(unread)) == unread
    link.close()


def test_where_the_queue_is_full_whole_messages_are_dropped_the_oldest_first() -> None:
    """The rest of a message that was written in part stays: without it, no later message could be read."""
    link = Link(queue_size=3)
    ready = link.connection._cond_data_available
    real, ready.notify = ready.notify, lambda: None  # the thread sleeps on
    first = b"x" * 10_000_000
    messages = [bytes([97 + number]) * 5 for number in range(6)]
    link.write(first)
    waiters, ready._waiters = ready._waiters, type(ready._waiters)()  # as after a notification
    for message in messages:
        link.write(message)
    ready._waiters, ready.notify = waiters, real
    with ready:
        ready.notify()
    assert link.read(len(first)) == first
    assert link.read(10) == b"".join(messages[-2:])
    link.close()


def test_a_connection_is_changed_once(link: Link) -> None:
    """What a second change would not know is how much of a message has been written."""
    impl = SimpleNamespace(c_lock=threading.RLock(), connections=[link.connection], add_subscriber_listener=lambda _: 0)
    link.connection.endpoint_id = "/observer"
    publisher: Any = SimpleNamespace(impl=impl)
    order = ServedFirst(publisher, lambda node: node == "/observer")
    first = link.connection.write_data
    order.arrange()
    assert link.connection.write_data is first
    assert first(b"state") and link.read(5) == b"state" and link.transport.threads == []


def test_a_connection_that_is_gone_is_an_error_as_with_rospy(link: Link) -> None:
    link.theirs.close()

    def fails() -> bool:
        try:
            link.write(b"state")
        except OSError:
            return True
        return False

    until(fails, "the error of the thread that could not write")
