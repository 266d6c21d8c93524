"""The map of a scenario that is being written, as a picture."""

from __future__ import annotations

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.layout import MOST_PLACES, drawable, poses
from pursue_gen.language.draft import Draft


def picture(document: Draft) -> str:
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
