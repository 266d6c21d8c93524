"""A node of the tests: publishes an event as soon as the observer is connected, and ends: `publish_event.py WORD`.

(`rostopic pub -1` ends after three seconds, whether anybody was connected by then or not.)
"""

from __future__ import annotations

import sys
import time

import rospy
from std_msgs.msg import String


def main(word: str) -> None:
    rospy.init_node("publish_event", anonymous=True)
    publisher = rospy.Publisher("pursue/events", String, queue_size=None)  # no queue: what is published is sent
    while not any(connection[1] == "/observer" for connection in publisher.impl.get_stats_info()):
        if rospy.is_shutdown():
            sys.exit(1)
        time.sleep(0.05)
    publisher.publish(word)


if __name__ == "__main__":
    main(sys.argv[1])
