"""What nodes do with a publisher beside publishing: who is connected, who is served first, a message for one alone."""

from __future__ import annotations

import contextlib
import socket
import time
from functools import partial
from typing import Any, Callable, List

import rospy
from rospy.impl.tcpros_pubsub import QueuedConnection
from std_msgs.msg import String

from pursue_runtime.event_words import REPORTED


def listeners(publisher: rospy.Publisher) -> List[str]:
    """The names of the nodes that are connected to what we publish there."""
    return sorted({connection[1] for connection in publisher.impl.get_stats_info()})


def is_recorder(node: str) -> bool:
    """Return True for the name of a node that only records messages: the mission's recorder, or rosbag."""
    return node.strip("/").rsplit("/", 1)[-1].startswith(("recorder", "record_"))


def is_connected(publisher: rospy.Publisher, node: str) -> bool:
    """Return True if the node of this name is connected to what we publish there."""
    return bool(publisher.impl.has_connection(node))


def publish_to_one(publisher: rospy.Publisher, peer_publish: Callable[[Any], None], message: Any) -> None:
    """Publish a message to one subscriber alone, with the function that rospy passes to `peer_subscribe`.

    That function serializes into a buffer that all calls share, and leaves the lock to its caller: without it, messages
    that two threads publish at the same time are mixed. Raises rospy.ROSException where the topic is closed.
    """
    if publisher.impl is None:
        raise rospy.ROSException(f"{publisher.name} is closed")
    _publish_locked(publisher.impl, peer_publish, message)


def _publish_locked(impl: Any, peer_publish: Callable[[Any], object], message: Any) -> None:
    impl.acquire()
    try:
        peer_publish(message)
    finally:
        impl.release()


class ServedFirst(rospy.SubscribeListener):
    """Has rospy send what is published on a topic to chosen nodes first, and at once.

    rospy wakes the threads of its connections one after the other, in the order in which they were made. Each node that
    is woken takes processor time, so on a machine with few cores chance would decide how soon a controller has a state.
    """

    def __init__(self, publisher: rospy.Publisher, is_first: Callable[[str], bool]) -> None:
        """`is_first` returns True for the names (as rospy has them) of the nodes that come first; it is called whenever
        a node connects, in any thread, and by `arrange`."""
        super().__init__()
        self._impl, self._is_first = publisher.impl, is_first
        self._impl.add_subscriber_listener(self)
        self.arrange()

    def peer_subscribe(self, topic_name: str, topic_publish: object, peer_publish: object) -> None:
        """A node has connected (rospy calls this)."""
        self.arrange()

    def arrange(self) -> None:
        """Put the connections in order: to be called when `is_first` returns something else than before."""
        with self._impl.c_lock:
            connections = sorted(self._impl.connections, key=lambda each: not self._is_first(each.endpoint_id))
            for connection in connections:
                is_queued = isinstance(connection, QueuedConnection) and "write_data" not in vars(connection)
                if is_queued and self._is_first(connection.endpoint_id):
                    connection.write_data = AtOnce(connection).write
            self._impl.connections = connections


class Newcomers(rospy.SubscribeListener):
    """Calls `on_observer` when an observer has connected to what is published on pursue/events, also one that was
    restarted, and then tells it that this node has said all that it has to report.

    What is published in `on_observer` comes to the observer before that.
    """

    def __init__(
        self, publisher: rospy.Publisher, is_observer: Callable[[str], bool], on_observer: Callable[[], None]
    ) -> None:
        """`is_observer` returns True for the name of the node that publishes the states; both are called in a thread of
        rospy's."""
        super().__init__()
        self._impl, self._is_observer, self._on_observer = publisher.impl, is_observer, on_observer
        self._known: List[object] = list(self._impl.connections)
        self._impl.add_subscriber_listener(self)

    def peer_subscribe(self, topic_name: str, topic_publish: object, peer_publish: object) -> None:
        """A node has connected (rospy calls this, and does not say which one)."""
        with self._impl.c_lock:
            connections = list(self._impl.connections)
            new = [each for each in connections if each not in self._known and self._is_observer(each.endpoint_id)]
            self._known = connections
        if new:
            self._on_observer()
        for connection in new:
            with contextlib.suppress(rospy.ROSException):  # the node is going down
                publish = partial(self._impl.publish, connection_override=connection)
                _publish_locked(self._impl, publish, String(REPORTED))


class AtOnce:
    """Writes messages to a subscriber in the thread that publishes them, where the subscriber reads.

    rospy passes each message to a thread of the connection, and a reaction would wait until that runs. Here it gets
    only what the system does not take at once, and what is published until it has sent that: the order stays, and a
    subscriber that does not read holds nothing up.
    """

    def __init__(self, connection: QueuedConnection) -> None:
        self._connection = connection
        self._rest = b""  # of a message of which a part was written; where it is in the queue, it is the first there

    def write(self, data: bytes) -> bool:
        """Write a message; in place of the connection's `write_data`, whose errors it raises."""
        there, changed = self._connection, self._connection._cond_data_available
        with changed:
            if there._error is not None:
                error, there._error = there._error, None
                raise error
            queue: List[bytes] = there._queue
            if not queue and changed._waiters:  # the thread waits: nothing is on the way
                sent = _sent(there._connection, data)
                if sent == len(data):
                    return True
                data = self._rest = data[sent:]
            elif there._queue_size and len(queue) >= there._queue_size:
                oldest = int(queue[0] is self._rest)
                del queue[oldest : oldest + 1]
            queue.append(data)
            changed.notify()
        time.sleep(0)  # as rospy does: the thread may begin
        return True


def _sent(transport: Any, data: bytes) -> int:
    """The number of bytes that could be written at once. What is wrong with the connection, its thread will find."""
    try:
        sent = int(transport.socket.send(data, socket.MSG_DONTWAIT))
    except (OSError, AttributeError):  # it has no socket any more
        return 0
    transport.stat_bytes += sent
    transport.stat_num_msg += sent == len(data)  # else the thread counts it
    return sent
