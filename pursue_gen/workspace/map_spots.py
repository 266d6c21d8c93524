"""Spots of robots on a map of the building: where there is room for them beside the poses of places."""

from __future__ import annotations

import math
from dataclasses import replace

from pursue_gen.drawing.clearance import Clearance, Point
from pursue_gen.drawing.ground import FREE, Ground
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Pose, Ref, Scenario, Spot
from pursue_gen.workspace.robot_size import RobotSize
from pursue_gen.workspace.spots import BEST, Fit, placing


def with_spots(scenario: Scenario, ground: Ground, distance: float, robot: RobotSize) -> Scenario:
    """The scenario with a pose for each robot that is sent beside the pose of a place: where there is room for it.

    Its text stays as it is. `distance`: as for `spots.placing`.
    """
    where, present = placing(scenario, distance, fit_on(ground, robot)), robots_at(scenario)
    pois = []
    for poi in scenario.pois:
        own = {spot.robot.name for spot in poi.spots}
        beside = {robot: where.spots[robot][poi.name] for robot in present[poi.name] if robot not in own}
        added = [Spot(Ref(robot, poi.span), spot) for robot, spot in beside.items() if spot != poi.pose]
        pois.append(poi if poi.pose is None else replace(poi, spots=(*poi.spots, *added)))
    return replace(scenario, pois=tuple(pois))


def fit_on(ground: Ground, robot: RobotSize) -> Fit:
    """How well robots of a size stand at spots on a map.

    They need the room to stop and turn, and a straight line on free ground from the place; best they stand outside what
    is inflated.
    """
    clearance, more = Clearance(ground), ground.settings.resolution

    def fit(pose: Pose, spot: Pose) -> int:
        metres = clearance.metres(spot.x, spot.y, robot.wanted + more)
        if metres <= robot.needed or not is_seen(ground, (pose.x, pose.y), (spot.x, spot.y)):
            return 0
        return BEST if metres > robot.wanted else BEST - 1

    return fit


def is_seen(ground: Ground, start: Point, end: Point) -> bool:
    """Return True if the ground between two points of a map (metres) is free."""
    steps = math.ceil(2 * math.dist(start, end) / ground.settings.resolution)
    shares = (k / steps for k in range(1, steps))
    return all(ground.at(*(a + share * (b - a) for a, b in zip(start, end))) == FREE for share in shares)
