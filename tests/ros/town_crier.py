#!/usr/bin/env python3
"""A node of the tests: says what it is told on String topics, and writes down what is said on others.

Standard input: one JSON object a line, {"topic": …, "data": …}; each topic is latched, and the first word on it waits
until somebody listens. Standard output: the same for what is heard. Usage: town_crier.py TOPIC… (those it listens to).
"""

from __future__ import annotations

import json
import sys
import time
from typing import Dict

import rospy
from std_msgs.msg import String


def write(message: String, topic: str) -> None:
    """Something was said."""
    sys.stdout.write(json.dumps({"topic": topic, "data": message.data}) + "\n")
    sys.stdout.flush()


def main() -> None:
    rospy.init_node("town_crier", disable_signals=True)
    for topic in sys.argv[1:]:
        rospy.Subscriber(topic, String, write, callback_args=topic, queue_size=1000)
    voices: Dict[str, rospy.Publisher] = {}
    for line in sys.stdin:
        word = json.loads(line)
        topic = word["topic"]
        if topic not in voices:
            voices[topic] = rospy.Publisher(topic, String, queue_size=1000, latch=True)
        deadline = time.monotonic() + 120
        while not voices[topic].get_num_connections() and time.monotonic() < deadline:
            time.sleep(0.02)
        voices[topic].publish(word["data"])
    rospy.signal_shutdown("all is said")


if __name__ == "__main__":
    main()
