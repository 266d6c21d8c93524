"""Where a robot is: its position, whether it stands still, at which place it is known to be, and the frames of the
maps: one for all levels of a building, or one for each, where `~map_frame` has `{level}`.

Distances are metres, angles radians, times seconds of ROS time.
"""

from __future__ import annotations

import math
from types import MappingProxyType
from typing import Dict, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.controller.settings import Settings
from pursue_runtime.data import DataError
from pursue_runtime.sentences import marked

LEVEL = "{level}"
"""Stands in `~map_frame` for the name of a level."""

STOREY = 0.5
"""Metres from the elevation of a level within which a place is on it, and by which a robot may be above or below."""

Levels = Mapping[str, float]
"""level → its elevation in metres."""
NO_LEVELS: Levels = MappingProxyType({})


class MapFrames:
    """Which frame a pose is in, by its height, and on which level what is in a frame is."""

    def __init__(self, map_frame: str, levels: Levels) -> None:
        """Raises DataError where the frame names levels, and there are none."""
        if LEVEL in map_frame and not levels:
            raise DataError(
                f"~map_frame is {map_frame!r}, and poses.yaml has no levels: generate the workspace with --map and the"
                " file of levels"
            )
        several = LEVEL in map_frame
        self.elevations: Dict[str, Optional[float]] = {map_frame: None}
        """frame → the height of all that is in it (metres); None: there is one frame for all heights."""
        if several:
            self.elevations = {map_frame.replace(LEVEL, name): height for name, height in levels.items()}

    def of(self, height: float) -> str:
        """Return the frame for a pose at this height (metres): that of the nearest level."""
        return min(self.elevations, key=lambda frame: abs((self.elevations[frame] or 0.0) - height))

    def elevation(self, frame: str) -> Optional[float]:
        """Return the height of what is in a frame (metres), None where that says nothing of it. Raises KeyError for a
        frame of no map."""
        return self.elevations[frame.lstrip("/")]


class Position(NamedTuple):
    """A position on the map, with the robot's heading. `height`: that of the level whose map it is (metres); None where
    one map is for all levels, which does not say on which the robot is."""

    x: float
    y: float
    yaw: float
    height: Optional[float] = None

    def is_below_or_above(self, place: Place) -> bool:
        """Return True if the place is on another level."""
        return self.height is not None and len(place.pose) > 2 and abs(self.height - place.pose[2]) > STOREY


class Place(NamedTuple):
    """A place of the scenario on the map; `yaw` is None where no orientation is demanded. `pose`: as goals have it."""

    poi: str
    x: float
    y: float
    yaw: Optional[float] = None
    pose: Tuple[float, ...] = ()


def place_of(poi: str, pose: Sequence[float]) -> Place:
    """Return the place with this pose [x, y, z, qx, qy, qz, qw]; a quaternion of zeros demands no orientation."""
    orientation = pose[3:7]
    return Place(poi, pose[0], pose[1], yaw_of(*orientation) if any(orientation) else None, tuple(pose))


def yaw_of(x: float, y: float, z: float, w: float) -> float:
    """Return the rotation about the vertical axis of a quaternion, from -pi to pi."""
    return math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)


def turned(a: float, b: float) -> float:
    """Return the angle between two headings, from 0 to pi."""
    return abs(math.remainder(a - b, 2.0 * math.pi))


class Whereabouts:
    """What is known of where a robot is.

    It is known to be at a place by its last arrival there and no motion since, or by its position: within the
    tolerances of the place, and standing. A robot stands if, for `end_settle` seconds, it was never further than
    `still_distance` from one of its positions, nor turned by more than `still_angle` against it.
    """

    def __init__(self, settings: Settings) -> None:
        self.position: Optional[Position] = None
        self._settings = settings
        self._rest: Optional[Position] = None  # the position that it has kept since `_since`
        self._since = math.inf
        self._place = ""  # where it has arrived, and its position then
        self._arrival: Optional[Position] = None

    def on_position(self, position: Optional[Position], now: float) -> None:
        """Take a position; None: it is not known any more."""
        self.position = position
        limits = self._settings.still_distance, self._settings.still_angle
        if position is None:
            self._rest, self._since = None, math.inf
        elif self._rest is None or not _within(self._rest, position, *limits):
            self._rest, self._since = position, now

    def on_arrival(self, poi: str) -> None:
        """Note that the robot has arrived at this place."""
        self._place, self._arrival = poi, self.position

    def on_departure(self) -> None:
        """Note that the robot may be anywhere: it has a goal, of ours or of another node, or was seen elsewhere."""
        self._place, self._arrival = "", None

    def stands_at(self) -> float:
        """Return from when on the robot stands, if it does not move until then; inf without a position."""
        return self._since + self._settings.end_settle

    def is_near(self, place: Place) -> bool:
        """Return True if the last position is within the tolerances of the place."""
        at = self.position
        if at is None or math.hypot(at.x - place.x, at.y - place.y) > self._settings.end_tolerance:
            return False
        if at.is_below_or_above(place):
            return False
        return place.yaw is None or turned(at.yaw, place.yaw) <= self._settings.end_yaw_tolerance

    def is_known_at(self, place: Place, now: float) -> bool:
        """Return True if the robot is known to be at the place."""
        if self._place == place.poi and not self._has_moved():
            return True
        return self.is_near(place) and now >= self.stands_at()

    def describe(self, place: Place) -> str:
        """Return why the robot is not known to be at the place, as part of a sentence."""
        at, poi = self.position, marked(place.poi)
        if at is None:
            return f"is not known to be at {poi}: no position, and no arrival there"
        if at.is_below_or_above(place):
            return f"is on another level than {poi}"
        distance = math.hypot(at.x - place.x, at.y - place.y)
        if distance > self._settings.end_tolerance:
            return f"is {distance:.1f} m from {poi}"
        if place.yaw is not None and turned(at.yaw, place.yaw) > self._settings.end_yaw_tolerance:
            return f"is at {poi}, but turned by {math.degrees(turned(at.yaw, place.yaw)):.0f} degrees"
        return f"does not stand still at {poi}"

    def _has_moved(self) -> bool:
        """Return True if the robot may have moved since its arrival, by more than an arrival may be off."""
        before, at = self._arrival, self.position
        if before is None or at is None:
            return before is not at  # a first position, with nothing to be compared with, or one that is missing now
        return not _within(before, at, self._settings.end_tolerance, self._settings.end_yaw_tolerance)


def _within(before: Position, after: Position, distance: float, angle: float) -> bool:
    """Return True if the positions differ by no more than that, and are on one level."""
    near = math.hypot(after.x - before.x, after.y - before.y) <= distance
    return near and before.height == after.height and turned(after.yaw, before.yaw) <= angle
