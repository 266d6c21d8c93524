"""Which robots are driven along which ways, by the data of a workspace and the parameters of the node."""

from __future__ import annotations

import math
import os
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Set, Tuple

from pursue_runtime.controller.whereabouts import NO_LEVELS, Levels, Place
from pursue_runtime.data import DataError, read_data
from pursue_runtime.doors.lifts import read_lifts
from pursue_runtime.drives.actions import Act, Acts, Rules, acts_of, location_of
from pursue_runtime.drives.session import Plan
from pursue_runtime.drives.tour import Way
from pursue_runtime.locations import is_movement, movement
from pursue_runtime.model import Automaton, Model
from pursue_runtime.parameters import names, number, text, whole
from pursue_runtime.poses import POSES, Table, read_poses
from pursue_runtime.simulator.simulator import end_window
from pursue_runtime.strategy import Strategy

Read = Callable[[str], Mapping[str, Any]]
"""Reads a data file of the package UI by its name. Raises DataError."""

NEAR = 1.0
"""Metres from a goal within which a robot that stands there may keep another one from it."""

Folder = Callable[[str], Optional[str]]
"""The folder of a package on this machine; None where it is not here."""


class Driven(NamedTuple):
    """A robot, where it begins, where it is sent for each place, and what it drives and does. `acts`: all its actions,
    also those with partners, with what was measured of them; the rules in it are shared by all robots. `seconds`: how
    long all of that takes by the windows of the model, at least and at most, if a time unit is a second. `levels`:
    those that have maps of their own."""

    name: str
    start: str
    poses: Table
    plan: Plan
    acts: Acts
    seconds: Tuple[float, float]
    levels: Levels = NO_LEVELS

    def to(self, place: str, why: str = "where it begins") -> Driven:
        """The same robot, which only goes to a place."""
        plan = Plan((), limit=self.plan.limit, pause=self.plan.pause, only_goes=why)
        return self._replace(start=place, plan=plan)

    def doing(self, act: Act) -> Driven:
        """The same robot, which only does this where it stands, as often as the rules let it."""
        plan = Plan((), limit=self.plan.limit, pause=self.plan.pause, acts=(act,), actions=self.plan.actions)
        return self._replace(start=act.place, plan=plan)


def next_action(robots: Sequence[Driven], standing: Mapping[str, Place]) -> List[Driven]:
    """Who goes where, and does then what is left of all actions and may be done now, the one that was done least;
    empty: nothing is left. `standing`: where robots are."""
    left = [(robot.acts.count(act), robot, act) for robot in robots for act in robot.acts.left()]
    if not left:
        return []
    _, doer, act = min(left, key=lambda one: one[0])
    coming = [one for one in robots if one.name in act.robots(doer.name) and one.plan.ways]
    away = [one for one in coming if one.name not in standing or standing[one.name].poi != act.place]
    return [*(one.to(act.place, f"for {act.event}") for one in away), doer.doing(act)]


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
    places, (own, commanded, levels) = read_poses(read(POSES)).places, _of_controllers(read, folder)
    lifts = read_lifts(read("ui.yaml")).values()
    found: List[Driven] = []
    for name in wanted:
        rides = {location for lift in lifts for location in lift.rides.get(name, ())}  # no lift comes without a mission
        ways = tuple(way for way in ways_of(robots[name]) if movement(*way) not in rides)
        poses = {**places, **own.get(name, {})}
        acts = acts_of(robots[name], model, wanted) if actions else ()
        if not ways and not acts:
            continue
        begins = start if start and ways and not any(each.plan.ways for each in found) else robots[name].initial
        if begins not in poses:
            raise DataError(f"~start is {begins!r}; expected one of {', '.join(poses)}")
        first = frozenset(way for way in ways if (name, movement(*way)) in commanded)
        alone = tuple(act for act in acts if not act.partner)
        plan, done = Plan(ways, times, limit, pause, alone, actions, first), Acts(name, acts, actions, rules)
        seconds = _seconds(model, robots[name], plan._replace(acts=acts))
        found.append(Driven(name, begins, poses, plan, done, seconds, levels))
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


def duration(robots: Sequence[Driven]) -> str:
    """How much is driven and done, and how long that takes, in words."""
    plans = [robot.plan for robot in robots]
    drives = sum(len(p.ways) * p.times for p in plans)
    acts = sum(len(robot.acts.measured) * robot.plan.actions for robot in robots)
    least, most = (sum(robot.seconds[k] for robot in robots) for k in (0, 1))
    unit, size = ("minutes", 60) if most >= 120 else ("seconds", 1)
    also = f" and {acts} action{'s' * (acts > 1)}" if acts else ""
    return (
        f"{drives} drives{also} take {least / size:.0f} to {most / size:.0f} {unit} by the scenario's windows"
        " (a time unit: a second), if none fails"
    )


def who_is_near(goal: Place, standing: Mapping[str, Place]) -> str:
    """Which of the robots that stand somewhere is nearest to a goal, in words; "" if none is within NEAR metres."""
    found = sorted((math.hypot(goal.x - at.x, goal.y - at.y), name) for name, at in standing.items())
    return f"{found[0][1]} stands {found[0][0]:.2f} m from its goal" if found and found[0][0] <= NEAR else ""


def _seconds(model: Model, robot: Automaton, plan: Plan) -> Tuple[float, float]:
    locations = [movement(*way) for way in plan.ways for _ in range(plan.times)]
    locations += [location_of(act) for act in plan.acts for _ in range(plan.actions)]
    windows = [end_window(model, robot, location) for location in locations]
    known = [(window.low, window.high) for window in windows if window is not None]
    pauses = plan.pause * len(locations)
    return sum(low for low, _ in known) + pauses, sum(high for _, high in known) + pauses


def _of_controllers(read: Read, folder: Folder) -> Tuple[Dict[str, Table], Set[Tuple[str, str]], Levels]:
    """The poses of each robot in the package of its controller, as far as those are on this machine; the movements that
    their strategies command, each behind its robot; and the levels that have maps of their own."""
    levels: Dict[str, float] = {}
    found: Dict[str, Table] = {}
    commanded: Set[Tuple[str, str]] = set()
    for package in map(str, read("ui.yaml").get("nodes", ())):
        where = folder(package)
        config = os.path.join(where, "config") if where is not None else ""
        if not os.path.isfile(os.path.join(config, "strategy.yaml")):
            continue
        strategy = read_data(os.path.join(config, "strategy.yaml"))
        robots = strategy.get("commands_agents", ())
        commanded |= Strategy(strategy).targets
        if os.path.isfile(os.path.join(config, POSES)):
            poses = read_poses(read_data(os.path.join(config, POSES)))
            found.update(poses.of(map(str, robots)))
            levels.update(poses.levels)
    return found, commanded, levels
