"""A node called like a controller: says each word that it reads on stdin; at `listen` it begins to hear the states."""

from __future__ import annotations

import sys

import rospy
from std_msgs.msg import String

rospy.init_node("controller_bot1")
words = rospy.Publisher("pursue/events", String, queue_size=10)
for line in sys.stdin:
    if line.strip() == "listen":
        rospy.wait_for_message("pursue/state", rospy.AnyMsg)
        states = rospy.Subscriber("pursue/state", rospy.AnyMsg)
        while not states.get_num_connections() and not rospy.is_shutdown():
            rospy.sleep(0.05)
    else:
        while not words.get_num_connections() and not rospy.is_shutdown():
            rospy.sleep(0.05)
        words.publish(line.strip())
    print(line.strip(), flush=True)
