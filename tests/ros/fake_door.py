#!/usr/bin/env python3
"""A door of the tests: opens and closes a moment after it was asked, and writes what it was asked and what it is.

Usage: fake_door.py KIND COMMAND STATE [NAME] (KIND: Bool, String, or Door of rmf_door_msgs)
"""

from __future__ import annotations

import sys
import threading
from typing import Any, Callable, Tuple

import rospy
from std_msgs.msg import Bool, String

DELAY = 0.5
"""Seconds that it needs."""


def kinds_of(kind: str, name: str) -> Tuple[Any, Any, Callable[[Any], bool], Callable[[bool], Any]]:
    """The types of its messages, what it is asked, and the message that says what it is."""
    if kind == "Bool":
        return Bool, Bool, lambda message: bool(message.data), Bool
    if kind == "String":
        return String, String, lambda message: bool(message.data == "open"), lambda is_open: String(
            "OPEN" if is_open else "closed"
        )
    from rmf_door_msgs.msg import DoorRequest, DoorState

    def state(is_open: bool) -> Any:
        message = DoorState(door_name=name)
        message.current_mode.value = 2 if is_open else 0
        return message

    return DoorRequest, DoorState, lambda message: bool(message.requested_mode.value == 2), state


def main() -> None:
    kind, command, state, name = [*sys.argv[1:5], ""][:4]
    asks, says, meaning, message = kinds_of(kind, name)
    rospy.init_node("door")
    publisher = rospy.Publisher(state, says, queue_size=10, latch=True)

    def become(is_open: bool) -> None:
        print("is", "open" if is_open else "closed", flush=True)
        publisher.publish(message(is_open))

    def ask(wanted: Any) -> None:
        if kind == "Door" and wanted.door_name != name:
            return
        print("asked to", "open" if meaning(wanted) else "close", flush=True)
        threading.Timer(DELAY, become, (meaning(wanted),)).start()

    publisher.publish(message(False))
    rospy.Subscriber(command, asks, ask, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
