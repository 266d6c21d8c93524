"""Simulated time for missions that run faster than life: publishes /clock until it is ended.

Set /use_sim_time before any other node starts. Parameters: ~speed (simulated seconds per real one, default 5; one at
most until the first word on pursue/events), ~hold (real seconds of standstill after each message of the mission,
default 0.1), ~time_unit (seconds, default 1.0), ~step (simulated seconds; default 0.02 time units). Killed and started
again it goes on where it was: it keeps its time in a file under ROS_HOME, one for each roscore.
"""

from __future__ import annotations

import os
import time
from typing import Any, Optional

import rosgraph
import rospy
from rosgraph_msgs.msg import Clock

from pursue_runtime.data import Package
from pursue_runtime.event_words import EVENTS, STATE
from pursue_runtime.folders import scenario_folder
from pursue_runtime.nodes.links import Diagnostics
from pursue_runtime.nodes.node import OK, Ending, NodeReport, run_node, start_thread, subscribe
from pursue_runtime.simulator.clock import ClockFile, Pace, SimClock, read_pace, send_whole


def pace() -> Pace:
    """The pace that the parameters set. Raises ParameterError."""
    if not rospy.get_param("/use_sim_time", False):
        rospy.logwarn("/use_sim_time is not true: no node follows this clock")
    return read_pace(rospy.get_param("~", {}))


def run(pace: Pace, scenario: str) -> int:
    """Runs the clock until ROS shuts down, or the master is lost (status 1)."""
    ending = Ending()
    memory = remember(scenario)
    last = memory.last if memory is not None else None
    if last is not None:
        rospy.logwarn("simulated time goes on at %.2f s, where it was", last)
    clock = SimClock(pace) if last is None else SimClock(pace, last, has_begun=True)
    publisher = rospy.Publisher("/clock", Clock, queue_size=10, tcp_nodelay=True)
    send_at_once(publisher)
    _, states = [
        subscribe(
            topic, rospy.AnyMsg, lambda _, act: act(time.monotonic()), ending, act, queue_size=1000, tcp_nodelay=True
        )
        for topic, act in ((EVENTS, clock.on_word), (STATE, clock.on_message))
    ]
    Diagnostics(
        lambda: NodeReport(True, OK, f"{clock.now:.2f} s", {"speed": pace.speed}),
        ending, states, lost=lambda _: ending.end(1),
    )  # fmt: skip
    start_thread("clock", lambda: tick(clock, publisher, memory), ending)
    return ending.wait()


class _Connection:
    """A connection to a subscriber that gets a message at once, or not at all where it does not read.

    rospy has a queue and a thread for each subscriber: for hundreds of messages a second, that is most of the clock's
    work. A time that is not sent is not missed: the next one takes its place.
    """

    def __init__(self, connection: Any) -> None:
        self._connection = connection

    def __getattr__(self, name: str) -> Any:
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Write a message. Raises OSError where the connection is closed; rospy then removes it."""
        return send_whole(self._connection.socket, data)


def send_at_once(publisher: rospy.Publisher) -> None:
    """Have the publisher write each message to its subscribers itself."""
    topic = publisher.impl
    add_connection, topic.queue_size = topic.add_connection, None
    topic.add_connection = lambda connection: add_connection(_Connection(connection))


def tick(clock: SimClock, publisher: rospy.Publisher, memory: Optional[ClockFile]) -> None:
    """Publishes /clock until ROS shuts down."""
    moment = time.monotonic()
    while not rospy.is_shutdown():
        simulated = clock.message(time.monotonic())
        try:
            if simulated is not None:
                if memory is not None:
                    memory.save(simulated)
                publisher.publish(Clock(rospy.Time.from_sec(simulated)))
        except OSError as problem:
            rospy.logerr("cannot keep the time: %s", problem)
            memory = None
        except rospy.ROSException:
            return  # the node is going down
        # On a busy machine steps come late; they are not made up for.
        moment = max(moment + clock.period, time.monotonic())
        time.sleep(max(0.0, moment - time.monotonic()))


def remember(scenario: str) -> Optional[ClockFile]:
    """The memory of this roscore's clock; None, and a warning, where there cannot be one."""
    core = str(rospy.get_param("/run_id", "") or rosgraph.get_master_uri())
    name = "clock-" + "".join(sign if sign.isalnum() else "_" for sign in core)
    try:
        return ClockFile(os.path.join(scenario_folder(os.environ, scenario), name))
    except OSError as problem:
        rospy.logwarn("cannot keep the time (%s): a clock that is killed will start anew", problem)
        return None


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    return run_node("sim_clock", [], lambda _: run(pace(), package.scenario))
