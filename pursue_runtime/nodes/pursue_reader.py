"""Takes missions from the desk (topic local_mission), checks and keeps them, and has them played when no other runs.

Parameters: ~robot (the robot's name; its namespace, or this machine's name where there is none), ~keep (so many earlier
missions), ~limit (bytes of the largest bundle), ~patience (seconds after the start without an observer, until missions
may be exchanged), ~state_topic, ~nodes (those of missions that run on this machine: all, or names with blanks between
them). Argument: --keys (the folder of the keys that are trusted).
"""

from __future__ import annotations

import contextlib
import json
import os
import threading
import time
from typing import Dict, Tuple

import rospkg
import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import KEYS
from pursue_runtime.bundle import LIMIT, KeyFolder
from pursue_runtime.data import Package
from pursue_runtime.event_words import STATE
from pursue_runtime.folders import keys_folder, missions_folder
from pursue_runtime.manifest import MISSION, mission_id
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.links import Diagnostics
from pursue_runtime.nodes.node import OK, WARN, Ending, NodeReport, log, robot_name, run_node, subscribe
from pursue_runtime.nodes.state_message import subscribe_states
from pursue_runtime.parameters import number, whole
from pursue_runtime.reader.contents import StoreError
from pursue_runtime.reader.packages import ALL, packages_here, without_package
from pursue_runtime.reader.reader import KEYS_PERIOD, PATIENCE, Machine, Reader
from pursue_runtime.reader.store import KEEP, Store
from pursue_runtime.state import SystemState

RETRY = 10.0
"""Seconds until a store that cannot be used is tried again."""


class Node:
    """The reader on ROS: one lock, so that orders and states are taken one by one."""

    def __init__(self, scenario: str, ending: Ending, store: Store, keys: KeyFolder) -> None:
        self.lock = threading.RLock()
        self.ending = ending
        given = rospy.get_param("~", {})
        limit, patience = whole(given, "limit", LIMIT, least=1), number(given, "patience", PATIENCE)
        nodes, installed = str(rospy.get_param("~nodes", ALL)), mission_packages()
        robot = Machine(robot_name(), scenario, packages_here(nodes, installed), limit)
        self.reader = Reader(robot, store, keys, time.monotonic(), log, patience)
        self.published = ""
        self.statuses = rospy.Publisher("mission_status", String, queue_size=10, latch=True)
        self.alarm = Alarm(self.on_alarm, ending)
        self.publish()
        self.orders = subscribe("local_mission", String, self.on_order, ending, queue_size=1, buff_size=1 << 20)
        topic = rospy.get_param("~state_topic", STATE)
        states = subscribe_states(self.on_state, ending, "/" + topic.lstrip("/"))
        Diagnostics(self.report, ending, states)
        trouble = self.reader.problem()
        log("err" if trouble else "info", trouble or f"{robot.name} takes missions")
        for node in without_package(nodes, installed):
            log("warn", f"~nodes: there is no package for {node} here, so it plays no part in missions")

    def on_order(self, message: String) -> None:
        """Handle an order on local_mission."""
        with self.lock:
            self.reader.on_message(message.data, time.monotonic())
            self.publish()

    def on_state(self, state: SystemState, _publisher: str) -> None:
        """Handle a state of the mission."""
        with self.lock:
            if self.reader.on_state(state, time.monotonic()):
                self.publish()

    def on_alarm(self) -> None:
        """Handle the time at which an observer counts as gone, or keys may have been removed."""
        with self.lock:
            self.reader.on_time(time.monotonic())
            self.publish()

    def publish(self) -> None:
        """Publish the status if it has changed."""
        text = json.dumps(self.reader.status())
        if text != self.published:
            self.published = text
            with contextlib.suppress(rospy.ROSException):  # the node is going down
                self.statuses.publish(text)
        check = self.reader.next_check(time.monotonic())
        self.alarm.set(None, KEYS_PERIOD if check is None else min(check, KEYS_PERIOD))

    def report(self) -> NodeReport:
        """For /diagnostics. It is ready as soon as it is connected with communication_manager."""
        with self.lock:
            status, trouble = self.reader.status(), self.reader.problem()
            values: Dict[str, object] = {**self.reader.counts, "kept": len(status["kept"])}
            values["refused"] = sum(self.reader.refusals.counts.values())
        for name in ("current", "next", "prepared"):
            values[name] = "" if status[name] is None else mission_id(status[name])
        ready = self.orders.get_num_connections() > 0
        return NodeReport(ready, WARN if trouble else OK, trouble or "takes missions", values)


def mission_packages() -> Tuple[str, ...]:
    """The packages of this machine that hold data of a mission."""
    known = rospkg.RosPack()
    mark = os.path.join("config", MISSION)
    return tuple(sorted(name for name in known.list() if os.path.isfile(os.path.join(known.get_path(name), mark))))


def open_store(ending: Ending) -> Store:
    """The store, as soon as it can be used. Raises ParameterError, and StoreError where the node ends before."""
    keep = whole(rospy.get_param("~", {}), "keep", KEEP, least=1)
    while True:
        try:
            return Store(missions_folder(os.environ), keep, log)
        except StoreError as problem:
            rospy.logerr("%s", problem)
            deadline = time.monotonic() + RETRY
            while time.monotonic() < deadline:
                if ending.called:
                    raise
                time.sleep(0.1)


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    return run_node(package.name, [KEYS], lambda told: run(package.scenario, told["keys"]))


def run(scenario: str, keys: str) -> int:
    """Runs the reader until it ends, with the trusted keys in the folder `keys`, "" for the default; returns the exit
    status. Raises ParameterError."""
    ending = Ending()
    with contextlib.suppress(StoreError):
        Node(scenario, ending, open_store(ending), KeyFolder(keys or keys_folder(os.environ)))
    return ending.wait()
