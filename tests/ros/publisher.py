"""A node of the tests: publishes what it reads, as `rostopic pub --once` would, and writes each line when it is sent.

Standard input: [topic, type, message in YAML] as JSON, one a line. A message is sent once all that are subscribed to
its topic are connected, and at least one is.
"""

from __future__ import annotations

import json
import sys
import time
from typing import Any, Dict

import rosgraph
import roslib.message
import rospy
import yaml
from genpy.message import fill_message_args

PATIENCE = 120.0
"""Seconds after which nobody is expected to subscribe any more."""


def number_of_subscribers(topic: str) -> int:
    """How many nodes are subscribed to it, as the master knows."""
    _, subscribers, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    return sum(len(nodes) for name, nodes in subscribers if name == topic)


def main() -> None:
    rospy.init_node("publisher", anonymous=True, disable_rosout=True)
    publishers: Dict[str, Any] = {}
    for line in sys.stdin:
        topic, kind, text = json.loads(line)
        if topic not in publishers:
            publishers[topic] = rospy.Publisher(topic, roslib.message.get_message_class(kind), queue_size=None)
        publisher = publishers[topic]
        message = publisher.data_class()
        fill_message_args(message, [yaml.safe_load(text)])
        deadline = time.monotonic() + PATIENCE
        while publisher.get_num_connections() < max(1, number_of_subscribers(publisher.resolved_name)):
            if rospy.is_shutdown() or time.monotonic() > deadline:
                sys.exit(1)
            time.sleep(0.02)
        publisher.publish(message)
        print(line, end="", flush=True)


if __name__ == "__main__":
    main()
