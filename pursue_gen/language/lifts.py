"""Lifts and doors: what a lift holds unless a scenario says more, which rides there are, which doors whoever is
controlled has opened, and what is wrong or doubtful about them."""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from typing import Dict, Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, error, listed, warning
from pursue_gen.language.conditions import Who
from pursue_gen.language.numbers import Window
from pursue_gen.language.objectives.holds import LiftHolds, lifts_in
from pursue_gen.language.refs import Ref
from pursue_gen.language.scenario import Agent, Connection, Lift, Scenario, StatedObjective

Way = Tuple[str, str]
"""From and to."""

WAITS_AT = 2.0
"""Metres from the middle of a cabin at which a robot waits for a lift: half a cabin, and half a robot. Not measured."""
_ROOM = 0.7
"""Metres between a robot that waits and one that stands at the place before the lift. Not measured."""


def rides_of(scenario: Scenario, agent: Agent) -> Dict[Way, Lift]:
    """By way of a robot the lift that it calls when it sets off; people call lifts themselves."""
    if not agent.is_robot or agent.mobile is None:
        return {}
    by_lift = ((way, scenario.lift_on(way)) for way in scenario.ways_of(agent.name))
    return {ends: lift for way, lift in by_lift if lift is not None for ends in way.directions}


def driven(scenario: Scenario, agent: Agent) -> Dict[Way, Window]:
    """The movements of an agent on ways by no lift: how long these take is what it takes from place to place."""
    rides = {ends for way in scenario.ways_of(agent.name) if way.by is not None for ends in way.directions}
    return {way: window for way, window in scenario.movements(agent).items() if way not in rides}


def in_building(scenario: Scenario) -> Scenario:
    """The scenario in which each lift holds one robot, unless an objective says what it holds: how long a lift takes
    would not be true otherwise. Each objective has the places and ways of which it speaks without their names."""
    said = {each.lift.name for _, each in lifts_in(scenario.safety)}
    more = (lift for lift in scenario.lifts if lift.name not in said and _is_shared(scenario, lift))
    ones = (LiftHolds(Ref(lift.name, lift.span, lift.label or ""), 1, (Who(None, True),), lift.span) for lift in more)
    safety = sorted((*scenario.safety, *ones), key=lambda each: each.last)
    places = {poi.name: Ref(poi.name, poi.span, poi.label or "") for poi in scenario.pois}
    known = (way for way in scenario.connections if places.keys() >= {way.a, way.b})
    ways = [(places[way.a], places[way.b], "" if way.by is None else way.by.name) for way in known]
    return replace(scenario, safety=tuple(each.in_building(tuple(places.values()), ways) for each in safety))


def is_said(scenario: Scenario, objective: StatedObjective) -> bool:
    """False for what `in_building` has added."""
    return not any(lift.span == each.span for _, each in lifts_in([objective]) for lift in scenario.lifts)


def _is_shared(scenario: Scenario, lift: Lift) -> bool:
    """True where several robots may ride in a lift."""
    return sum(lift in rides_of(scenario, agent).values() for agent in scenario.agents) > 1


def check_lifts(scenario: Scenario) -> Iterator[Diagnostic]:
    """Ways that do not go between floors of their lift; lifts that no way goes by, or whose cabin has no pose."""
    for way in scenario.connections:
        lift = scenario.lift_on(way)
        if lift is not None:
            yield from _on_way(way, lift)
    posed = any(poi.pose is not None for poi in scenario.pois)
    for lift in scenario.lifts:
        if not any(scenario.lift_on(way) is lift for way in scenario.connections):
            hint = f"write by {lift.name} behind the distance of a way between two of its floors, or delete this line"
            yield warning("PML472", f"no way goes by {lift.name}", lift.span, hint)
        elif posed and any(lift.cabin_at(ref.name) is None for ref in lift.floors):
            message = f"{lift.name} has no pose, but places do: robots would not know where to stand in it"
            hint = "write the pose of the middle of its cabin behind it: //[x, y, z, qx, qy, qz, qw]"
            yield warning("PML473", message, lift.span, hint)
        if _is_shared(scenario, lift):
            yield from _crowded(scenario, lift)


def _crowded(scenario: Scenario, lift: Lift) -> Iterator[Diagnostic]:
    """Places before a lift at which a robot that waits for it stands, though it has left them."""
    poses = {poi.name: poi.pose for poi in scenario.pois}
    near = []
    for ref in lift.floors:
        pose, cabin = poses.get(ref.name), lift.cabin_at(ref.name)
        if pose is not None and cabin is not None and hypot(pose.x - cabin.x, pose.y - cabin.y) < WAITS_AT + _ROOM:
            near.append(ref.name)
    if near:
        far = f"{WAITS_AT + _ROOM:g} m"
        are = "is" if len(near) == 1 else "are"
        message = f"{listed(near)} {are} less than {far} from the middle of {lift.name}, where robots wait for it"
        hint = f"put places {far} away or farther, so that other robots can come there meanwhile"
        yield warning("PML474", message, lift.span, hint)


def _on_way(way: Connection, lift: Lift) -> Iterator[Diagnostic]:
    floors = [ref.name for ref in lift.floors]
    for end, span in zip((way.a, way.b), way.ends):
        if end not in floors:
            hint = f"write {end} behind at, too, or connect two of {', '.join(floors)}"
            yield error("PML471", f"{end} is no floor of {lift.name}", span, hint)
    for ref in way.through[:1]:
        hint = f"delete through {ref.name}, or write a place between the two"
        yield error("PML471", f"a way by {lift.name} leads through no door but that of the lift", ref.span, hint)


def doors_of(scenario: Scenario, agent: Agent) -> Dict[Way, Tuple[str, ...]]:
    """By way of a controlled agent the doors that it has opened when it sets off; none for others, who open them
    themselves, and none for ways without doors."""
    if not agent.controllable or agent.mobile is None:
        return {}
    through = ((each, tuple(ref.name for ref in each.through)) for each in scenario.ways_of(agent.name))
    return {way: doors for each, doors in through if doors for way in each.directions}


def check_doors(scenario: Scenario) -> Iterator[Diagnostic]:
    """Warnings about doors through which no way leads, or whose pose is missing where places have theirs."""
    used = {ref.name for way in scenario.connections for ref in way.through}
    posed = any(poi.pose is not None for poi in scenario.pois)
    for door in scenario.doors:
        if door.name not in used:
            hint = f"write through {door.name} behind the distance of a way, or delete this line"
            yield warning("PML461", f"no way leads through {door.name}", door.span, hint)
        elif posed and door.pose is None:
            message = f"{door.name} has no pose, but places do: robots would wait for it where they set off"
            hint = "write the pose of its middle behind it: //[x, y, z, qx, qy, qz, qw]"
            yield warning("PML462", message, door.span, hint)
