"""Spots against a map of the building: is the ground free where robots are sent?"""

from __future__ import annotations

from typing import Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, warning
from pursue_gen.drawing.ground import OCCUPIED, OUTSIDE, UNKNOWN, Ground
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.workspace.spots import placing

_SAYS = {
    OUTSIDE: "is outside the map",
    OCCUPIED: "is in an obstacle of the map",
    UNKNOWN: "is unknown to the map",
}
"""What a message says on ground that is not free."""


def check_spots(scenario: Scenario, ground: Ground, distance: float) -> Tuple[Diagnostic, ...]:
    """A warning for each place or spot that is not on free ground; places without a pose are left out.

    `distance`: metres between the robots at one place. Only the point is checked, not the room that a robot needs.
    """
    found = []
    for what, pose, span, hint in _points(scenario, distance):
        kind = ground.at(pose.x, pose.y)
        if kind in _SAYS:
            message = f"{what} ({pose.x:g}, {pose.y:g}) {_SAYS[kind]}"
            found.append(warning("WSP008", message, span, hint))
    return tuple(found)


def _points(scenario: Scenario, distance: float) -> Iterator[Tuple[str, Pose, Span, str]]:
    """The poses of the places, and the spots of the robots that may be there where they are other points; what to do
    about each."""
    correct = "correct the pose: metres, from the origin that the map's yaml file gives for its lower left corner"
    where, present = placing(scenario, distance), robots_at(scenario)
    for poi in scenario.pois:
        own = {spot.robot.name: spot.robot.span for spot in poi.spots}
        if poi.pose is not None and (not present[poi.name] or set(present[poi.name]) - set(own)):
            yield f"the pose of {poi.name}", poi.pose, poi.span, correct
        for robot in present[poi.name]:
            spot = where.spots[robot][poi.name]
            if robot in own:
                yield f"the spot of {robot} at {poi.name}", spot, own[robot], correct
            elif poi.pose is not None and spot != poi.pose:
                hint = f"write a pose for it behind that of {poi.name}: {robot} [x, y, z, qx, qy, qz, qw]"
                yield f"the spot of {robot} at {poi.name}", spot, poi.span, hint
