"""An observer that connects hears again what was not answered, and then that this is all."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, List

import pytest

pytest.importorskip("rospy", reason="ROS is not installed")

from rospy.topics import _PublisherImpl
from std_msgs.msg import String

from pursue_runtime.event_words import REPORTED
from pursue_runtime.nodes.publishing import Newcomers
from tests.runtime.nodes.test_publish_to_one import Lock, Subscriber


class Node(Subscriber):
    """A connection to a node of this name."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.endpoint_id = name


class Sender:
    """A node that publishes words, and has something to report."""

    def __init__(self) -> None:
        self.impl = _PublisherImpl("/pursue/events", String)
        self.impl.publock = Lock()
        self.observer, self.asked = "", 0
        publisher: Any = SimpleNamespace(impl=self.impl)
        Newcomers(publisher, lambda node: node == self.observer, self.say_again)

    def say_again(self) -> None:
        """What is not answered is published to everybody."""
        self.asked += 1
        self.impl.publish(String("report"))

    def connects(self, name: str) -> Node:
        """A node connects."""
        node = Node(name)
        self.impl.add_connection(node)
        return node


def received(nodes: List[Node]) -> List[List[str]]:
    return [node.received() for node in nodes]


def test_an_observer_that_connects_hears_the_reports_and_then_that_these_are_all() -> None:
    sender = Sender()
    other = sender.connects("/recorder")
    sender.observer = "/observer"
    observer = sender.connects("/observer")
    assert received([other, observer]) == [["report"], ["report", REPORTED]]
    later = sender.connects("/rostopic")
    assert received([later]) == [[]] and sender.asked == 1


def test_each_observer_that_is_started_anew_hears_them() -> None:
    sender = Sender()
    sender.observer = "/observer"
    for number in (1, 2, 3):
        observer = sender.connects("/observer")
        assert observer.received() == ["report", REPORTED] and sender.asked == number


def test_an_observer_that_was_there_before_its_first_state_is_no_newcomer() -> None:
    sender = Sender()
    observer = sender.connects("/observer")
    sender.observer = "/observer"
    sender.connects("/recorder")
    assert observer.received() == [] and sender.asked == 0
