"""A node of the tests: says a word on pursue/events as soon as the observer hears it, and ends: `say.py WORD`.

(`rostopic pub -1` goes after three seconds, whether somebody was connected by then or not.)
"""

from __future__ import annotations

import sys
import time

import rospy
from std_msgs.msg import String


def main(word: str) -> None:
    rospy.init_node("say", anonymous=True)
    voice = rospy.Publisher("pursue/events", String, queue_size=None)  # no queue: what is published is sent
    while not any(connection[1] == "/observer" for connection in voice.impl.get_stats_info()):
        if rospy.is_shutdown():
            sys.exit(1)
        time.sleep(0.05)
    voice.publish(word)


if __name__ == "__main__":
    main(sys.argv[1])
