"""Where the places of a text are in the picture: their poses, or positions computed from the distances; and how a pose
is written into the comment behind a place, of which everything else stays."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from statistics import median
from typing import Mapping, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE
from pursue_gen.drawing import layout
from pursue_gen.drawing.layout import MOST_PLACES, drawable, yaw_of
from pursue_gen.language.draft import Draft
from pursue_gen.language.numbers import rounded_text
from pursue_gen.language.poses import read_poses, robots_in
from pursue_gen.language.rewriting import parts_of
from pursue_gen.language.scenario import Connection, Poi, Pose, Scenario
from pursue_gen.tools.draw.statement_edits import with_part

_OWN = re.compile(r"//[ \t]*\[([^\]]*)(\]?)")


def positions(scenario: Scenario) -> Tuple[Mapping[str, Pose], bool]:
    """A pose for each place, and whether some are computed; of too many places those alone that have one."""
    scenario = drawable(scenario)
    if len(scenario.pois) > MOST_PLACES:
        return {poi.name: poi.pose for poi in scenario.pois if poi.pose is not None}, False
    pois = tuple(Poi(poi.name, poi.pose) for poi in scenario.pois)
    ways = tuple(Connection(way.a, way.b, way.distance) for way in scenario.connections)
    return _computed(Scenario("", pois=pois, connections=ways))


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


def with_position(comment: Optional[str], x: float, y: float, yaw: Optional[float] = None) -> str:
    """The comment of a pose with another position (metres) and direction (degrees; None: as it is).

    Without a comment, or where its list is no pose, height 0 and (None) a direction along x.
    """
    place = f"{metres(x)}, {metres(y)}"
    own = _OWN.match(comment or "")
    if comment is None or own is None:  # a comment that begins with a name is an ordinary one
        pose = f"//[{place}, 0, {_direction(yaw or 0.0)}]"
        return pose if comment is None else f"{pose} {comment}"
    items = [item.strip() for item in own.group(1).split(",")]
    if _is_pose(own.group()):
        z, direction = items[2], ", ".join(items[3:7]) if yaw is None else _direction(yaw)
    else:
        z, direction = "0", _direction(yaw or 0.0)
    return f"//[{place}, {z}, {direction}]{comment[own.end():]}"


def with_spot(comment: str, robot: str, x: float, y: float) -> Optional[str]:
    """The comment of a pose with another position (metres) of a robot's own spot; None where the robot has none."""
    for name, start, end in robots_in(comment):
        if name == robot:
            opening, _, rest = comment[start:end].partition("[")
            _, _, *direction = rest.split(",")
            return f"{comment[:start]}{opening}[{metres(x)}, {metres(y)},{','.join(direction)}{comment[end:]}"
    return None


def heading(pose: Pose) -> float:
    """The direction in which a robot at this pose looks, in degrees from the x axis, above -180 and up to 180."""
    rounded = round(math.degrees(yaw_of(pose)), 1) + 0.0
    return 180.0 if rounded == -180.0 else rounded


def metres(value: float) -> str:
    """A number of metres, in centimetres at the finest."""
    return rounded_text(value, 2)


def _direction(yaw: float) -> str:
    """A turn about z by so many degrees as a unit quaternion."""
    half = math.radians(yaw) / 2
    return f"0, 0, {rounded_text(math.sin(half), 4)}, {rounded_text(math.cos(half), 4)}"


def _is_pose(comment: str) -> bool:
    return read_poses(comment, NOWHERE, [])[0] is not None
