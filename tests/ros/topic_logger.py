#!/usr/bin/env python3
"""A node of the tests: logs the messages of a mission, and publishes what it reads, one JSON object a line.

Standard output: {"at": seconds of a monotonic clock, "topic": …, "from": node, "data": …}, and for goals and actions
"robot". Standard input: {"publish": [texts]}, {"bytes": [hexadecimal texts]} (what is on the wire, right or wrong), or
{"repeat": [seconds]}: from now on each event of another node is published again after so many seconds.

rospy may not learn of a publisher that was started anew: the logger looks for those that it is not connected to.

Usage: topic_logger.py ROBOT…
"""

from __future__ import annotations

import json
import struct
import sys
import threading
import time
from typing import Any, BinaryIO, List

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import String

from pursue_runtime.nodes.links import ask_master, connect_missing
from pursue_runtime.nodes.node import init_node


class Bytes(String):
    """A string message whose text is bytes of any kind."""

    def serialize(self, buff: BinaryIO) -> None:
        """As a publisher in another language might."""
        buff.write(struct.pack(f"<I{len(self.data)}s", len(self.data), self.data))


class TopicLogger:
    """The node."""

    def __init__(self, robots: List[str]) -> None:
        self.lock = threading.Lock()
        self.delays: List[float] = []
        self.publisher = rospy.Publisher("pursue/events", String, queue_size=10000)
        self.raw = rospy.Publisher("pursue/events", Bytes, queue_size=1000)
        for topic, kind in (
            ("pursue/events", String),
            ("pursue/system_state", String),
            ("pursue/plan", String),
            ("pursue/plain_words", String),
            ("/diagnostics", DiagnosticArray),
        ):
            rospy.Subscriber(topic, kind, self.receive, callback_args=(topic, ""), queue_size=10000)
        for robot in robots:
            for topic, kind in (("move_base_simple/goal", PoseStamped), ("pursue/actions", String)):
                rospy.Subscriber(f"{robot}/{topic}", kind, self.receive, callback_args=(topic, robot), queue_size=100)

    def receive(self, message: Any, where: Any) -> None:
        """Logs a message; an event of another node is repeated where that is wanted."""
        topic, robot = where
        sender = message._connection_header["callerid"].strip("/")
        if topic == "pursue/events" and sender != rospy.get_name().strip("/"):
            for delay in self.delays:
                threading.Timer(delay, self.publisher.publish, (message.data,)).start()
        self.write({"topic": topic, "from": sender, "robot": robot, "data": data_of(message)})

    def write(self, entry: Any) -> None:
        """One line."""
        with self.lock:
            print(json.dumps({"at": time.monotonic(), **entry}), flush=True)

    def execute(self, order: Any) -> None:
        """One line of the input."""
        for text in order.get("publish", ()):
            self.publisher.publish(text)
        for text in order.get("bytes", ()):
            self.raw.publish(Bytes(bytes.fromhex(text)))
        self.delays = order.get("repeat", self.delays)


def data_of(message: Any) -> Any:
    """What of a message is logged; of long texts the beginning."""
    if isinstance(message, DiagnosticArray):
        return [
            {"node": status.hardware_id, "level": status.level, "message": status.message,
             "values": {value.key: value.value for value in status.values}}
            for status in message.status
        ]
    if isinstance(message, PoseStamped):
        return [message.pose.position.x, message.pose.position.y]
    return message.data if len(message.data) < 20000 else message.data[:100]


def stay_connected() -> None:
    """Connects to each publisher, again and again."""
    while not rospy.is_shutdown():
        connect_missing(ask_master()[1])
        time.sleep(1.0)


def main() -> None:
    init_node("topic_logger", disable_rosout=True)
    logger = TopicLogger(sys.argv[1:])
    threading.Thread(target=stay_connected, daemon=True).start()
    logger.write({"topic": "here", "from": "topic_logger", "robot": "", "data": ""})
    for line in sys.stdin:
        logger.execute(json.loads(line))


if __name__ == "__main__":
    main()
