"""Doors: which of them whoever is controlled has opened, and what is doubtful about them."""

from __future__ import annotations

from typing import Dict, Iterator, Tuple

from pursue_gen.diagnostics import Diagnostic, warning
from pursue_gen.language.scenario import Agent, Scenario

Way = Tuple[str, str]
"""From and to."""


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
