"""Each event that the observer has taken, without agent and number, for nodes that were written for the thesis's words.

The topic is not pursue/events: a command without its number would be heard there as a report.
"""

from __future__ import annotations

import rospy
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS, FINISH, PLAIN_WORDS
from pursue_runtime.parameters import ParameterError
from pursue_runtime.state import ENDED, WON, SystemState


class PlainWords:
    """Publishes the events of the states that follow `known`, each once, and `Finish!` when the mission is won."""

    def __init__(self, known: SystemState) -> None:
        """Raises ParameterError where the topic is remapped to one on which words count."""
        if rospy.resolve_name(PLAIN_WORDS) == rospy.resolve_name(EVENTS):
            raise ParameterError(f"{PLAIN_WORDS} is remapped to {EVENTS}, where its words would count as reports")
        self._seq, self._ended = known.seq, known.status in ENDED
        self._publisher = rospy.Publisher(PLAIN_WORDS, String, queue_size=1000, tcp_nodelay=True)

    def on_state(self, state: SystemState) -> None:
        """Publish what led to a state. Raises rospy.ROSException while the node is going down."""
        if state.seq > self._seq:
            self._seq = state.seq
            if state.event:
                self._publisher.publish(state.event)
        if state.status in ENDED and not self._ended:
            self._ended = True
            if state.status == WON:
                self._publisher.publish(FINISH)
