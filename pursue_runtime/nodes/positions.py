"""Where the robots really are, for the page: from amcl_pose or tf, as the parameters of their controllers say; and the
paths that their move_base plans.

Parameter ~path: the topic of a robot's path (nav_msgs/Path), "{namespace}/move_base/NavfnROS/plan".
"""

from __future__ import annotations

import contextlib
import math
import re
import time
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped

from pursue_runtime.controller.settings import Settings, read_settings
from pursue_runtime.controller.whereabouts import LEVEL, Position
from pursue_runtime.data import DataError
from pursue_runtime.nodes.node import Ending, start_thread, subscribe
from pursue_runtime.nodes.robot_link import needed, position_of
from pursue_runtime.parameters import text

PERIOD = 0.5
"""Seconds of real time between two positions of a robot on the page."""

STALE = 3.0
"""Seconds of real time after which a transform that is not renewed does not say any more where a robot is."""

PATH = "{namespace}/move_base/NavfnROS/plan"
"""Where move_base with its usual planner publishes its path."""

NEWEST: Mapping[str, Any] = {"queue_size": 1, "tcp_nodelay": True}
"""Only the last message counts."""

MOST = 100
"""So many points of a path are shown, about."""

Positions = Mapping[str, Tuple[float, float, float]]
"""robot → x and y (metres on the map) and its heading (radians)."""
Paths = Mapping[str, Sequence[Tuple[float, float]]]
"""robot → the points of the path that its move_base has planned last (metres on the map)."""


def settings_of(robots: Iterable[str]) -> Dict[str, Settings]:
    """How these robots are connected, by the parameters that their controllers were launched with. Settings that cannot
    be read are the controllers' to report."""
    found = {}
    for robot in robots:
        given = rospy.get_param(f"controller_{robot}", None) or rospy.get_param("controller", None)
        with contextlib.suppress(DataError):
            found[robot] = read_settings(robot, given if isinstance(given, dict) else {})
    return found


def namespaces(robots: Iterable[str]) -> Dict[str, str]:
    """The namespace of each robot's nodes, as far as it is not the robot's name."""
    return {robot: each.namespace for robot, each in settings_of(robots).items() if each.namespace != robot}


def watch_positions(robots: Iterable[str], ending: Ending, show: Callable[[Positions, Paths], None]) -> None:
    """Call `show` with the positions of all robots that have one, and their paths, in a thread, whenever one has
    changed."""
    known = settings_of(robots).items()
    settings = {robot: each for robot, each in known if each.sources and not each.simulated}
    if settings:
        watch = _Watch(settings, ending)
        start_thread("positions", lambda: watch.run(show), ending)


class _Watch:
    """The topics of several robots."""

    def __init__(self, settings: Mapping[str, Settings], ending: Ending) -> None:
        self._settings, self._ending = settings, ending
        self._poses: Dict[str, Position] = {}
        self._paths: Dict[str, Sequence[Tuple[float, float]]] = {}
        self._renewed: Dict[str, Any] = {}  # robot → stamp of its newest transform, and when that came
        self._frames: Any = None
        if any("tf" in each.sources for each in settings.values()):
            self._listen_to_tf()
        for robot, each in settings.items():
            if "pose" in each.sources:
                subscribe(each.topic("amcl_pose"), PoseWithCovarianceStamped, self._pose, ending, robot, **NEWEST)
        self._listen_to_paths()

    def run(self, show: Callable[[Positions, Paths], None]) -> None:
        """Look at the positions, until the node ends."""
        shown: Tuple[Positions, Paths] = {}, {}
        while not self._ending.called:
            found = self._positions(), dict(self._paths)
            if found != shown:
                show(*found)
                shown = found
            time.sleep(PERIOD)

    def _listen_to_paths(self) -> None:
        """Of robots with move_base; without its messages there is no path to be had, either."""
        with contextlib.suppress(DataError):
            kind = needed("nav_msgs", "nav_msgs.msg", "a planned path").Path
            wanted = text(rospy.get_param("~", {}), "path", PATH)
            for robot, each in self._settings.items():
                topic = wanted.replace("{robot}", robot).replace("{namespace}/", each.topic(""))
                subscribe(topic, kind, self._path, self._ending, robot, **NEWEST)

    def _path(self, message: Any, robot: str) -> None:
        frame = message.header.frame_id or (message.poses[0].header.frame_id if message.poses else "")
        if is_map(frame, self._settings[robot].map_frame):
            self._paths[robot] = thinned([(each.pose.position.x, each.pose.position.y) for each in message.poses])

    def _listen_to_tf(self) -> None:
        try:
            tf = needed("tf2_ros", "tf2_ros", "a position by tf")
        except DataError as problem:
            rospy.logwarn("the page does not show where robots are: %s", problem)
            return
        self._frames, self._failed = tf.Buffer(debug=False), tf.TransformException
        self._listener = tf.TransformListener(self._frames)

    def _pose(self, message: PoseWithCovarianceStamped, robot: str) -> None:
        if is_map(message.header.frame_id, self._settings[robot].map_frame):
            self._poses[robot] = position_of(message.pose.pose.position, message.pose.pose.orientation)

    def _positions(self) -> Dict[str, Tuple[float, float, float]]:
        """Those that are known, to a centimetre: tf's first."""
        found = {}
        for robot, settings in self._settings.items():
            position = self._transform(robot, settings) if "tf" in settings.sources else None
            position = position or self._poses.get(robot)
            if position is not None and all(map(math.isfinite, position[:3])):
                found[robot] = (round(position.x, 2), round(position.y, 2), round(position.yaw, 2))
        return found

    def _transform(self, robot: str, settings: Settings) -> Optional[Position]:
        if self._frames is None:
            return None
        try:
            found = self._frames.lookup_transform(settings.map_frame, settings.base_frame, rospy.Time(0))
        except self._failed:
            return None
        stamp, now = found.header.stamp.to_sec(), time.monotonic()
        last, since = self._renewed.get(robot, (None, now))
        self._renewed[robot] = (last, since) if stamp == last else (stamp, now)
        if stamp == last and stamp > 0.0 and now > since + STALE:
            return None
        return position_of(found.transform.translation, found.transform.rotation)


def is_map(frame: str, map_frame: str) -> bool:
    """Return True if the frame is that of the map, or of the map of some level."""
    wanted = re.escape(map_frame.lstrip("/")).replace(re.escape(LEVEL), r"\w+")
    return re.fullmatch(wanted, frame.lstrip("/")) is not None


def thinned(points: Sequence[Tuple[float, float]]) -> List[Tuple[float, float]]:
    """Some points of a path, to a centimetre, the last one among them; none of one that is not on any map."""
    if not all(map(math.isfinite, sum(points, ()))):
        return []
    step = 1 + len(points) // MOST
    return [(round(x, 2), round(y, 2)) for x, y in [*points[:-1:step], *points[-1:]]]
