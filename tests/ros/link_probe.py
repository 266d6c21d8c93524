"""Two nodes that show what a link loses: `link_probe.py talker|listener`.

The talker counts on pursue/events, ten times a second; on SIGUSR1 it drops its connections. `link_probe.py deaf` is a
talker that does not answer the first who connects there. The listener prints the numbers, one a line. All of them watch
their links as the nodes of a mission do.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import time
from typing import Any, List

import rospy
from rospy.impl.tcpros_base import TCPROSServer
from std_msgs.msg import String

from pursue_runtime.nodes.links import Diagnostics, pulses_of_all
from pursue_runtime.nodes.node import OK, Ending, NodeReport, init_node


def be_deaf() -> None:
    """Leave the first connection for pursue/events as it is: accepted, and without an answer."""
    answer = TCPROSServer._tcp_server_callback
    left: List[socket.socket] = []

    def answer_later(self: Any, connection: socket.socket, address: Any) -> None:
        if not left and b"pursue/events" in connection.recv(65536, socket.MSG_PEEK):
            left.append(connection)
        else:
            answer(self, connection, address)

    TCPROSServer._tcp_server_callback = answer_later


def main(role: str) -> None:
    if role == "deaf":
        be_deaf()
        role = "talker"
    init_node(role)
    ending = Ending()
    Diagnostics(lambda: NodeReport(True, OK, "fine", {}), ending, pulses_of_all(ending), lost=lambda _: None)
    if role == "listener":
        # In one piece: an old and a new connection may speak at the same time, each in a thread of its own.
        rospy.Subscriber("pursue/events", String, lambda message: os.write(1, f"{message.data}\n".encode()))
        ending.wait()
        return
    words = rospy.Publisher("pursue/events", String, queue_size=10000)
    signal.signal(signal.SIGUSR1, lambda *_: [connection.close() for connection in list(words.impl.connections)])
    while words.get_num_connections() == 0 and not ending.called:
        time.sleep(0.1)
    number = 0
    while not ending.called:
        number += 1
        words.publish(str(number))
        time.sleep(0.1)
    ending.wait()


if __name__ == "__main__":
    main(sys.argv[1])
