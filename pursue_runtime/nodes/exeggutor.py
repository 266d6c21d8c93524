"""A controller's executor (the thesis's exeggutor): orders robots, and reports their ends to the observer."""

from __future__ import annotations

import contextlib
import threading
import time
from functools import partial
from typing import Dict, List, Mapping

import rospy
from std_msgs.msg import String

from pursue_runtime.controller.navigation import Movement, Navigation, read_settings
from pursue_runtime.locations import is_action, is_movement, movement
from pursue_runtime.nodes.node import Alarm, Ending, listeners
from pursue_runtime.nodes.robot_link import RobotLink
from pursue_runtime.poses import Table
from pursue_runtime.state import ENDED, LIVE, RUNNING, WON, SystemState
from pursue_runtime.words import EVENTS

LOGS = {"info": rospy.loginfo, "warn": rospy.logwarn, "err": rospy.logerr}

LOOKS = 0.2
"""Seconds of real time between two looks at tf, while a robot is under way."""


class Exeggutor:
    """Sends the words to the observer, and goals and actions to each robot on topics of its own."""

    def __init__(self, ending: Ending) -> None:
        self._lock = threading.RLock()
        self._poses: Mapping[str, Table] = {}
        self._ways: Dict[str, Dict[str, Movement]] = {}
        self._status = RUNNING
        self._events = rospy.Publisher(EVENTS, String, queue_size=100, tcp_nodelay=True)
        self._robots: Dict[str, Navigation] = {}
        self._links: Dict[str, RobotLink] = {}
        self._alarm = Alarm(self._on_alarm, ending)
        rospy.on_shutdown(self._call_back)

    def take_up(self, poses: Mapping[str, Table]) -> None:
        """Take these robots, each with its poses of the places; orders given before are over. Raises DataError, with
        no robots, where the settings of one are wrong."""
        with self._lock:
            self._call_back()
            for link in self._links.values():
                link.keep("", False, "")
            self._robots, self._status = {}, RUNNING
            self._poses = poses
            self._ways = {robot: _ways(places) for robot, places in poses.items()}
            given = rospy.get_param("~", {})
            settings = {robot: read_settings(robot, given) for robot in poses}
            for robot in set(self._links) - set(settings):
                self._links.pop(robot).close()
            for robot in settings:
                if robot not in self._links:
                    answer, place = partial(self._result, robot), partial(self._place, robot)
                    self._links[robot] = RobotLink(robot, settings[robot], answer, place)
                self._robots[robot] = Navigation(robot, settings[robot], self._log)

    @staticmethod
    def _log(level: str, text: str) -> None:
        LOGS[level]("%s", text)

    # For the controller -----------------------------------------------------------------------------------------------

    def announce(self, word: str) -> None:
        """Publish a command or a report on pursue/events."""
        with contextlib.suppress(rospy.ROSException):  # the node is going down
            self._events.publish(word)

    def observers(self) -> List[str]:
        """The nodes that are subscribed to what is published here."""
        return listeners(self._events)

    def follow(self, state: SystemState) -> None:
        """Handle a state: drop orders that are over, and reports that the state shows."""
        with self._lock:
            before, self._status = self._status, state.status
            for name, robot in self._robots.items():
                here = state.locations.get(name, "") if state.status in LIVE else ""
                if state.status in ENDED and before not in ENDED:
                    self._call_back_one(name)
                robot.on_state(self._ways[name].get(here), state.status == RUNNING, name in state.lost)
                self._links[name].keep(here, state.status == RUNNING, robot.goal)
            self._act()

    def exeggute(self, agent: str, trigger: str, origin: str, target: str) -> None:
        """The agent begins `trigger`, from `origin` to `target`: order its robot to do so."""
        if agent not in self._robots:
            return  # an objective has no robot
        if is_movement(target) and target != origin:
            way = self._ways[agent].get(target)
            if way is None:
                rospy.logerr("%s should be %s, but poses.yaml does not know these places", agent, target)
                return
            with self._lock:
                self._robots[agent].start(way, rospy.get_time())
                self._act()
        elif target == origin:
            self._links[agent].do(trigger)
        elif is_action(target):
            self._links[agent].do(trigger, target)

    # From the robots --------------------------------------------------------------------------------------------------

    def _result(self, robot: str, goal: str, stamp: float, status: int) -> None:
        with self._lock:
            if robot not in self._robots:
                return
            self._robots[robot].on_result(goal, stamp, status, rospy.get_time())
            self._act()

    def _place(self, robot: str, x: float, y: float) -> None:
        with self._lock:
            if robot not in self._robots:
                return
            self._robots[robot].on_position(x, y, rospy.get_time())
            self._act()

    # What is due ------------------------------------------------------------------------------------------------------

    def _act(self) -> None:
        """Does what is due, and sleeps until more is."""
        now, real = rospy.get_time(), time.monotonic()
        moments, patience = [], []
        for name, robot in self._robots.items():
            goal, word = robot.due(now, real)
            if goal is not None:
                self._links[name].go(goal, self._poses[name][goal.movement.poi])
            if word is not None:
                rospy.loginfo("reports %s", word)
                self.announce(word)
            moment, repeat = robot.next_moments()
            moments += [] if moment is None else [moment]
            patience += [] if repeat is None else [repeat - real]
            if robot.needs_position != self._links[name].watched:
                patience.append(0.0)  # topics are changed by the alarm's thread: that may have to wait for the master
            elif robot.needs_position and robot.settings.ends == "tf":
                patience.append(LOOKS)
        self._alarm.set(min(moments, default=None), max(0.0, min(patience)) if patience else None)

    def _on_alarm(self) -> None:
        """Look where robots are, and do what is due."""
        with self._lock:
            robots, links = dict(self._robots), dict(self._links)
        for name, robot in robots.items():
            links[name].watch(robot.needs_position)
            place = links[name].look()
            if place is not None:
                self._place(name, *place)
        with self._lock:
            self._act()

    # The end ----------------------------------------------------------------------------------------------------------

    def _call_back(self) -> None:
        """The node ends: what is under way is called back, if that is wanted, unless all is well."""
        with self._lock:
            for name in self._robots:
                self._call_back_one(name)

    def _call_back_one(self, name: str) -> None:
        robot = self._robots[name]
        if robot.goal and robot.settings.on_stop == "cancel" and self._status != WON:
            self._links[name].cancel(robot.goal)


def _ways(places: Table) -> Dict[str, Movement]:
    """A robot's movement for each location in which it is under way."""
    return {movement(x, y): Movement(movement(x, y), y, *places[y][:2]) for x in places for y in places}
