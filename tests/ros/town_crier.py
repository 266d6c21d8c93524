#!/usr/bin/env python3
"""A node of the tests: says what it is told on topics, and writes down what is said on others, of type String.

Standard input: one JSON object a line, {"topic": …, "data": …}, a text, or the fields of a SystemState; each topic is
latched, and the first word on it waits until somebody listens. Standard output: the same for what is heard. Usage:
town_crier.py TOPIC… (those it listens to).
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
    """Something was said."""
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
    rospy.init_node("town_crier", disable_signals=True)
    for topic in sys.argv[1:]:
        rospy.Subscriber(topic, String, write, callback_args=topic, queue_size=1000)
    voices: Dict[str, rospy.Publisher] = {}
    for line in sys.stdin:
        word = json.loads(line)
        topic, message = word["topic"], message_of(word["data"])
        if topic not in voices:
            voices[topic] = rospy.Publisher(topic, type(message), queue_size=1000, latch=True)
        deadline = time.monotonic() + 120
        while not voices[topic].get_num_connections() and time.monotonic() < deadline:
            time.sleep(0.02)
        voices[topic].publish(message)
    rospy.signal_shutdown("all is said")


if __name__ == "__main__":
    main()
