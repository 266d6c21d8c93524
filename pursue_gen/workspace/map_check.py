"""Spots against a map of the building: is the ground free where robots are sent, and where nearby is there room?"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, warning
from pursue_gen.drawing.clearance import Clearance
from pursue_gen.drawing.ground import FREE, OCCUPIED, OUTSIDE, UNKNOWN, Ground
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read, without_errors
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.workspace.spots import placing

RADIUS = 0.3
"""Metres from the middle of a robot to its farthest part, by default."""

_OF_WAYS = frozenset(("PML153", "PML154", "PML201", "PML230"))
"""Errors that a scenario has because it has no ways yet."""

_SAYS = {
    OUTSIDE: "is off the map",
    OCCUPIED: "is in an obstacle of the map",
    UNKNOWN: "is unknown to the map",
}
"""What a message says on ground that is not free."""


def read_placed(text: str, file: str) -> Scenario:
    """A scenario whose places can be looked at on a map: without errors, perhaps without ways. Raises PursueError."""
    reading = read(text, file)
    return without_errors(reading.scenario, but_for_ways(reading.scenario, check_reading(reading)))


def but_for_ways(scenario: Optional[Scenario], findings: Sequence[Diagnostic]) -> Tuple[Diagnostic, ...]:
    """The findings, without those that a scenario has because it has no ways yet."""
    if scenario is None or scenario.connections:
        return tuple(findings)
    return tuple(finding for finding in findings if finding.code not in _OF_WAYS)


def check_spots(
    scenario: Scenario, ground: Ground, distance: float, radius: Optional[float] = None
) -> Tuple[Diagnostic, ...]:
    """A warning for each place or spot that is not on free ground, with the nearest point at which there is room;
    places without a pose are left out.

    `distance`: metres between the robots at one place. `radius`: of the robots (metres), which spots that are nearer to
    an obstacle are warned about; None: only the point is checked.
    """
    found = []
    clearance = Clearance(ground)
    points = list(_points(scenario, distance))
    for point in points:
        pose, kind = point.pose, ground.at(point.pose.x, point.pose.y)
        at = f"{point.what} ({pose.x:g}, {pose.y:g})"
        if kind != FREE:
            remedy = point.remedy(clearance, RADIUS if radius is None else radius, points)
            hint = f"{remedy}; {_extent(ground) if kind == OUTSIDE else _CORRECT}"
            found.append(warning("WSP008", f"{at} {_SAYS[kind]}", point.span, hint))
        elif radius is not None and not clearance.metres(pose.x, pose.y, 2 * radius + 1) > radius + 1e-9:
            message = f"{at} is nearer than {radius:g} m, the robots' radius, to an obstacle"
            hint = f"{point.remedy(clearance, radius, points)}; if the robot is smaller, say so: --radius METRES"
            found.append(warning("MAP003", message, point.span, hint))
    return tuple(found)


_CORRECT = "poses are metres, from the origin that the map's yaml file gives for its lower left corner"


def _extent(ground: Ground) -> str:
    """How far the map reaches."""
    ends = [ground.middle(i - 0.5, j - 0.5) for i in (0, ground.width) for j in (0, ground.height)]
    (left, right), (low, high) = ((min(one), max(one)) for one in zip(*ends))
    return f"the map reaches from {left:.1f} to {right:.1f} in x and from {low:.1f} to {high:.1f} in y"


@dataclass(frozen=True)
class _Point:
    """Where robots are sent: what it is in words, and the robot whose spot has to be written; "": the pose is there."""

    what: str
    pose: Pose
    span: Span
    place: str
    unwritten: str = ""

    def remedy(self, clearance: Clearance, radius: float, points: Sequence[_Point]) -> str:
        """What to do about a point where there is no room for robots of this radius (metres): where they can stand
        beside those at all other points."""
        others = [(one.pose.x, one.pose.y) for one in points if one is not self]

        def is_apart(point: Tuple[float, float]) -> bool:
            return all(math.dist(point, other) > 2 * radius for other in others)

        room = clearance.nearest(self.pose.x, self.pose.y, radius, is_apart)
        if room is None:
            return f"move it: near it there is no room for a robot with a radius of {radius:g} m"
        x, y = (round(number, 3) + 0.0 for number in room)
        apart = math.dist(room, (self.pose.x, self.pose.y))
        where = f"there is room at {x:.10g}, {y:.10g}, {apart:.2f} m from there"
        if not self.unwritten:
            return where
        one = replace(self.pose, x=x, y=y)
        numbers = ", ".join(f"{n:.10g}" for n in (one.x, one.y, one.z, one.qx, one.qy, one.qz, one.qw))
        return f"{where}: write a pose for it behind that of {self.place}: {self.unwritten} [{numbers}]"


def _points(scenario: Scenario, distance: float) -> Iterator[_Point]:
    """The poses of the places, and the spots of the robots that may be there where they are other points."""
    where, present = placing(scenario, distance), robots_at(scenario)
    for poi in scenario.pois:
        own = {spot.robot.name: spot.robot.span for spot in poi.spots}
        if poi.pose is not None and (not present[poi.name] or set(present[poi.name]) - set(own)):
            yield _Point(f"the pose of {poi.name}", poi.pose, poi.span, poi.name)
        for robot in present[poi.name]:
            spot, what = where.spots[robot][poi.name], f"the spot of {robot} at {poi.name}"
            if robot in own:
                yield _Point(what, spot, own[robot], poi.name)
            elif poi.pose is not None and spot != poi.pose:
                yield _Point(what, spot, poi.span, poi.name, robot)
