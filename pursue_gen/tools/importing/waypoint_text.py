"""The text of a scenario from a list of places: their poses, robots that stand at the first ones, a patrol."""

from __future__ import annotations

import math
from itertools import combinations
from typing import Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import usage_error
from pursue_gen.language.formatter import format_text
from pursue_gen.language.kinds import RESERVED
from pursue_gen.language.usable import proposal
from pursue_gen.tools.importing.scenario_text import one_line, told_apart
from pursue_gen.tools.importing.waypoints import Waypoint

_LONGEST = 50
"""Letters of a label, with room for a number behind it."""


def robots_named(names: Optional[str], places: Sequence[Waypoint]) -> Sequence[str]:
    """The robots of these names, with commas between; one for None. Raises PursueError where there is no place for each
    of them to stand at."""
    found = list(dict.fromkeys(name.strip() for name in (names or "bot").split(",") if name.strip()))
    if not 0 < len(found) <= len(places):
        hint = "name as many as there are places, or fewer, as in --robots bot1,bot2"
        raise usage_error(f"--robots names {len(found)} robots, and there are {len(places)} places", hint)
    return found


def waypoints_text(
    title: str, places: Sequence[Waypoint], speeds: Mapping[str, float], file: str, connect: bool, traffic: bool
) -> str:
    """The scenario, laid out; `speeds`: robot → metres per second, in their order; `file` is its name in messages;
    `connect`: neighbours have a way along a straight line; `traffic`: places and ways hold one robot each."""
    shown = dict(told_apart({k: _title(place) or f"p{k + 1}" for k, place in enumerate(places)}))
    taken: Set[str] = set()
    names, agents = _named(list(shown.values()), taken), _named(list(speeds), taken)
    ways = [(a, b) for a, b in neighbours([(each.x, each.y, each.z) for each in places]) if connect]
    how = "along straight lines" if ways else "none yet: survey writes them, or write your own"
    parts = [
        [f"// Places from {one_line(title)}. Metres and seconds. Ways: {how}.",
         "// Say what is wanted below (docs/language.md)."],
        ["unit second"],
        [f'poi "{names[k]}"{_label(shown[k], names[k])} //[{_pose(each)}]' for k, each in enumerate(places)],
        [f"connect {names[a]} and {names[b]} distance {_metres(places[a], places[b]):g}" for a, b in ways],
        [f'agent "{agents[k]}"{_label(name, agents[k])} controllable speed {speed:g} location {names[k]}'
         for k, (name, speed) in enumerate(speeds.items())],
        [*(f"objective: every {room} holds 1 robot" for room in ("place", "way") if traffic and len(agents) > 1),
         f"objective: patrol {', '.join(names)} by {agents[0] if len(agents) == 1 else 'any robot'}"],
    ]  # fmt: skip
    return format_text("\n\n".join("\n".join(part) for part in parts if part) + "\n", file)


def neighbours(points: Sequence[Tuple[float, float, float]]) -> Iterator[Tuple[int, int]]:
    """Pairs of points of which none is nearer to both than they are to each other (Toussaint, "The relative
    neighbourhood graph of a finite planar set", 1980): each can be reached from each other."""
    for a, b in combinations(range(len(points)), 2):
        apart = math.dist(points[a], points[b])
        if all(max(math.dist(points[a], each), math.dist(points[b], each)) >= apart for each in points):
            yield a, b


def _named(titles: Sequence[str], taken: Set[str]) -> List[str]:
    """Names that the language accepts, each once."""
    found: List[str] = []
    for title in titles:
        found.append(proposal(title, RESERVED, taken))
        taken.add(found[-1])
    return found


def _title(place: Waypoint) -> str:
    """What people call it, as a label can hold it."""
    return one_line(place.name)[:_LONGEST].strip()


def _label(title: str, name: str) -> str:
    return f' label "{one_line(title)}"' if title != name else ""


def _pose(place: Waypoint) -> str:
    values = (f"{round(value, 3) + 0.0:.3f}" for value in (place.x, place.y, place.z))  # no -0.000
    turned = (f"{value + 0.0:.6g}" for value in place.orientation)
    return ", ".join((*values, *turned))


def _metres(one: Waypoint, other: Waypoint) -> float:
    return max(round(math.dist((one.x, one.y, one.z), (other.x, other.y, other.z)), 1), 0.1)
