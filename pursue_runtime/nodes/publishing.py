"""What nodes do with a publisher beside publishing: who is connected, who is served first, a message for one alone."""

from __future__ import annotations

from typing import Any, Callable, List

import rospy


def listeners(publisher: rospy.Publisher) -> List[str]:
    """The names of the nodes that are connected to what we publish there."""
    return sorted({connection[1] for connection in publisher.impl.get_stats_info()})


def is_connected(publisher: rospy.Publisher, node: str) -> bool:
    """Return True if the node of this name is connected to what we publish there."""
    return bool(publisher.impl.has_connection(node))


def publish_to_one(publisher: rospy.Publisher, peer_publish: Callable[[Any], None], message: Any) -> None:
    """Publish a message to one subscriber alone, with the function that rospy passes to `peer_subscribe`.

    That function serializes into a buffer that all calls share, and leaves the lock to its caller: without it, messages
    that two threads publish at the same time are mixed. Raises rospy.ROSException where the topic is closed.
    """
    impl = publisher.impl
    if impl is None:
        raise rospy.ROSException(f"{publisher.name} is closed")
    impl.acquire()
    try:
        peer_publish(message)
    finally:
        impl.release()


class ServedFirst(rospy.SubscribeListener):
    """Has rospy send what is published on a topic to chosen nodes first.

    rospy wakes its connections one after the other, in the order in which they were made. Each node that is woken takes
    processor time, so on a machine with few cores chance would decide how soon a controller has a state.
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
            connections = self._impl.connections
            self._impl.connections = sorted(connections, key=lambda each: not self._is_first(each.endpoint_id))
