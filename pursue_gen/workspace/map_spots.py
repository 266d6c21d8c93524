"""Spots of robots on a map of the building: where there is room for them beside the poses of places."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Dict, Mapping, Optional, Sequence

from pursue_gen.drawing.ground import FREE, Clearance, Ground, Point, to_line
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Pose, Ref, Scenario, Spot
from pursue_gen.workspace.levels import Level
from pursue_gen.workspace.robot_size import RobotSize, Sizes
from pursue_gen.workspace.spots import Fit, placing

SPARE_REACH = 1.6
"""Metres around a spot in which a spare one is looked for."""

NEAR = 1.5
"""Metres around a place in which room is looked for that planners like: farther away it would be another place."""
_SAME = 0.001
"""Metres by which two points are one."""


def with_spots(scenario: Scenario, levels: Sequence[Level], distance: float, sizes: Sizes) -> Scenario:
    """The scenario with a pose for each robot that is sent beside the pose of a place: where there is room for it.

    Its text stays as it is. `distance`: as for `spots.placing`.
    """
    where, present = placing(scenario, distance, fit_on(levels, sizes)), robots_at(scenario)
    beside: Dict[str, Dict[str, Pose]] = {}
    for poi in scenario.pois:
        own = {spot.robot.name for spot in poi.spots}
        spots = {robot: where.spots[robot][poi.name] for robot in present[poi.name] if robot not in own}
        some = {robot: spot for robot, spot in spots.items() if spot != poi.pose}
        beside[poi.name] = {} if poi.pose is None else some
    return with_poses(scenario, beside)


def with_poses(scenario: Scenario, beside: Mapping[str, Mapping[str, Pose]]) -> Scenario:
    """The scenario with these spots (place → robot → pose) behind those that it gives."""
    pois = []
    for poi in scenario.pois:
        added = [Spot(Ref(robot, poi.span), pose) for robot, pose in beside.get(poi.name, {}).items()]
        pois.append(replace(poi, spots=(*poi.spots, *added)))
    return replace(scenario, pois=tuple(pois))


def spare_spots(
    scenario: Scenario, levels: Sequence[Level], distance: float, sizes: Sizes
) -> Dict[str, Dict[str, Pose]]:
    """robot → place → another pose that this robot alone may take there, if its navigation cannot bring it to its spot.

    It is near the spot, with the room to stop and turn, seen from it, apart from the poses and spots of all other
    robots, and off the ways; robots have none where there is no such point, or ways are not known. `scenario` is that
    of `with_spots`.
    """
    where = placing(scenario, distance)
    found: Dict[str, Dict[str, Pose]] = {}
    for level in levels:
        for robot, poses in _spare_on(level, scenario, where.spots, sizes).items() if level.ways else ():
            found.setdefault(robot, {}).update(poses)
    return found


def _spare_on(
    level: Level, scenario: Scenario, spots: Mapping[str, Mapping[str, Pose]], sizes: Sizes
) -> Dict[str, Dict[str, Pose]]:
    """Those on one level, beside the robots' `spots`."""
    present, ground = robots_at(scenario), level.ground
    posed = [poi for poi in scenario.pois if level.has(poi.pose)]
    taken = [(robot, spots[robot][poi.name]) for poi in posed for robot in present[poi.name]]
    clearance = Clearance(ground)

    def spare(robot: str, spot: Pose) -> Optional[Pose]:
        size, here = sizes.of([robot]), (spot.x, spot.y)
        rooms = [(line, room_on(line, here, sizes.largest)) for line in level.ways.values()]
        others = [(pose, size.needed + sizes.of([other]).needed) for other, pose in taken if other != robot]

        def is_free(at: Point) -> bool:
            apart = all(math.dist(at, (pose.x, pose.y)) >= room for pose, room in others)
            aside = all(to_line(line, at)[0] >= room for line, room in rooms)
            near = size.needed <= math.dist(at, here) <= SPARE_REACH
            return near and apart and aside and is_seen(ground, here, at)

        point = clearance.nearest(*here, size.wanted, SPARE_REACH, is_free)
        return None if point is None else replace(spot, x=round(point[0], 3) + 0.0, y=round(point[1], 3) + 0.0)

    found: Dict[str, Dict[str, Pose]] = {}
    for poi in posed:
        for robot in present[poi.name]:
            pose = spare(robot, spots[robot][poi.name])
            if pose is not None:
                found.setdefault(robot, {})[poi.name] = pose
                taken.append((robot, pose))
    return found


def fit_on(levels: Sequence[Level], sizes: Sizes) -> Fit:
    """How well robots stand at spots on the maps of some levels.

    They need the room to stop and turn, and a straight line on free ground from the place. Better they are not on the
    way of others, and best outside what is inflated, too.
    """
    known = [(level, Clearance(level.ground)) for level in levels]

    def fit(pose: Pose, robots: Sequence[str], spot: Pose) -> int:
        place, here, robot = (pose.x, pose.y), (spot.x, spot.y), sizes.of(robots)
        level, clearance = next((one for one in known if one[0].has(pose)), known[0])
        ground = level.ground
        metres = clearance.metres(*here, robot.wanted + ground.settings.resolution)
        if metres <= robot.needed or not is_seen(ground, place, here):
            return 0
        is_aside = all(to_line(line, here)[0] >= room_on(line, place, sizes.largest) for line in level.ways.values())
        is_liked = metres > robot.wanted and math.dist(place, here) <= NEAR
        return 1 + 2 * is_aside + is_liked

    return fit


def room_on(line: Sequence[Point], place: Point, robot: RobotSize) -> float:
    """How far from a way a robot has to stand at a place (metres): where the way ends there, so that it is not touched.

    Others come near each other there anyway, and slowly.
    """
    ends_here = any(math.dist(end, place) < _SAME for end in (line[0], line[-1]))
    return 2 * robot.radius if ends_here else robot.apart


def is_seen(ground: Ground, start: Point, end: Point) -> bool:
    """Return True if the ground between two points of a map (metres) is free."""
    steps = math.ceil(2 * math.dist(start, end) / ground.settings.resolution)
    shares = (k / steps for k in range(1, steps))
    return all(ground.at(*(a + share * (b - a) for a, b in zip(start, end))) == FREE for share in shares)
