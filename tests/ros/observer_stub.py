"""A node for test_ui_node: is `observer` and `controller_bot` in one, ends with the first event.

It answers `_start_` where it is told with which status it is to end.
"""

import os

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from pursue_msgs.msg import SystemState as Message
from std_msgs.msg import String

from pursue_runtime.event_words import EVENTS, START, STATE
from pursue_runtime.nodes.state_message import message_of
from pursue_runtime.state import LOST, RUNNING, WAITING, SystemState

UNIT = 10.0  # seconds; a node that learns of the start later than that skips the first entries of a trace
begun = []


def publish(seq: int, passed: float, status: str, event: str = "", agent: str = "") -> None:
    where = {"bot": "a", "thief": "a", "reachObj": "unlocked"}
    clocks = dict.fromkeys(("Cbot", "Cthief", "Creach"), passed)
    reason = "for a reason" if status == LOST else ""
    stamp = (begun[0] if begun else rospy.get_time()) + passed * UNIT
    values = {"Prule": 0, "Pbot": 1, "Pthief": 1}
    states.publish(message_of(SystemState(seq, stamp, where, values, clocks, event, agent, status, reason, UNIT)))


def on_event(message: String) -> None:
    if message.data == START and os.environ["LAST_STATUS"] and not begun:
        begun.append(rospy.get_time())
        publish(1, 0.0, RUNNING)
    elif message.data == "thief_a2b#1":
        publish(2, 3.0, os.environ["LAST_STATUS"], "thief_a2b", "thief")


def diagnose(_: object) -> None:
    ready = [KeyValue("ready", "true")]
    nodes = ("observer", "controller_bot")
    diagnostics.publish(DiagnosticArray(status=[DiagnosticStatus(hardware_id=node, values=ready) for node in nodes]))


rospy.init_node("observer")
states = rospy.Publisher(STATE, Message, queue_size=10, latch=True)
diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=10)
publish(0, 0.0, WAITING)
rospy.Subscriber(EVENTS, String, on_event)
rospy.Timer(rospy.Duration(0.2), diagnose)
rospy.spin()
