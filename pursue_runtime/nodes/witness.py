"""The second witness of a mission on ROS: a node that follows the mission publishes on `pursue/seen` which state it has
seen last, for an observer that was restarted.
"""

from __future__ import annotations

import time
from typing import Callable, Dict, List, Optional

import rosgraph
import rospy
from pursue_msgs.msg import SystemState as Message

from pursue_runtime.event_words import EVENTS, SEEN
from pursue_runtime.nodes.links import is_gone
from pursue_runtime.nodes.node import Ending
from pursue_runtime.nodes.publishing import listeners, publish_to_one
from pursue_runtime.nodes.state_message import message_of, subscribe_states
from pursue_runtime.observer.witnesses import PATIENCE
from pursue_runtime.state import LIVE, WAITING, SystemState

AGAIN = 0.1
"""Seconds of real time between two looks at which of them are still there."""

CONNECTED = 1.0
"""Seconds of real time for which it waits until these nodes receive its states."""

NOTHING = SystemState(0, 0.0, {}, {}, {}, status=WAITING)
"""What a node publishes that has seen no state."""


class Witness(rospy.SubscribeListener):
    """Publishes the newest state that the node has seen to whoever subscribes, once; and to all with `publish`."""

    def __init__(self, newest: Callable[[], Optional[SystemState]]) -> None:
        """`newest` is called in any thread."""
        super().__init__()
        self._newest = newest
        self._publisher: Optional[rospy.Publisher] = None
        self._publisher = rospy.Publisher(SEEN, Message, subscriber_listener=self, queue_size=10, tcp_nodelay=True)
        self.publish()  # for those that subscribed before we listened

    def peer_subscribe(self, _: str, __: object, peer_publish: Callable[[Message], None]) -> None:
        """Publish the newest state to a new subscriber."""
        if self._publisher is not None:
            publish_to_one(self._publisher, peer_publish, self._message())

    def publish(self) -> None:
        """Publish the newest state to all subscribers."""
        if self._publisher is not None:
            self._publisher.publish(self._message())

    def _message(self) -> Message:
        return message_of(self._newest() or NOTHING)


class Witnesses:
    """The observer's side: `seen` has the last answer of each node."""

    def __init__(self, ending: Ending) -> None:
        self.seen: Dict[str, SystemState] = {}
        self._ending = ending
        self._on_state: Optional[Callable[[SystemState, str], None]] = None
        subscribe_states(self._receive, ending, topic=SEEN)

    def gather(self) -> None:
        """Return when every node that publishes there has answered, or does not live any more; at the latest after
        PATIENCE."""
        deadline = time.monotonic() + PATIENCE
        missing = self._missing()
        while missing and time.monotonic() < deadline and not self._ending.called:
            again = time.monotonic() + AGAIN
            while any(node not in self.seen for node in missing) and time.monotonic() < again:
                time.sleep(0.01)
            missing = [node for node in missing if node not in self.seen and not is_gone(node)]
        if missing:
            rospy.logwarn("no answer on %s from %s", SEEN, ", ".join(missing))

    def await_subscribers(self, states: rospy.Publisher) -> None:
        """Return when every node that has answered receives the states again, at the latest after CONNECTED: nodes and
        recordings then miss none."""
        deadline = time.monotonic() + CONNECTED
        while not self._ending.called and time.monotonic() < deadline and not set(self.seen) <= set(listeners(states)):
            time.sleep(0.01)

    def follow(self, on_state: Callable[[SystemState, str], None]) -> None:
        """Pass every answer to `on_state` from now on, with the node's name, and first the last one of each node."""
        self._on_state = on_state
        for node, state in list(self.seen.items()):
            on_state(state, node)

    def reporting(self, mission: str) -> List[str]:
        """Return the nodes that have seen this mission under way and may have something to report: they publish words.
        """
        there = [node for node, state in self.seen.items() if state.mission == mission and state.status in LIVE]
        return sorted(set(there) & set(_publishers(EVENTS))) if there else []

    def _missing(self) -> List[str]:
        """The nodes that publish there, as far as the master knows, and have not answered."""
        return [node for node in _publishers(SEEN) if node not in self.seen and node != rospy.get_name()]

    def _receive(self, state: SystemState, publisher: str) -> None:
        self.seen[publisher] = state
        if self._on_state is not None:
            self._on_state(state, publisher)


def _publishers(topic: str) -> List[str]:
    """The nodes that publish on a topic, as far as the master knows; none where it does not answer."""
    try:
        publishers = dict(rosgraph.Master(rospy.get_name()).getSystemState()[0])
    except (OSError, rosgraph.MasterException) as problem:
        rospy.logwarn("the master does not say who publishes on %s: %s", topic, problem)
        return []
    return list(publishers.get(rospy.resolve_name(topic), []))
