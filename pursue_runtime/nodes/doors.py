"""The doors and lifts of a mission: a door is asked to open when somebody sets off through it, and stays open until
that is over; a lift comes to who sets off by it, and brings it to another floor.

Publishes on pursue/doors (std_msgs/String) for whom which door is open, and which lift at which floor. Parameters:
~adapter (simulated, std_msgs, string, rmf) of all; of one, below its name: adapter, command, state, name (as
~d1/adapter), and of a lift floors; ~seed, ~received, ~again (see membership). Argument: --config (another folder of
data).
"""

from __future__ import annotations

import threading
from functools import partial
from typing import Any, Mapping, Optional

import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import CONFIG
from pursue_runtime.data import Package
from pursue_runtime.doors.keeper import DoorKeeper, Keeper, read_doors
from pursue_runtime.doors.lifts import ABOARD, IS_ABOARD, LiftKeeper, read_lifts
from pursue_runtime.doors.opened import DOORS, NONE_OPENED, opened_text
from pursue_runtime.doors.settings import read_door_settings, read_lift_settings
from pursue_runtime.event_words import parse_word
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.door_links import linked
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import (
    NO_STATE,
    OK,
    WARN,
    Ending,
    NodeReport,
    lower_priority,
    run_node,
    run_to_end,
    subscribe,
)
from pursue_runtime.parameters import whole
from pursue_runtime.state import LOST, STOPPED, WON, SystemState


class DoorsNode:
    """The keepers of doors and lifts on ROS: one lock, an alarm for what is due."""

    def __init__(self, package: Package, config: str) -> None:
        """Raises DataError."""
        self.ending = Ending()
        self.membership = Membership(package, self.ending, config)
        given: Mapping[str, Any] = rospy.get_param("~", {})
        doors = read_doors(self.membership.source.read("ui.yaml"))
        lifts = read_lifts(self.membership.source.read("ui.yaml"))
        settings = {name: read_door_settings(name, given) for name in doors}
        settings.update({name: read_lift_settings(name, lift.floors, given) for name, lift in lifts.items()})
        self.within = {name: door.within for name, door in doors.items()}
        self.within.update({name: min(lift.within, lift.takes) for name, lift in lifts.items()})
        self.doors, self.lifts = DoorKeeper(doors), LiftKeeper(lifts)
        self.lock = threading.RLock()
        self.state: Optional[SystemState] = None
        self.opened = NONE_OPENED
        self.publisher = rospy.Publisher(DOORS, String, queue_size=10, latch=True, tcp_nodelay=True)
        self.alarm = Alarm(self.act, self.ending)
        seed = whole(given, "seed", 0, least=None)
        self.ask = {}
        for name, one in settings.items():
            on_report = partial(self.on_report, self.doors if name in doors else self.lifts, name)
            self.ask[name] = linked(one, partial(self.seconds, name), f"{seed}/{name}", on_report, self.ending)
        if lifts:
            subscribe(ABOARD, String, self.on_aboard, self.ending, queue_size=100)
        self.membership.follow(self.on_state, self.report)

    def seconds(self, name: str) -> float:
        """Return the seconds in which a door, or a lift, has done what it was asked at the latest."""
        return self.within[name] * self.unit

    @property
    def unit(self) -> float:
        """Return the seconds of a time unit."""
        return self.state.unit if self.state is not None else 1.0

    def on_state(self, state: SystemState, publisher: str) -> None:
        """Handle a state: doors are needed, or no longer."""
        with self.lock:
            if not self.membership.takes(state):
                return
            self.state = state
            self.doors.on_state(state, rospy.get_time())
            self.lifts.on_state(state, rospy.get_time())
            self.act()
        if state.status in (WON, LOST, STOPPED):
            self.ending.end(0 if state.status == WON else 1)

    def on_report(self, keeper: Keeper, name: str, said: Any) -> None:
        """Handle what a door, or a lift, reports."""
        with self.lock:
            keeper.on_report(name, said, rospy.get_time())
            self.act()

    def on_aboard(self, message: String) -> None:
        """Handle that somebody is in the cabin of its lift."""
        word = parse_word(message.data)
        if word is None or word.event != IS_ABOARD:
            rospy.logwarn_throttle(10.0, f"not what is said of who is in a lift: {message.data[:80]!r}")
            return
        with self.lock:
            self.lifts.on_aboard(word.agent, word.as_of, rospy.get_time())
            self.act()

    def act(self) -> None:
        """Ask the doors and lifts that are to be asked, publish for whom they are open, and sleep until more is due."""
        with self.lock:
            now = rospy.get_time()
            for name, what in (*self.doors.due(now), *self.lifts.due(now)):
                self.ask[name](what)
                rospy.logdebug("%s is asked: %s", name, what)
            doors, lifts = self.doors.opened(now), self.lifts.opened(now)
            opened = doors._replace(doors={**doors.doors, **lifts.doors})
            if opened != self.opened:
                self.opened = opened
                self.publisher.publish(opened_text(opened))
            moments = (keeper.next_moment(now) for keeper in (self.doors, self.lifts))
            self.alarm.set(min((moment for moment in moments if moment is not None), default=None))

    def report(self) -> NodeReport:
        """Return the report for /diagnostics."""
        with self.lock:
            now, state = rospy.get_time(), self.state
            shut = self.doors.waited_for(now)
            late = sorted(door for door, seconds in shut.items() if seconds > self.seconds(door))
            late += sorted(self.lifts.late(now, self.unit))
            values = {"waited_for": " ".join([*shut, *self.lifts.waited_for(now)])}
        if state is None:
            return NodeReport(False, WARN, NO_STATE, values)
        if late:
            return NodeReport(True, WARN, f"{' and '.join(late)} should be open by now", values)
        return NodeReport(True, OK, state.status, values)

    def run(self) -> int:
        """Runs until the mission ends; returns the exit status."""
        return run_to_end(self.ending)


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    lower_priority()
    return run_node("doors", [CONFIG], lambda told: DoorsNode(package, told["config"]).run(), ValueError)
