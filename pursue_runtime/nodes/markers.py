"""Shows the mission in rviz: visualization_msgs/MarkerArray on pursue/markers, latched.

Parameters: ~map_frame (default: map), ~received, ~again (see membership). Argument: --config (another folder of data).
"""

from __future__ import annotations

import threading
from typing import Any, Dict, List, Optional

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import String

from pursue_runtime.arguments import CONFIG
from pursue_runtime.data import DataError, Package
from pursue_runtime.event_words import MARKERS, PLAN
from pursue_runtime.nodes.membership import Membership
from pursue_runtime.nodes.node import (
    NO_STATE,
    OK,
    WARN,
    Ending,
    NodeReport,
    lower_priority,
    restart_process,
    run_node,
    subscribe,
)
from pursue_runtime.nodes.robot_link import needed
from pursue_runtime.parameters import text
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import parse_plan
from pursue_runtime.ui.markers import ARROW, BALL, DISC, LINES, TEXT, Mark, Picture, read_spots
from pursue_runtime.ui.page import read_floor_plan
from pursue_runtime.ui.strategies import strategies_in, strategies_of

SHAPES = {
    LINES: (0.0, 1, 0, 0, 0.0), DISC: (0.01, 1, 1, 0, 0.01), ARROW: (0.04, 1, 2.5, 3, 0.0), BALL: (0.1, 1, 1, 1, 0.0),
    TEXT: (0.2, 0, 0, 1, 0.0),
}  # fmt: skip
"""Metres above the map: what lies above the rest is seen from above; how long, wide and high it is, in its sizes, and
how many metres higher."""


class MarkersNode:
    """Publishes the markers of each state that shows something else than the one before."""

    def __init__(self, package: Package, config: str) -> None:
        """Raises DataError."""
        self.messages = needed("visualization_msgs", "visualization_msgs.msg", "rosrun UI markers")
        self.ending = Ending()
        self.membership = Membership(package, self.ending, config)
        source, model = self.membership.source, self.membership.model
        settings = source.read("ui.yaml")
        plan = read_floor_plan(source.read("poses.yaml"), settings)
        self.frame = text(rospy.get_param("~", {}), "map_frame", "map")
        self.strategies = {0: strategies_of(source)}  # by the number of their plan
        self.picture = Picture(model, plan, read_spots(settings, plan), self.strategies)
        self.lock = threading.Lock()
        self.shown: List[Mark] = []
        self.state: Optional[SystemState] = None
        self.publisher = rospy.Publisher(MARKERS, self.messages.MarkerArray, queue_size=1, latch=True)
        self.show(None)
        subscribe(PLAN, String, self.on_plan, self.ending, queue_size=10)
        self.membership.follow(self.on_state, self.report)

    def on_state(self, state: SystemState, publisher: str) -> None:
        """Show a state of the mission."""
        if self.membership.takes(state):
            with self.lock:
                self.show(state)

    def on_plan(self, message: String) -> None:
        """Take a new plan: what is next in it is shown as soon as it is in force."""
        try:
            plan = parse_plan(message.data)
            strategies = strategies_in(plan)
        except DataError as problem:
            rospy.logerr("cannot use the new plan: %s", problem)
            return
        if plan.get("mission", "") in ("", self.membership.source.mission):
            with self.lock:
                self.strategies[plan["plan"]] = strategies
                self.show(self.state)

    def show(self, state: Optional[SystemState]) -> None:
        """Publish what there is to show, if it is something new."""
        self.state = state
        marks = self.picture.marks(state)
        if marks != self.shown:
            self.shown = marks
            self.publisher.publish(self.array(marks))

    def array(self, marks: List[Mark]) -> Any:
        """Return the message: it removes what was shown before."""
        kind = self.messages.Marker
        array = self.messages.MarkerArray(markers=[kind(action=kind.DELETEALL)])
        array.markers[0].header.frame_id = self.frame
        counts: Dict[str, int] = {}
        for mark in marks:
            number = counts[mark.group] = counts.get(mark.group, -1) + 1
            array.markers.append(self.marker(mark, number))
        return array

    def marker(self, mark: Mark, number: int) -> Any:
        """Return the marker of a mark, with its number in its namespace."""
        kind = self.messages.Marker
        kinds = {DISC: kind.CYLINDER, BALL: kind.SPHERE, LINES: kind.LINE_LIST, ARROW: kind.ARROW}
        marker = kind(ns=mark.group, id=number, type=kinds.get(mark.kind, kind.TEXT_VIEW_FACING), text=mark.text)
        marker.header.frame_id = self.frame  # its stamp is 0: the newest transform counts
        marker.color.r, marker.color.g, marker.color.b = mark.colour
        marker.color.a = marker.pose.orientation.w = 1.0
        height, long, wide, high, more = SHAPES[mark.kind]
        marker.scale.x, marker.scale.y, marker.scale.z = long * mark.size, wide * mark.size, high * mark.size + more
        if len(mark.points) > 1:
            marker.points = [Point(x, y, height) for x, y in mark.points]
        else:
            (marker.pose.position.x, marker.pose.position.y), marker.pose.position.z = mark.points[0], height
        return marker

    def report(self) -> NodeReport:
        """Return the report for /diagnostics."""
        with self.lock:
            state, values = self.state, {"markers": len(self.shown)}
        if state is None:
            return NodeReport(False, WARN, NO_STATE, values)
        return NodeReport(True, OK, state.status, values)

    def run(self) -> int:
        """Run until the node is ended, also after the mission: its end is shown, and the next mission; return 0."""
        status = self.ending.wait()
        if self.ending.renewed:
            restart_process()
        return status


def main(package: Package) -> int:
    """Runs the node of this package until it ends; returns its exit status."""
    lower_priority()
    return run_node("markers", [CONFIG], lambda told: MarkersNode(package, told["config"]).run())
