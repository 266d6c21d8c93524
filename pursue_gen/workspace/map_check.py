"""Spots against a map of the building: is the ground free where robots are sent?"""

from __future__ import annotations

import base64
import math
from typing import Iterator, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, Span, warning
from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.png_greys import greys
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Pose, Scenario
from pursue_gen.workspace.spots import placing

_SAYS = {
    "outside": "is outside the map",
    "occupied": "is in an obstacle of the map",
    "unknown": "is unknown to the map",
}
"""What a message says on ground that is not free."""


def check_spots(scenario: Scenario, floor: Floor, distance: float) -> Tuple[Diagnostic, ...]:
    """A warning for each place or spot that is not on free ground; places without a pose are left out.

    `distance`: metres between the robots at one place. Only the point is checked, not the room that a robot needs.
    """
    pixels = greys(base64.b64decode(floor.uri.partition(",")[2]))
    found = []
    for what, pose, span, hint in _points(scenario, distance):
        ground = _ground(floor, pixels, pose)
        if ground in _SAYS:
            message = f"{what} ({pose.x:g}, {pose.y:g}) {_SAYS[ground]}"
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


def _ground(floor: Floor, pixels: Optional[bytes], pose: Pose) -> str:
    """Where a pose is: outside, occupied, unknown or free, as map_server has it; free if the pixels are not known."""
    cos, sin = math.cos(floor.yaw), math.sin(floor.yaw)
    x, y = pose.x - floor.x, pose.y - floor.y
    column = math.floor((cos * x + sin * y) / floor.resolution)
    row = floor.height - 1 - math.floor((cos * y - sin * x) / floor.resolution)
    if not (0 <= column < floor.width and 0 <= row < floor.height):
        return "outside"
    if pixels is None:
        return "free"
    grey = pixels[row * floor.width + column]
    darkness = (grey if floor.negate else 255 - grey) / 255
    if darkness > floor.occupied:
        return "occupied"
    return "free" if darkness < floor.free else "unknown"
