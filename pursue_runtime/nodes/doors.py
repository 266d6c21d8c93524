"""The doors of a mission: each is asked to open when somebody sets off through it, and stays open until that is over.

Publishes on pursue/doors (std_msgs/String) for whom which door is open. Parameters: ~adapter (simulated, std_msgs,
string, rmf) of all doors; of one, below its name: adapter, command, state, name (as ~d1/adapter); ~seed, ~received,
~again (see membership). Argument: --config (another folder of data).
"""

from __future__ import annotations

import threading
from functools import partial
from typing import Any, Dict, Mapping, Optional

import rospy
from std_msgs.msg import String

from pursue_runtime.arguments import CONFIG
from pursue_runtime.data import Package
from pursue_runtime.doors.keeper import DoorKeeper, read_doors
from pursue_runtime.doors.opened import DOORS, NONE_OPENED, opened_text
from pursue_runtime.doors.settings import DoorSettings, read_door_settings
from pursue_runtime.nodes.alarm import Alarm
from pursue_runtime.nodes.door_links import DoorLink, linked
from pursue_runtime.nodes.links import Links
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import ERROR, OK, WARN, Diagnostics, Ending, NodeReport, run_node, subscribe
from pursue_runtime.nodes.process import lower_priority, run_to_end
from pursue_runtime.nodes.state_message import subscribe_states
from pursue_runtime.parameters import whole
from pursue_runtime.state import LOST, STOPPED, WON, SystemState


class DoorsNode:
    """The keeper of the doors on ROS: one lock, an alarm for what is due."""

    def __init__(self, package: Package, config: str) -> None:
        """Raises DataError."""
        self.ending = Ending()
        self.membership = Membership(package, self.ending, config)
        given: Mapping[str, Any] = rospy.get_param("~", {})
        doors = read_doors(self.membership.source.read("ui.yaml"))
        settings = {name: read_door_settings(name, given) for name in doors}
        self.within = {name: door.within for name, door in doors.items()}
        self.keeper = DoorKeeper(doors)
        self.lock = threading.RLock()
        self.state: Optional[SystemState] = None
        self.opened = NONE_OPENED
        self.publisher = rospy.Publisher(DOORS, String, queue_size=10, latch=True, tcp_nodelay=True)
        self.alarm = Alarm(self.act, self.ending)
        seed = whole(given, "seed", 0, least=None)
        self.links = {name: self.link(name, one, seed) for name, one in settings.items()}
        states = subscribe_states(self.on_state, self.ending, on_malformed=self.membership.count_malformed)
        pulses = subscribe("/diagnostics", rospy.AnyMsg, lambda _: None, self.ending, queue_size=100)
        links = Links(states, pulses, ending=self.ending, lost=self.ending.without_master)
        Diagnostics(self.report, self.ending, links.amend)

    def link(self, door: str, settings: DoorSettings, seed: int) -> DoorLink:
        """Return the connection to a door. Raises DataError."""
        report = partial(self.on_report, door)
        return linked(settings, lambda: self.within[door] * self.unit, f"{seed}/{door}", report, self.ending)

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
            self.keeper.on_state(state, rospy.get_time())
            self.act()
        if state.status in (WON, LOST, STOPPED):
            self.ending.end(0 if state.status == WON else 1)

    def on_report(self, door: str, is_open: Optional[bool]) -> None:
        """Handle what a door reports."""
        with self.lock:
            self.keeper.on_report(door, is_open, rospy.get_time())
            self.act()

    def act(self) -> None:
        """Ask the doors that are to be asked, publish for whom they are open, and sleep until more is due."""
        with self.lock:
            now = rospy.get_time()
            for door, is_open in self.keeper.due(now):
                self.links[door].ask(is_open)
                rospy.logdebug("%s is asked to %s", door, "open" if is_open else "close")
            opened = self.keeper.opened(now)
            if opened != self.opened:
                self.opened = opened
                self.publisher.publish(opened_text(opened))
            self.alarm.set(self.keeper.next_moment())

    def report(self) -> NodeReport:
        """Return the report for /diagnostics."""
        with self.lock:
            state, refused, trouble = self.state, self.membership.refused, self.membership.trouble
            waited_for = self.keeper.waited_for(rospy.get_time())
            late = sorted(door for door, seconds in waited_for.items() if seconds > self.within[door] * self.unit)
            values: Dict[str, object] = {"mission": self.membership.source.mission, "waited_for": " ".join(waited_for)}
        values.update(self.membership.counts)
        if refused:
            return NodeReport(False, ERROR, f"refused {refused}", values)
        if trouble or state is None:
            return NodeReport(state is not None, WARN, trouble or "no state from the observer yet", values)
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
