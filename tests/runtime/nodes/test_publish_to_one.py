"""A message to one subscriber is published under the publisher's lock, which rospy's own function does not take."""

from __future__ import annotations

import struct
import threading
from types import SimpleNamespace
from typing import Any, Callable, List

import pytest

from tests.waiting import PATIENCE, until

pytest.importorskip("rospy", reason="ROS is not installed")

from rospy.topics import SubscribeListener, _PublisherImpl
from std_msgs.msg import String

from pursue_runtime.nodes.publishing import publish_to_one
from pursue_runtime.nodes.robot_link import Message

ALL, ONE = "for every subscriber", "for one"
Send = Callable[[Any, Callable[[Any], None], Any], None]


class Slow(String):  # type: ignore[misc]
    """A message whose serialization stops half way, until it may go on."""

    def __init__(self) -> None:
        super().__init__(ALL)
        self.begun, self.may_go_on = threading.Event(), threading.Event()

    def serialize(self, buff: Any) -> None:
        data = self.data.encode()
        buff.write(struct.pack("<I", len(data)) + data[:5])
        self.begun.set()
        assert self.may_go_on.wait(PATIENCE)
        buff.write(data[5:])


class Lock:
    """A lock that says when it has to wait."""

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self.waits = threading.Event()

    def acquire(self) -> None:
        if not self._lock.acquire(blocking=False):
            self.waits.set()
            self._lock.acquire()

    def release(self) -> None:
        self._lock.release()


class Subscriber:
    """A connection that keeps what is sent."""

    endpoint_id, cleanup_cb = "http://somewhere", None

    def __init__(self) -> None:
        self.sent: List[bytes] = []

    def set_cleanup_callback(self, callback: object) -> None:
        """rospy's callback for the end of the connection; it does not end here."""

    def fileno(self) -> None:
        """There is no socket."""

    def write_data(self, data: bytes) -> None:
        self.sent.append(data)

    def received(self) -> List[str]:
        """The messages, as a subscriber reads them. Raises struct.error, or anything else, where they are mixed."""
        stream, texts = b"".join(self.sent), []
        while stream:
            length, text = struct.unpack_from("<II", stream)
            assert length == text + 4, stream
            texts.append(stream[8:4 + length].decode())
            stream = stream[4 + length:]
        return texts


class Newcomer(SubscribeListener):  # type: ignore[misc]
    """Keeps the function that publishes to a subscriber that has connected."""

    peer_publish: Callable[[Any], None]

    def peer_subscribe(self, topic: str, publish: object, peer_publish: Callable[[Any], None]) -> None:
        self.peer_publish = peer_publish


def both(send: Send) -> Subscriber:
    """What a subscriber gets when a message for it alone is published while one for all is being serialized."""
    impl, newcomer, subscriber, message = _PublisherImpl("/topic", String), Newcomer(), Subscriber(), Slow()
    impl.publock = lock = Lock()
    impl.add_subscriber_listener(newcomer)
    impl.add_connection(subscriber)
    publisher: Any = SimpleNamespace(impl=impl)

    def to_all() -> None:
        impl.acquire()  # as rospy.Publisher.publish does
        try:
            impl.publish(message)
        finally:
            impl.release()

    first = threading.Thread(target=to_all)
    second = threading.Thread(target=send, args=(publisher, newcomer.peer_publish, String(ONE)))
    first.start()
    assert message.begun.wait(PATIENCE)
    second.start()
    until(lambda: lock.waits.is_set() or not second.is_alive(), "the second is published, or waits for the lock")
    message.may_go_on.set()
    for thread in (first, second):
        thread.join(PATIENCE)
        assert not thread.is_alive()
    return subscriber


def order_again(publisher: Any, peer_publish: Callable[[Any], None], message: Any) -> None:
    """As a controller sends its order to a robot that connects late."""
    Message("", publisher, message).publish(peer_publish)


@pytest.mark.parametrize("send", [publish_to_one, order_again])
def test_a_message_to_one_subscriber_waits_for_a_message_to_all(send: Send) -> None:
    assert both(send).received() == [ALL, ONE]


def test_without_the_lock_rospy_mixes_the_two() -> None:
    """Why the function is needed: where this fails, rospy takes the lock itself."""
    subscriber = both(lambda _, peer_publish, message: peer_publish(message))
    with pytest.raises((AssertionError, struct.error, UnicodeDecodeError)):
        assert subscriber.received() == [ONE, ALL]


def test_the_lock_is_released_where_publishing_fails() -> None:
    lock = Lock()
    publisher: Any = SimpleNamespace(impl=lock)

    def fail(_: object) -> None:
        raise ValueError

    with pytest.raises(ValueError):
        publish_to_one(publisher, fail, String())
    thread = threading.Thread(target=lock.acquire)
    thread.start()
    thread.join(PATIENCE)
    assert not thread.is_alive() and not lock.waits.is_set()
