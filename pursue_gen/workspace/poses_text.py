"""The text of poses.yaml: where the places are, for the robots of one package."""

from __future__ import annotations

import math
from dataclasses import replace
from types import MappingProxyType
from typing import Any, Dict, List, Mapping, Sequence

from pursue_gen import __version__
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.lifts import WAITS_AT, doors_of, rides_of
from pursue_gen.language.scenario import Lift, Pose, Scenario
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.workspace.spots import Placing, Table
from pursue_runtime.doors.lifts import gate_at
from pursue_runtime.locations import movement

DOOR_DISTANCE = 1.0
"""Metres from the middle of a door at which a robot waits for it: room for a door that swings and half a robot. Not
measured."""

NOTHING: Mapping[str, Table] = MappingProxyType({})


def poses_text(
    scenario: Scenario,
    placing: Placing,
    robots: Sequence[str] = (),
    spare: Mapping[str, Table] = NOTHING,
    levels: Mapping[str, float] = MappingProxyType({}),
) -> bytes:
    """The text of poses.yaml for a package that sends these robots to their spots; without robots it has the places.

    One robot has a table of its own. Of several, those that differ from the places' poses are named (format 2). Those
    that each robot alone may take if need be are named in any case (`spare`: robot → place → pose, format 3), and so
    are the doors of ways, and where a robot waits for them (format 4), in the cabin of a lift, too (format 5); and
    the elevations of `levels` that have maps of their own (format 6).
    """
    places, spots = placing.places, placing.spots
    head = [_title(scenario, robots)]
    missing = _computed(scenario)
    alone = _computed(scenario, robots[0]) if len(robots) == 1 else missing
    if placing.computed:
        head.append(f"Computed from the distances, not measured: {', '.join(missing)}. Put your map's poses here.")
    shared = any(len(present) > 1 for present in robots_at(scenario).values())
    if robots and shared and placing.distance > 0:
        head.append(f"Robots that may be at one place stand {placing.distance:g} m apart (--spot-distance).")
    free = "; 0, 0, 0, 0: any orientation" if placing.computed else ""
    head.append(f"[x, y, z, qx, qy, qz, qw]: metres, and a unit quaternion{free}")
    own: Dict[str, Table] = {}
    if len(robots) == 1:
        places = spots[robots[0]]
    else:
        differ = {robot: {name: p for name, p in spots[robot].items() if p != places[name]} for robot in robots}
        own = {robot: table for robot, table in differ.items() if table}
    spare = {robot: spare[robot] for robot in robots if robot in spare}
    doors = _doorways(scenario, places, own, robots)
    by_lift = any(isinstance(way, list) for ways in doors.values() for way in ways.values())
    form = 6 if levels else 5 if by_lift else 4 if doors else 3 if spare else 2 if own else 1
    data: Dict[str, Any] = {"format": form, "computed": placing.computed, "poses": _lines(places, alone)}
    if own:
        data["robots"] = {robot: _lines(table, _computed(scenario, robot)) for robot, table in own.items()}
    if spare:
        data["spare"] = {robot: _lines(table, ()) for robot, table in spare.items()}
    if doors:
        data["doors"] = doors
    if levels:
        data["levels"] = inline(dict(levels))
    return yaml_text(data, head).encode()


def _doorways(scenario: Scenario, places: Table, own: Mapping[str, Table], robots: Sequence[str]) -> Dict[str, Any]:
    """For each robot the location of each way through doors, the doors, and the pose at which it waits for them; of a
    way by lift the same where it gets in, and where it gets out."""
    found: Dict[str, Any] = {}
    for agent in (agent for agent in scenario.agents if agent.name in robots):
        for (a, b), lift in rides_of(scenario, agent).items():
            start = own.get(agent.name, places).get(a, places[a])
            halts = _halts(lift, a, b, start, places[b].z)
            found.setdefault(agent.name, {})[movement(a, b)] = inline(halts)
        for (a, b), doors in doors_of(scenario, agent).items():
            start = own.get(agent.name, places).get(a, places[a])
            way: Dict[str, Any] = {"doors": sorted(doors)}
            poses = [door.pose for door in scenario.doors if door.name in doors and door.pose is not None]
            if poses:
                way["wait"] = in_front_of(min(poses, key=lambda pose: _apart(start, pose)), start)
            found.setdefault(agent.name, {})[movement(a, b)] = inline(way)
    return found


