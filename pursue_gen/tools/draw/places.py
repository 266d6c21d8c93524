"""Where the places of a text are in the picture: their poses, or positions computed from the distances."""

from __future__ import annotations

from functools import lru_cache
from statistics import median
from typing import Mapping, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.drawing import layout
from pursue_gen.drawing.layout import MOST_PLACES, drawable
from pursue_gen.language.draft import Draft
from pursue_gen.language.rewriting import parts_of
from pursue_gen.language.scenario import Connection, Poi, Pose, Scenario
from pursue_gen.tools.draw.poses import with_position
from pursue_gen.tools.draw.statement_edits import with_part

_NOWHERE = Span("", 1, 1, 1, 1)


def positions(scenario: Scenario) -> Tuple[Mapping[str, Pose], bool]:
    """A pose for each place, and whether some are computed; of too many places those alone that have one."""
    scenario = drawable(scenario)
    if len(scenario.pois) > MOST_PLACES:
        return {poi.name: poi.pose for poi in scenario.pois if poi.pose is not None}, False
    pois = tuple(Poi(poi.name, poi.pose, _NOWHERE) for poi in scenario.pois)
    ways = tuple(Connection(way.a, way.b, way.distance, _NOWHERE, (_NOWHERE,) * 2) for way in scenario.connections)
    return _computed(Scenario("", "", "", pois, ways, (), (), (), (), (), (), ()))


@lru_cache(maxsize=8)
def _computed(scenario: Scenario) -> Tuple[Mapping[str, Pose], bool]:
    """As `layout.poses`: that takes long, and most changes of a text do not change what places are laid out by."""
    return layout.poses(scenario)


def with_all_positions(document: Draft) -> Draft:
    """The text with the positions that are computed written down; none are, where every place has a pose."""
    where, computed = positions(document.scenario)
    if not computed:
        return document
    for poi in document.scenario.pois:
        if poi.pose is None and poi.name in where and poi.name in document.declared["POI"]:
            number = document.declared["POI"][poi.name].statement
            pose = parts_of(document.statements[number]).get("POSE")
            words = with_position(str(pose[0]) if pose else None, where[poi.name].x, where[poi.name].y)
            document = with_part(document, number, "POSE", words)
    return document


def lengths_per_metre(scenario: Scenario) -> float:
    """How many units of distance a metre is, by the ways whose places have poses; 1 where there are none."""
    given = {poi.name: poi.pose for poi in scenario.pois if poi.pose is not None}
    found = []
    for way in scenario.connections:
        a, b = given.get(way.a), given.get(way.b)
        if a is not None and b is not None:
            apart = ((a.x - b.x) ** 2 + (a.y - b.y) ** 2) ** 0.5
            found += [float(way.distance) / apart] if apart and way.distance > 0 else []
    return median(found) if found else 1.0
