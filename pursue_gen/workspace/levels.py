"""The levels of a building, each with its map: which places are on which.

A map of map_server shows one level. Of a building with several, a yaml file names the map of each, and its elevation
in metres: a place is on the level of its height, the third number of its pose.

    levels:
      L1: {map: floor1.yaml, elevation: 0}
      L2: {map: floor2.yaml, elevation: 8}
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Iterator, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error, listed, warning
from pursue_gen.drawing.ground import Ground, Point, read_ground
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_gen.language.scenario import Pose, Scenario
from pursue_runtime.bounded import BadText, node_value
from pursue_runtime.controller.whereabouts import STOREY

_HINT = "name each level with its map: levels: {L1: {map: floor1.yaml, elevation: 0}, …}"
_NAME = re.compile(r"\w+", re.ASCII)  # it stands in names of files and frames

Ways = Mapping[Tuple[str, str], Sequence[Point]]
"""The two places of a way → the bends of its path, from the first to the second (metres)."""


@dataclass(frozen=True)
class Level:
    """A map, called `file`, and what it shows: the level of this `name` and `elevation` (metres), or where there is no
    other map (`elevation` None) all places. `ways`: the paths on it, as far as they are known."""

    ground: Ground
    file: Path = Path("map.yaml")
    name: str = ""
    elevation: Optional[float] = None
    ways: Ways = field(default_factory=dict)

    @property
    def map_name(self) -> str:
        """What the map is called in remarks and messages."""
        return f"{self.file.name} ({self.name})" if self.name else self.file.name

    def has(self, pose: Optional[Pose]) -> bool:
        """Return True if the pose is on this level."""
        return pose is not None and (self.elevation is None or abs(pose.z - self.elevation) <= STOREY)


def read_levels(file: Path, whole: bool = False) -> Tuple[Level, ...]:
    """The levels of a yaml file, or the one map that it is; `whole`: as for `read_ground`. Raises PursueError (exit
    status 2) for what cannot be used."""
    text = read_text(file, "a map of map_server, such as map.yaml")
    tree = compose_yaml(text, str(file), "MAP010", _HINT)
    nodes = {key.value: value for key, value in tree.value} if tree is not None and tree.id == "mapping" else {}
    if "levels" not in nodes:
        return (Level(read_ground(file, whole), file),)
    given = nodes["levels"]
    if len(tree.value) > 1 or given.id != "mapping" or not given.value:
        what = "expected levels: and nothing else, with a line for each level"
        if str(file).endswith(".building.yaml"):
            what = "this is a building of Open-RMF, and no map: a map is what map_saver has saved of a robot's"
        raise _unusable(what, file, tree)
    found: List[Level] = []
    for key, value in given.value:
        level = _level(str(key.value), value, file, whole)
        for other in found:
            if other.name == level.name:
                raise _unusable(f"level {level.name} stands twice", file, key)
            assert level.elevation is not None and other.elevation is not None
            if abs(level.elevation - other.elevation) <= 2 * STOREY:
                what = f"levels {other.name} and {level.name} are at the heights {other.elevation:g} and "
                raise _unusable(f"{what}{level.elevation:g}, so places are on both", file, value)
        found.append(level)
    return tuple(found)


def _level(name: str, node: Any, file: Path, whole: bool) -> Level:
    try:
        given = node_value(node)
    except BadText as problem:
        raise _unusable(problem.reason, file, node) from None
    if not _NAME.fullmatch(name):
        raise _unusable(f"level {name!r} has to be called by letters, digits and _", file, node)
    if not isinstance(given, dict) or set(given) != {"map", "elevation"}:
        raise _unusable(f"level {name} has to have a map and an elevation", file, node)
    elevation = given["elevation"]
    if not isinstance(given["map"], str) or not given["map"]:
        raise _unusable(f"the map of level {name} is no file", file, node)
    if isinstance(elevation, bool) or not isinstance(elevation, (int, float)):
        raise _unusable(f"the elevation of level {name} is no number of metres", file, node)
    place = file.parent / given["map"]
    return Level(read_ground(place, whole), place, name, float(elevation))


def _unusable(what: str, file: Path, node: Any) -> PursueError:
    return PursueError([error("MAP010", what, span_of(node, str(file)), _HINT)])


def check_levels(scenario: Scenario, levels: Sequence[Level]) -> Iterator[Diagnostic]:
    """Warnings about levels without places, and where one map is for places of several heights. Raises PursueError for
    places that are on no level."""
    placed = [(poi, poi.pose) for poi in scenario.pois if poi.pose is not None]
    if levels[0].elevation is None:
        apart = [poi for poi, pose in placed if abs(pose.z - placed[0][1].z) > STOREY]
        if apart:
            message = f"{apart[0].name} is on another floor than {placed[0][0].name}, and one map is looked at for all"
            hint = "if each level has a map of its own, name a file in place of the map, with a line for each level: "
            yield warning("MAP010", message, apart[0].span, f"{hint}levels: {{L1: {{map: floor1.yaml, elevation: 0}}}}")
        return
    astray = [(poi, pose) for poi, pose in placed if not any(level.has(pose) for level in levels)]
    if astray:
        known = listed([f"{level.name} at {level.elevation:g}" for level in levels])
        hint = f"the levels are {known}: name the level in the file, too, or correct the third number of the pose"
        found = [
            error("MAP010", f"{poi.name} is at the height {pose.z:g}, where no level is", poi.span, hint)
            for poi, pose in astray[:10]
        ]
        raise PursueError(found)
    for level in levels:
        if not any(level.has(pose) for _, pose in placed):
            message = f"no place is on level {level.name}, which is at the height {level.elevation:g}"
            yield warning("MAP010", message, scenario.pois[0].span, "the third number of a pose is the place's height")


def on_level(scenario: Scenario, level: Level) -> Scenario:
    """The scenario without the poses that are on other levels."""
    pois = (poi if level.has(poi.pose) else replace(poi, pose=None, spots=()) for poi in scenario.pois)
    return scenario if level.elevation is None else replace(scenario, pois=tuple(pois))
