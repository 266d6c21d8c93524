"""The simulated robots, people and other agents: reports the ends of what they do.

Parameters: ~reports (whose ends; default: those that ui.yaml names, or all), ~delays (random, early, middle,
late), ~seed, ~received, ~again (see membership). Argument: --config (another folder of data).
"""

from __future__ import annotations

import threading
import time
from typing import List, Union

import rospy
from geometry_msgs.msg import PoseStamped
from std_msgs.msg import String

from pursue_runtime.arguments import CONFIG
from pursue_runtime.data import Package
from pursue_runtime.event_words import EVENTS, ORDERED, Word, format_word, parse_word
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import OK, WARN, Ending, NodeReport, lower_priority, run_node, run_to_end, subscribe
from pursue_runtime.nodes.publishing import Newcomers, listeners
from pursue_runtime.parameters import choice, names, whole
from pursue_runtime.simulator.simulator import DELAYS, Delays, Simulator
from pursue_runtime.state import LOST, STOPPED, WAITING, WON, SystemState


class SimulatorNode:
    """The simulator on ROS: one lock, an alarm for the next end, a word on pursue/events for each."""

    def __init__(self, package: Package, config: str) -> None:
        self.ending = Ending()
        self.membership = Membership(package, self.ending, config)
        model, settings = self.membership.model, self.membership.source.read("ui.yaml")
        agents = [automaton.name for automaton in model.acting]
        given = rospy.get_param("~", {})
        reports = names(given, "reports", settings.get("reports", agents))
        delays = Delays(choice(given, "delays", "random", DELAYS), whole(given, "seed", 0, least=None))
        self.simulator = Simulator(model, reports, delays)
        self.robots = [robot.name for robot in model.of_kind("robot") if robot.name in reports]
        self.lock = threading.RLock()
        self.observer = ""
        self.status = WAITING
        self.reported = 0
        self.events = rospy.Publisher(EVENTS, String, queue_size=100, tcp_nodelay=True)
        self.alarm = Alarm(self.act, self.ending)
        Newcomers(self.events, lambda node: node == self.observer, self.say_again)
        self.subscribers: List[rospy.Subscriber] = []
        for robot in self.robots:
            for topic, kind in ((f"{robot}/move_base_simple/goal", PoseStamped), (f"{robot}/pursue/actions", String)):
                self.subscribers.append(
                    subscribe(topic, kind, self.on_order, self.ending, robot, queue_size=10, tcp_nodelay=True)
                )
        self.membership.follow(self.on_state, self.report)

    def on_state(self, state: SystemState, publisher: str) -> None:
        """Handle a state: activities begin."""
        with self.lock:
            if not self.membership.takes(state):
                return
            self.observer = publisher
            self.status = state.status
            self.simulator.on_state(state, time.monotonic())
            self.act()
        if state.status in (WON, LOST, STOPPED):
            self.ending.end(0 if state.status == WON else 1)

    def on_order(self, message: Union[PoseStamped, String], robot: str) -> None:
        """A goal or an action for the robot; an action with a number is acknowledged, each time."""
        word = parse_word(message.data) if isinstance(message, String) else Word("", "")
        if word is None:
            rospy.logwarn("%s cannot do %r: not the name of an event", robot, message.data[:80])
            return
        with self.lock:
            self.simulator.on_order(robot, rospy.get_time(), word.event, word.seq or 0)
            if word.seq is not None:
                self.events.publish(format_word(Word(robot, ORDERED, word.seq, at=word.at)))
            self.act()

    def say_again(self) -> None:
        """Publish reports that no state has shown once more: an observer has connected."""
        with self.lock:
            self.simulator.say_again()
            self.act()

    def act(self) -> None:
        """Report the ends that are due, and sleep until the next."""
        with self.lock:
            for word in self.simulator.due(rospy.get_time(), time.monotonic()):
                self.events.publish(word)
                rospy.loginfo("reports %s", word)
                self.reported += 1
            moment, real = self.simulator.next_moments()
            self.alarm.set(moment, None if real is None else max(0.0, real - time.monotonic()))

    def report(self) -> NodeReport:
        """Return the report for /diagnostics: ready when the observer and this node are connected both ways, and each
        robot has a controller."""
        with self.lock:
            observer, status, reported = self.observer, self.status, self.reported
        unconnected = sorted({each.resolved_name for each in self.subscribers if each.get_num_connections() == 0})
        values = {"reported": reported, "uncommanded": " ".join(unconnected)}
        if not observer or observer not in listeners(self.events):
            return NodeReport(False, WARN, "not connected to the observer yet", values)
        if unconnected:
            return NodeReport(False, WARN, f"no publisher on {unconnected[0]} yet", values)
        return NodeReport(True, OK, status, values)

    def run(self) -> int:
        """Runs until the mission ends; returns the exit status."""
        return run_to_end(self.ending)


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    lower_priority()
    return run_node("simulator", [CONFIG], lambda told: SimulatorNode(package, told["config"]).run(), ValueError)
