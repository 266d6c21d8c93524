"""A controller: plays its part of the strategy (strategy.yaml).

Parameters: those of robots (see exeggutor), ~received (missions from the desk count), ~again (after a mission it begins
anew and waits for the next one). Argument: --config (another folder of data).
"""

from __future__ import annotations

import os
import threading
from typing import Dict

import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import CONFIG
from pursue_runtime.controller.follower import Follower
from pursue_runtime.data import DataError, Package
from pursue_runtime.event_words import PLAN, format_word
from pursue_runtime.folders import ros_home
from pursue_runtime.missions import Missions, own_source
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.exeggutor import Exeggutor
from pursue_runtime.nodes.links import Diagnostics
from pursue_runtime.nodes.node import ERROR, NO_STATE, OK, WARN, Ending, NodeReport, log, run_node, subscribe
from pursue_runtime.nodes.state_message import StatePrinter, subscribe_states
from pursue_runtime.nodes.witness import Witness
from pursue_runtime.parameters import flag
from pursue_runtime.sentences import in_words, trouble_values
from pursue_runtime.state import LOST, STOPPED, WON, SystemState
from pursue_runtime.state_checks import OLD, OURS, REFUSED
from pursue_runtime.strategy import parse_plan


class Controller:
    """Plays a part of the strategy: publishes commands when they are due, and orders robots what the observer took."""

    def __init__(self, package: Package, config: str) -> None:
        given = rospy.get_param("~", {})
        own = own_source(package, "strategy.yaml", config)
        home = ros_home(os.environ) if flag(given, "received") else ""
        missions, name = Missions(own, package.name, home), rospy.get_name().strip("/")
        again = flag(given, "again")
        self.lock = threading.RLock()
        self.ending = Ending()
        self.follower = Follower(missions, name, package.name, log, again)
        self.observer = ""
        self.exegg = Exeggutor(self.ending)
        self.printer = StatePrinter(self.ending)
        self.alarm = Alarm(self.on_alarm, self.ending)
        self.exegg.on_observer = self.on_alarm  # a command that is due is published again at once, too
        try:
            self.follower.load_current()
        except DataError as problem:
            if not home:
                raise
            self.follower.reject(str(problem))  # the next one may be better
        self.take_up()
        self.witness = Witness(lambda: self.follower.filter.newest)
        states = subscribe_states(self.update_state, self.ending, on_malformed=self.follower.filter.count_malformed)
        subscribe(PLAN, String, self.learn, self.ending, queue_size=10, tcp_nodelay=True)
        Diagnostics(self.report, self.ending, states)

    def take_up(self) -> None:
        """Has the robots of the part that is played. Raises DataError where their settings are wrong."""
        part = self.follower.part
        if part:
            what = "its part in" if part.strategy is not None else "no part in"
            rospy.loginfo("has %s mission %s", what, part.mission or "own")
        self.alarm.set()
        reaction = part.strategy.reaction if part and part.strategy is not None else 0.0
        poses, spare = (part.poses.of(part.robots), part.poses.spare) if part else ({}, {})
        doors, levels = (part.poses.doors, part.poses.levels) if part else ({}, {})
        self.exegg.take_up(poses, reaction, spare, doors, levels)

    def update_state(self, state: SystemState, publisher: str) -> None:
        """Handle a state: order the robots what was taken, and plan the next command."""
        with self.lock:
            played, verdict = self.follower.part, self.follower.on_state(state)
            if verdict == REFUSED:
                self.witness.publish()
                return
            if verdict != OLD and publisher != self.observer:
                self.observer = publisher
                self.exegg.serve_first(publisher)
            if self.follower.part is not played:
                try:
                    self.take_up()
                except DataError as problem:
                    self.follower.reject(str(problem))
                    return
            if verdict == OURS:
                self.play(state)

    def play(self, state: SystemState) -> None:
        """Handle a state of the mission whose part this controller has."""
        scheduler = self.follower.scheduler
        if scheduler is not None:
            orders = scheduler.on_state(state, rospy.get_time())
            # Before any command: a robot that is not in its place is reported first.
            self.exegg.follow(state, orders)
            if scheduler.is_new:  # else the alarm stays as it is
                self.wake()
            self.learned()
            receipt = scheduler.repeated_receipt()
            if receipt:
                self.exegg.announce(format_word(receipt))
        self.printer.on_state(state)
        if state.status == WON:
            self.ending.end(0)
        elif state.status in (LOST, STOPPED):
            if not self.ending.called:  # states come several times
                rospy.logwarn("the mission is %s", state.status)  # the observer and the UI say why
            self.ending.end(1)

    def wake(self) -> None:
        """Set the alarm for the next command; publish at once what is due already."""
        moment, patience = self.follower.scheduler.next_wakeup() if self.follower.scheduler else (None, None)
        if moment is not None and moment <= rospy.get_time():
            self.on_alarm()
        else:
            self.alarm.set(moment, patience)

    def learn(self, message: String) -> None:
        """Handle a new plan: it is in force from the state on that names it, for all nodes at once."""
        try:
            plan = parse_plan(message.data)
        except DataError as problem:
            rospy.logerr("cannot use the new plan: %s", problem)
            return
        with self.lock:
            self.follower.plan = plan
            self.learned()

    def learned(self) -> None:
        """Take the newest plan, if it is of the mission that is played, and report that to the observer."""
        try:
            word = self.follower.take_plan(rospy.get_time())
        except DataError as problem:
            rospy.logerr("cannot use the new plan: %s", problem)
            return
        if word:
            rospy.loginfo("plan %s received", word.seq)
            self.exegg.announce(format_word(word))
            self.wake()

    def on_alarm(self) -> None:
        """Publish a command that is due, or that was not answered."""
        with self.lock:
            scheduler = self.follower.scheduler
            if scheduler is None:
                return
            word = scheduler.on_timer(rospy.get_time(), self.exegg.may_begin)
            if word:
                self.exegg.announce(format_word(word))
            self.alarm.set(*scheduler.next_wakeup())

    def report(self) -> NodeReport:
        """Return the report for /diagnostics: ready when the observer and this node are connected both ways."""
        with self.lock:
            state, scheduler, part, trouble = self.follower.report()
            planned = scheduler.planned if scheduler else None
            values: Dict[str, object] = {"seq": state.seq if state else "", "mission": part.mission if part else ""}
            values.update(scheduler.counts if scheduler else {})
            values["next_command"] = planned[1].event if planned else ""
            values["refused"] = refused = self.follower.filter.refused
            values["malformed"] = self.follower.filter.malformed
        if refused:
            return NodeReport(False, ERROR, f"refused {refused}", values)
        if trouble:
            return NodeReport(False, WARN, trouble, values)
        if state is None:
            return NodeReport(False, WARN, NO_STATE, values)
        if self.observer not in self.exegg.observers():
            return NodeReport(False, WARN, "the observer has not connected yet", values)
        if scheduler is None:
            return NodeReport(True, OK, f"{state.status}; no part in mission {part.mission if part else ''}", values)
        if state.status in (LOST, STOPPED):
            return NodeReport(True, ERROR, state.status, values)
        troubles = self.exegg.troubles()
        sentences = [f"{robot} {in_words(text)}" for robot, text in troubles.items()]
        values.update(trouble_values(troubles))
        return NodeReport(True, WARN if troubles else OK, "; ".join([state.status, *sentences]), values)

    def run(self) -> int:
        """Run until the mission ends; return the exit status."""
        return self.ending.wait(linger=0.2)


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    return run_node(package.name, [CONFIG], lambda told: Controller(package, told["config"]).run())
