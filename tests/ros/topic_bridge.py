#!/usr/bin/env python3
"""A node of the tests: publishes what it reads, and prints what comes on other topics of type String.

Standard input: one JSON object a line, {"topic": …, "data": …}, a text, or the fields of a SystemState; each topic is
latched, and the first message on it waits for a subscriber. Standard output: the same for each message received. Usage:
topic_bridge.py TOPIC… (those it subscribes to).
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any, Dict

import genpy
import rospy
from pursue_msgs.msg import SystemState
from std_msgs.msg import String


def write(message: String, topic: str) -> None:
    """Prints a message that was received."""
    sys.stdout.write(json.dumps({"topic": topic, "data": message.data}) + "\n")
    sys.stdout.flush()


def message_of(data: Any) -> genpy.Message:
    """The message with this text, or with these fields."""
    if isinstance(data, str):
        return String(data)
    message = SystemState()
    genpy.message.fill_message_args(message, [data])
    return message


def main() -> None:
    rospy.init_node("topic_bridge", disable_signals=True)
    for topic in sys.argv[1:]:
        rospy.Subscriber(topic, String, write, callback_args=topic, queue_size=1000)
    publishers: Dict[str, rospy.Publisher] = {}
    for line in sys.stdin:
        entry = json.loads(line)
        topic, message = entry["topic"], message_of(entry["data"])
        if topic not in publishers:
            publishers[topic] = rospy.Publisher(topic, type(message), queue_size=1000, latch=True)
        deadline = time.monotonic() + 120
        while not publishers[topic].get_num_connections() and time.monotonic() < deadline:
            time.sleep(0.02)
        publishers[topic].publish(message)
    rospy.signal_shutdown("the end of the input")


if __name__ == "__main__":
    main()