def _halts(lift: Lift, a: str, b: str, start: Pose, height: float) -> List[Dict[str, Any]]:
    """Where a robot waits for a lift from one floor to another one, at this height, and then in it; one that has no
    pose in it alone knows how it rides. It gets in at the height of where it sets off."""
    cabin, there = lift.cabin_at(a), lift.cabin_at(b)
    to_get_in: Dict[str, Any] = {"doors": [gate_at(lift.name, a)]}
    if cabin is None:
        return [to_get_in]
    inside = {"doors": [gate_at(lift.name, b)], "wait": _numbers(replace(cabin, z=start.z)), "aboard": True}
    out = {} if there is None or there == cabin else {"out": _numbers(replace(there, z=height))}
    return [{**to_get_in, "wait": before_cabin(cabin, start)}, {**inside, **out}]


def before_cabin(cabin: Pose, start: Pose) -> List[float]:
    """The pose on the straight line from a cabin to where a robot sets off, looking at the cabin."""
    distance = math.dist((cabin.x, cabin.y), (start.x, start.y)) or 1.0
    share = min(WAITS_AT / distance, 1.0)
    x, y = (a + share * (b - a) for a, b in ((cabin.x, start.x), (cabin.y, start.y)))
    yaw = math.atan2(cabin.y - start.y, cabin.x - start.x)
    return [round(number, 3) + 0.0 for number in (x, y, start.z, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))]


def in_front_of(door: Pose, start: Pose) -> List[float]:
    """The pose in front of a door, on the side from which a robot comes that starts there, looking at the door."""
    yaw = 2 * math.atan2(door.qz, door.qw)
    ahead = math.cos(yaw), math.sin(yaw)
    if (door.x - start.x) * ahead[0] + (door.y - start.y) * ahead[1] < 0:
        ahead, yaw = (-ahead[0], -ahead[1]), yaw + math.pi
    distance = min(DOOR_DISTANCE, _apart(start, door))
    at = (door.x - distance * ahead[0], door.y - distance * ahead[1], start.z)
    return [round(number, 3) + 0.0 for number in (*at, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))]


def _numbers(pose: Pose) -> List[float]:
    return [float(number) for number in (pose.x, pose.y, pose.z, pose.qx, pose.qy, pose.qz, pose.qw)]


def _apart(one: Pose, other: Pose) -> float:
    return math.dist((one.x, one.y, one.z), (other.x, other.y, other.z))


def _title(scenario: Scenario, robots: Sequence[str]) -> str:
    where = f"Where the points of {scenario.name} are"
    if robots:
        where = f"Where {' and '.join(robots)} stand{'s' if len(robots) == 1 else ''} at the points of {scenario.name}"
    return f"{where}, in frame map, written by pursue-gen {__version__}."


def _computed(scenario: Scenario, robot: str = "") -> List[str]:
    """The places without a pose, also without one for the robot."""
    return [
        poi.name
        for poi in scenario.pois
        if poi.pose is None and robot not in {spot.robot.name for spot in poi.spots}
    ]


def _lines(table: Table, computed: Sequence[str]) -> Dict[str, Any]:
    """A line for each place; a computed pose demands no orientation."""
    lines = {}
    for name, p in table.items():
        orientation = (0.0, 0.0, 0.0, 0.0) if name in computed else (p.qx, p.qy, p.qz, p.qw)
        lines[name] = inline([float(number) for number in (p.x, p.y, p.z, *orientation)])
    return lines
