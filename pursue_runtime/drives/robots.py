"""Which robots are driven along which ways, by the data of a workspace and the parameters of the node."""

from __future__ import annotations

import os
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional

from pursue_runtime.data import DataError, read_data
from pursue_runtime.drives.actions import Rules, acts_of
from pursue_runtime.drives.session import Plan
from pursue_runtime.drives.tour import Way
from pursue_runtime.locations import is_movement
from pursue_runtime.model import Automaton, Model
from pursue_runtime.parameters import names, number, text, whole
from pursue_runtime.poses import POSES, Table, read_poses

Read = Callable[[str], Mapping[str, Any]]
"""Reads a data file of the package UI by its name. Raises DataError."""

Folder = Callable[[str], Optional[str]]
"""The folder of a package on this machine; None where it is not here."""


class Driven(NamedTuple):
    """A robot, where it begins, where it is sent for each place, and what it drives and does; `rules` are shared by
    all robots."""

    name: str
    start: str
    poses: Table
    plan: Plan
    rules: Rules


def driven_robots(read: Read, given: Mapping[str, Any], folder: Folder) -> List[Driven]:
    """The robots in the order in which they are driven. `given`: the node's parameters. Raises DataError.

    A robot's poses are those of its controller, if that package is here: two robots have two poses at one place.
    """
    model = Model(read("model.yaml"))
    robots = {robot.name: robot for robot in model.of_kind("robot")}
    wanted = names(given, "robots") or tuple(robots)
    for name in wanted:
        if name not in robots:
            raise DataError(f"~robots has {name!r}; expected some of {', '.join(robots)}")
    times, limit = whole(given, "times", 5, least=1), number(given, "limit", 300.0, above=True)
    pause, start = number(given, "pause", 1.0), text(given, "start")
    actions, rules = whole(given, "actions", 0), Rules(model)
    places, own = read_poses(read(POSES)).places, _own_poses(read, folder)
    found: List[Driven] = []
    for name in wanted:
        ways, poses = tuple(ways_of(robots[name])), {**places, **own.get(name, {})}
        acts = acts_of(robots[name], model) if actions else ()
        if not ways and not acts:
            continue
        begins = start if start and ways and not any(each.plan.ways for each in found) else robots[name].initial
        if begins not in poses:
            raise DataError(f"~start is {begins!r}; expected one of {', '.join(poses)}")
        found.append(Driven(name, begins, poses, Plan(ways, times, limit, pause, acts, actions), rules))
    if not found:
        raise DataError(f"no way for {', '.join(wanted) or 'anybody'}: no robot of this scenario is mobile")
    return found


def ways_of(robot: Automaton) -> List[Way]:
    """The ways that a robot's automaton has, from where to where."""
    begins = {edge.target: edge.source for edge in robot.edges if _is_begin(edge.source, edge.target)}
    ends = {edge.source: edge.target for edge in robot.edges if _is_begin(edge.target, edge.source)}
    return [(begins[location], ends[location]) for location in begins if location in ends]


def _is_begin(place: str, location: str) -> bool:
    return is_movement(location) and not is_movement(place)


def _own_poses(read: Read, folder: Folder) -> Dict[str, Table]:
    """The poses of each robot in the package of its controller, as far as those are on this machine."""
    found: Dict[str, Table] = {}
    for package in map(str, read("ui.yaml").get("nodes", ())):
        where = folder(package)
        config = os.path.join(where, "config") if where is not None else ""
        if not os.path.isfile(os.path.join(config, "strategy.yaml")):
            continue
        robots = read_data(os.path.join(config, "strategy.yaml")).get("commands_agents", ())
        if os.path.isfile(os.path.join(config, POSES)):
            found.update(read_poses(read_data(os.path.join(config, POSES))).of(map(str, robots)))
    return found
