"""The text of poses.yaml: where the places are, for the robots of one package."""

from __future__ import annotations

from types import MappingProxyType
from typing import Any, Dict, List, Mapping, Sequence

from pursue_gen import __version__
from pursue_gen.language.behaviour import robots_at
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition.yaml_text import inline, yaml_text
from pursue_gen.workspace.spots import Placing, Table

NOTHING: Mapping[str, Table] = MappingProxyType({})


def poses_text(
    scenario: Scenario, placing: Placing, robots: Sequence[str] = (), spare: Mapping[str, Table] = NOTHING
) -> bytes:
    """The text of poses.yaml for a package that sends these robots to their spots; without robots it has the places.

    One robot has a table of its own. Of several, those that differ from the places' poses are named (format 2). Those
    that each robot alone may take if need be are named in any case (`spare`: robot → place → pose, format 3).
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
    form = 3 if spare else 2 if own else 1
    data: Dict[str, Any] = {"format": form, "computed": placing.computed, "poses": _lines(places, alone)}
    if own:
        data["robots"] = {robot: _lines(table, _computed(scenario, robot)) for robot, table in own.items()}
    if spare:
        data["spare"] = {robot: _lines(table, ()) for robot, table in spare.items()}
    return yaml_text(data, head).encode()


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
