"""A node with a controller's name: publishes each event on stdin; at `listen` it subscribes to the states."""

from __future__ import annotations

import sys

import rospy
from std_msgs.msg import String

rospy.init_node("controller_bot1")
events = rospy.Publisher("pursue/events", String, queue_size=10)
for line in sys.stdin:
    if line.strip() == "listen":
        rospy.wait_for_message("pursue/state", rospy.AnyMsg)
        states = rospy.Subscriber("pursue/state", rospy.AnyMsg)
        while not states.get_num_connections() and not rospy.is_shutdown():
            rospy.sleep(0.05)
    else:
        while not events.get_num_connections() and not rospy.is_shutdown():
            rospy.sleep(0.05)
        events.publish(line.strip())
    print(line.strip(), flush=True)
