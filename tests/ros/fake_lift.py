#!/usr/bin/env python3
"""A lift of the tests: a moment after it was asked it is open at that floor, and it writes both.

Usage: fake_lift.py KIND COMMAND STATE NAME [ROBOT] (KIND: Int32, String, or Lift of rmf_lift_msgs; NAME: what the
messages of Open-RMF call it; ROBOT: who is found aboard where it is open first, as by a scale in its floor)
"""

from __future__ import annotations

import sys
import threading
from typing import Any, Callable, Tuple

import rospy
from std_msgs.msg import Int32, String

DELAY = 0.5
"""Seconds that it needs."""


def kinds_of(kind: str, name: str) -> Tuple[Any, Any, Callable[[Any], str], Callable[[str, Any], Any]]:
    """The types of its messages, the floor to which it is asked ("": it is free), and the message that says where it is
    open ("": nowhere), answering an order."""
    if kind == "Int32":
        return Int32, Int32, lambda message: "" if message.data < 0 else str(message.data), lambda floor, _: Int32(
            int(floor or -1)
        )
    if kind == "String":
        return String, String, lambda message: str(message.data).replace("free", ""), lambda floor, _: String(
            floor or "moving"
        )
    from rmf_lift_msgs.msg import LiftRequest, LiftState

    def state(floor: str, order: Any) -> Any:
        session = order.session_id if order is not None and order.request_type else ""
        message = LiftState(lift_name=name, current_floor=floor or "L1", session_id=session)
        message.door_state = 2 if floor else 0
        return message

    return LiftRequest, LiftState, lambda message: str(message.destination_floor if message.request_type else ""), state


def main() -> None:
    kind, command, state, name, robot = [*sys.argv[1:6], ""][:5]
    asks, says, meaning, message = kinds_of(kind, name)
    rospy.init_node("lift")
    publisher = rospy.Publisher(state, says, queue_size=10, latch=True)
    aboard = rospy.Publisher("/pursue/aboard", String, queue_size=10)
    asked = [""]

    def become(floor: str, order: Any) -> None:
        if floor != asked[0]:
            return
        print("is at", floor, flush=True)
        publisher.publish(message(floor, order))
        if robot and floor:
            threading.Timer(DELAY, aboard.publish, (String(f"{robot}:aboard"),)).start()

    def ask(wanted: Any) -> None:
        if kind == "Lift" and wanted.lift_name != name:
            return
        floor = meaning(wanted)
        if floor != asked[0]:
            print("asked to", floor or "be free", flush=True)
            asked[0] = floor
            publisher.publish(message("", wanted))
            threading.Timer(DELAY, become, (floor, wanted)).start()

    publisher.publish(message("", None))
    rospy.Subscriber(command, asks, ask, queue_size=10)
    rospy.spin()


if __name__ == "__main__":
    main()
