"""Who decides about robots gets a message before all others, whenever it has connected."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, List, Set

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from rospy.topics import _PublisherImpl
from std_msgs.msg import String

from pursue_runtime.nodes.publishing import ServedFirst


class Subscriber:
    """A connection that notes in `served` when it is sent something."""

    cleanup_cb = None

    def __init__(self, name: str, served: List[str]) -> None:
        self.endpoint_id, self._served = name, served

    def set_cleanup_callback(self, callback: object) -> None:
        """rospy's callback for the end of the connection; it does not end here."""

    def fileno(self) -> None:
        """There is no socket."""

    def write_data(self, data: bytes) -> None:
        self._served.append(self.endpoint_id)


class Topic:
    """A topic with its publisher."""

    def __init__(self) -> None:
        self.served: List[str] = []
        self.impl = _PublisherImpl("/topic", String)
        self.publisher: Any = SimpleNamespace(impl=self.impl)

    def connect(self, *names: str) -> None:
        """These nodes connect, one after the other."""
        for name in names:
            self.impl.add_connection(Subscriber(name, self.served))

    def served_by_one_message(self) -> List[str]:
        """The subscribers in the order in which they get a message."""
        del self.served[:]
        self.impl.publish(String("text"))
        return list(self.served)


def test_rospy_alone_serves_nodes_in_the_order_of_their_connections() -> None:
    """Why it is needed: where this fails, rospy has an order of its own."""
    topic = Topic()
    topic.connect("/UI", "/controller_a", "/simulator")
    assert topic.served_by_one_message() == ["/UI", "/controller_a", "/simulator"]


def test_chosen_nodes_come_first_whether_they_connect_before_or_after() -> None:
    topic = Topic()
    topic.connect("/UI", "/controller_a")
    ServedFirst(topic.publisher, lambda node: node.startswith("/controller"))
    assert topic.served_by_one_message() == ["/controller_a", "/UI"]
    topic.connect("/simulator", "/controller_b", "/recorder")
    assert topic.served_by_one_message() == ["/controller_a", "/controller_b", "/UI", "/simulator", "/recorder"]


def test_it_learns_later_who_comes_first() -> None:
    topic = Topic()
    names: Set[str] = set()
    order = ServedFirst(topic.publisher, names.__contains__)
    topic.connect("/UI", "/probe", "/observer")
    assert topic.served_by_one_message() == ["/UI", "/probe", "/observer"]
    names.add("/observer")
    order.arrange()
    assert topic.served_by_one_message() == ["/observer", "/UI", "/probe"]


def test_a_node_that_connects_anew_keeps_its_place() -> None:
    topic = Topic()
    ServedFirst(topic.publisher, lambda node: node == "/observer")
    topic.connect("/observer", "/UI")
    topic.connect("/observer")
    assert topic.served_by_one_message()[0] == "/observer"
