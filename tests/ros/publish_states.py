"""A node for test_witness: publishes on pursue/state what no observer publishes in that mission."""

import copy
import math
import time

import rospy
from pursue_msgs.msg import SystemState


def strange(state: SystemState) -> "list[SystemState]":
    """Messages with values that do not exist, without what is needed, and of a mission that counts back."""
    found = [copy.deepcopy(state) for _ in range(9)]
    found[0].clocks[0].value = math.nan
    found[1].clocks[-1].value = math.inf
    found[2].automata = []
    found[3].automata = found[3].automata + found[3].automata[:1]
    found[4].clocks = found[4].clocks[1:]
    found[5].time_unit = math.nan
    found[6].automata[0].location = "nowhere"
    found[7].seq, found[7].status, found[7].event, found[7].agent = 0, "waiting", "", ""
    found[8].seq, found[8].event = 1, "again"
    for message in found:
        message.stamp = rospy.Time(state.stamp.secs + 5, state.stamp.nsecs)
    found[0].seq += 1
    return found


LISTENERS = {"/controller_bot1", "/controller_bot2", "/controllerObj", "/simulator", "/UI"}
"""Nodes that count what they refuse. Others are connected as well (a recorder, at first this node itself)."""

rospy.init_node("strange")
state = rospy.wait_for_message("pursue/state", SystemState)
publisher = rospy.Publisher("pursue/state", SystemState, queue_size=100)
while LISTENERS - {connection.endpoint_id for connection in publisher.impl.connections}:
    time.sleep(0.05)
for message in strange(state):
    publisher.publish(message)
    time.sleep(0.1)
time.sleep(1.0)
print("published")
