"""The map of a scenario that is being written, as a picture."""

from __future__ import annotations

from dataclasses import replace

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.layout import poses
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.lsp.document import Document

MOST_PLACES = 400
"""More places cannot be read on one picture, and to lay them out takes long."""


def picture(document: Document) -> str:
    """The map as SVG, as far as the text can be read.

    Raises PursueError where there is nothing to draw, or too much.
    """
    scenario = drawable(document.scenario)
    if not scenario.pois:
        raise PursueError([error("LSP003", "there is no place to draw yet", hint='write one: poi "room"')])
    if len(scenario.pois) > MOST_PLACES:
        message = f"the map has {len(scenario.pois)} places: the preview draws {MOST_PLACES} at most"
        raise PursueError([error("LSP004", message, hint="pursue-gen ws draws all of them, in map.svg")])
    where, computed = poses(scenario)
    return map_svg.draw(scenario, where, computed)


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
