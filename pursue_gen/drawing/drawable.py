"""What a picture can show of a scenario that is being written."""

from __future__ import annotations

from dataclasses import replace

from pursue_gen.language.scenario import Scenario

MOST_PLACES = 400
"""More places cannot be read on one picture, and to lay them out takes long."""


def drawable(scenario: Scenario) -> Scenario:
    """Without what an unfinished text may hold, but no picture can show."""
    pois = tuple({poi.name: poi for poi in reversed(scenario.pois)}.values())[::-1]
    names = {poi.name for poi in pois}
    long = (way if way.distance > 0 else replace(way, distance=1) for way in scenario.connections)
    ways = {
        way.directions[0] if way.one_way else frozenset((way.a, way.b)): way
        for way in long
        if way.a != way.b and {way.a, way.b} <= names
    }
    agents = tuple(agent for agent in scenario.agents if agent.location.name in names)
    return replace(scenario, pois=pois, connections=tuple(ways.values()), agents=agents)
