"""Lists of places that people have for move_base or Nav2, as names with poses: YAML and CSV in the usual shapes. And
the text of a scenario from one: the poses, robots that stand at the first ones, a patrol.

YAML: a list or a mapping of entries, below any keys; an entry is [x, y], [x, y, yaw], [x, y, z, yaw], [x, y, z, qx, qy,
qz, qw], or a mapping with such a list or with `position` and `orientation`, below `pose` or not: as messages of ROS are
(PoseStamped, PoseArray, MoveBaseGoal, markers), also those that `rostopic echo` prints. CSV: with a line of titles, or
name, x, y and what follows. Metres and radians.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from io import StringIO
from itertools import combinations
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, error, usage_error
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_gen.language.formatter import format_text
from pursue_gen.language.names import proposal
from pursue_gen.tools.importing.scenario_text import label_text, one_line, told_apart
from pursue_runtime.bounded import DATA, BadText, node_value

_HINT = "write each as name: [x, y, yaw], in metres and radians; docs/import.md has other shapes"

_FARTHEST = 1_000_000.0
"""Metres from the origin of a map, at most."""

MOST = 500
"""So many places at most. Not measured."""

_SAME = 0.05
"""Metres between two markers that are one place: its arrow and its text. Not measured."""

_LONGEST = 50
"""Letters of a label, with room for a number behind it."""

_POSES = ("pose", "target_pose", "goal", "location")
"""Keys below which the pose of an entry stands."""
_NAMES = ("name", "text", "label")
"""Keys of its name."""
_YAWS = ("yaw", "theta", "heading")
_QUATERNION = ("x", "y", "z", "w")

Orientation = Tuple[float, float, float, float]
_AHEAD: Orientation = (0.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Waypoint:
    """A place: metres on the map, and a unit quaternion (x, y, z, w); `name` is empty where it has none."""

    name: str
    x: float
    y: float
    z: float
    orientation: Orientation
    span: Span


def is_building(file: Path) -> bool:
    """True for a building of Open-RMF, by the file's name or its keys. Raises PursueError."""
    if file.name.endswith(".building.yaml") or file.suffix.lower() == ".csv":
        return file.suffix.lower() != ".csv"
    tree = compose_yaml(_first(read_text(file, "a YAML file", DATA.size)), str(file), "IMP005", _HINT, DATA)
    keys = [str(key.value) for key, _ in tree.value] if tree is not None and tree.id == "mapping" else []
    return "levels" in keys


def read_waypoints(file: Path) -> Tuple[Waypoint, ...]:
    """The places of a file, in its order. Raises PursueError (exit status 2) with all that is wrong."""
    text = read_text(file, "a list of places (*.yaml, *.csv)", DATA.size)
    reader = _Table(str(file)) if file.suffix.lower() == ".csv" else _Tree(str(file))
    found = list(_once(reader.waypoints(text)))
    if not reader.findings and not 0 < len(found) <= MOST:
        what = f"{len(found):,} places are in it, and {MOST} may be" if found else "no place with a pose is in it"
        reader.wrong(what, Span(str(file), 1, 1, 1, 2))
    if reader.findings:
        raise PursueError(reader.findings)
    return tuple(found)


def _once(found: Iterator[Waypoint]) -> List[Waypoint]:
    """Markers at one point are one place, with the text of that one which has a text."""
    kept: List[Waypoint] = []
    for each in found:
        same = (k for k, one in enumerate(kept) if math.dist((one.x, one.y, one.z), (each.x, each.y, each.z)) < _SAME)
        k = next((k for k in same if not (kept[k].name and each.name)), None)
        if k is None:
            kept.append(each)
        elif not kept[k].name:
            kept[k] = replace(kept[k], name=each.name)
    return kept


def _first(text: str) -> str:
    """The first document of a text: `rostopic echo` ends each message with a line of dashes."""
    return text.partition("\n---")[0] + "\n"


class _Reader:
    """Collects what is wrong."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.findings: List[Diagnostic] = []

    def wrong(self, message: str, span: Span) -> None:
        """Something is wrong there."""
        self.findings.append(error("IMP005", message, span, _HINT))

    def waypoints(self, text: str) -> Iterator[Waypoint]:
        """The places of a text."""
        raise NotImplementedError

    def waypoint(self, name: str, at: Sequence[float], turned: Orientation, span: Span) -> Iterator[Waypoint]:
        """The place, where its numbers may be such."""
        length = math.sqrt(sum(part * part for part in turned))
        if any(not abs(value) <= _FARTHEST for value in at):
            self.wrong(f"a place is within {_FARTHEST / 1000:,.0f} km of the origin of its map", span)
        elif not 0.9 <= length <= 1.1:
            self.wrong(f"an orientation is a quaternion of length 1, and this one has {length:.2f}", span)
        else:
            a, b, c, d = (part / length for part in turned)
            x, y, z = (*at, 0.0)[:3]
            yield Waypoint(name.strip(), x, y, z, (a, b, c, d), span)

    def listed(self, name: str, values: Sequence[float], span: Span) -> Iterator[Waypoint]:
        """The place of a list of numbers."""
        if len(values) not in (2, 3, 4, 7):
            self.wrong(f"a pose of {len(values)} numbers", span)
        elif len(values) == 7:
            yield from self.waypoint(name, values[:3], (values[3], values[4], values[5], values[6]), span)
        else:
            turned = yawed(values[-1]) if len(values) > 2 else _AHEAD
            yield from self.waypoint(name, values[:2] if len(values) < 4 else values[:3], turned, span)


def yawed(yaw: float) -> Orientation:
    """The orientation of what is turned by so many radians."""
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


# YAML -----------------------------------------------------------------------------------------------------------------


class _Tree(_Reader):
    """Goes through the tree of nodes."""

    def waypoints(self, text: str) -> Iterator[Waypoint]:
        root = compose_yaml(_first(text), self.file, "IMP005", _HINT, DATA)
        return iter(()) if root is None else self._below(root, "")

    def _below(self, node: Any, name: str) -> Iterator[Waypoint]:
        """The places that a node is, or has below it; `name`: the key that it stands behind."""
        if node.id == "sequence" and node.value and all(item.id == "scalar" for item in node.value):
            values = self._numbers(node)
            yield from self.listed(name, values, span_of(node, self.file)) if values else ()
        elif node.id == "sequence":
            for item in node.value:
                yield from self._below(item, "")
        elif node.id == "mapping":
            entries = _entries(node)
            if entries.get("points") is not None and entries["points"].value:
                return  # a marker of lines
            own = [str(entries[key].value) for key in _NAMES if key in entries and entries[key].value]
            if _is_pose(entries):
                yield from self._entry(own[0] if own else name, node)
                return
            for key, value in entries.items():
                yield from self._below(value, key)

    def _entry(self, name: str, node: Any) -> Iterator[Waypoint]:
        """The place of a mapping with a pose in it, or with its coordinates."""
        span, around = span_of(node, self.file), {}
        while node.id == "mapping" and not _has_place(_entries(node)):
            around = _entries(node)
            node = next((around[key] for key in _POSES if key in around), None)
            if node is None:
                self.wrong("position and orientation are expected, or x and y", span)
                return
        if node.id == "sequence" and "orientation" not in around:
            yield from self._below(node, name)
            return
        here = _entries(node) if node.id == "mapping" else {"position": node, "orientation": around["orientation"]}
        at = self._parts(here.get("position", node), ("x", "y", "z"))
        yaw = next((here[key] for key in _YAWS if key in here), None)
        turned = None if yaw is None else self._numbers(yaw)
        parts = self._parts(here["orientation"], _QUATERNION) if "orientation" in here else list(_AHEAD)
        if at is None or len(at) < 2 or (parts is not None and len(parts) != 4):
            self.wrong("a position of x, y and z, and an orientation of x, y, z and w are expected", span)
        elif turned or parts:
            orientation = yawed(turned[0]) if turned else _with_w_last(parts or (), node.id == "sequence")
            yield from self.waypoint(name, at, orientation, span)

    def _parts(self, node: Any, keys: Sequence[str]) -> Optional[List[float]]:
        """The numbers of a list, or those behind these keys; None where one is wrong."""
        if node.id != "mapping":
            return self._numbers(node)
        entries = _entries(node)
        found = [self._numbers(entries[key]) for key in keys if key in entries]
        return None if None in found else [number for one in found for number in one or ()]

    def _numbers(self, node: Any) -> Optional[List[float]]:
        """A number, or those of a list; None where one is no number, which is said."""
        found: List[float] = []
        for item in node.value if node.id == "sequence" else [node]:
            try:
                value = node_value(item)
            except BadText:
                value = None
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                self.wrong("a number is expected", span_of(item, self.file))
                return None
            found.append(float(value))
        return found


def _entries(node: Any) -> Dict[str, Any]:
    return {str(key.value): value for key, value in node.value}


def _has_place(entries: Dict[str, Any]) -> bool:
    return "position" in entries or {"x", "y"} <= entries.keys()


def _is_pose(entries: Dict[str, Any]) -> bool:
    return _has_place(entries) or any(key in entries and entries[key].id != "scalar" for key in _POSES)


def _with_w_last(parts: Sequence[float], first: bool) -> Orientation:
    """A quaternion x, y, z, w. In one that is written w, x, y, z, as Nav2's panel of rviz does beside a list, the two
    in the middle are 0 for whatever stands on a floor; where both may be meant, `first` says it."""
    a, b, c, d = parts
    return (b, c, d, a) if b == c == 0 and (a != 0 or first) else (a, b, c, d)


# CSV ------------------------------------------------------------------------------------------------------------------


class _Table(_Reader):
    """Goes through the lines."""

    def waypoints(self, text: str) -> Iterator[Waypoint]:
        start = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
        delimiter = max(",;\t", key=start.count)
        titles: Optional[List[str]] = None
        for number, row in enumerate(csv.reader(StringIO(text), delimiter=delimiter), start=1):
            cells = [cell.strip() for cell in row]
            span = Span(self.file, number, 1, number, 1 + max(1, sum(map(len, row)) + len(row) - 1))
            if not any(cells) or cells[0].startswith("#"):
                continue
            if titles is None:
                titles = [_title(cell) for cell in cells]
                if {"x", "y"} <= set(titles):
                    continue
                titles = []
            yield from self._titled(dict(zip(titles, cells)), span) if titles else self._untitled(cells, span)

    def _untitled(self, cells: Sequence[str], span: Span) -> Iterator[Waypoint]:
        """A line of a name, or none, and numbers."""
        named = not _is_number(cells[0])
        values = self._numbers(cells[1:] if named else cells, span)
        yield from self.listed(cells[0] if named else "", values, span) if values is not None else ()

    def _titled(self, cells: Dict[str, str], span: Span) -> Iterator[Waypoint]:
        at = self._numbers([cells.get(key) or "0" if key == "z" else cells.get(key, "") for key in "xyz"], span)
        yaw = next((key for key in ("yaw", "degrees") if cells.get(key)), "")
        parts = [cells.get(f"q{key}") or "0" for key in _QUATERNION]
        turned = self._numbers([cells[yaw]] if yaw else parts if set(parts) != {"0"} else ["0", "0", "0", "1"], span)
        if at is not None and turned is not None:
            angle = math.radians(turned[0]) if yaw == "degrees" else turned[0]
            x, y, z, w = yawed(angle) if yaw else turned
            yield from self.waypoint(cells.get("name", ""), at, (x, y, z, w), span)

    def _numbers(self, cells: Sequence[str], span: Span) -> Optional[List[float]]:
        wrong = next((cell for cell in cells if not _is_number(cell)), None)
        if wrong is not None:
            self.wrong(f"a number is expected, not {wrong!r}", span)
            return None
        return [float(cell) for cell in cells]


def _title(text: str) -> str:
    """What is in a column, by its title: name, x, y, z, yaw, degrees, qx … qw; other titles as they are."""
    last = text.lower().split("(")[0].strip().replace("%", "").replace(" ", "_").split(".")
    if len(last) > 1 and last[-2] in ("orientation", "rotation"):
        return f"q{last[-1]}"
    word = last[-1].strip()
    if word in ("theta", "heading", "yaw_rad"):
        return "yaw"
    if word in ("yaw_deg", "yaw_degrees", "theta_deg", "degrees"):
        return "degrees"
    for before, quaternion in (("pos_", ""), ("position_", ""), ("orientation_", "q"), ("rot_", "q"), ("o", "q")):
        if word.startswith(before) and word[len(before) :] in _QUATERNION:
            return quaternion + word[len(before) :]
    return "name" if word in ("name", "label", "id", "waypoint", "place", "location") else word


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False


# The text -------------------------------------------------------------------------------------------------------------


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
    shown = dict(told_apart({k: _called(place) or f"p{k + 1}" for k, place in enumerate(places)}))
    taken: Set[str] = set()
    names, agents = _named(list(shown.values()), taken), _named(list(speeds), taken)
    ways = [(a, b) for a, b in neighbours([(each.x, each.y, each.z) for each in places]) if connect]
    how = "along straight lines" if ways else "none yet: survey writes them, or write your own"
    parts = [
        [f"// Places from {one_line(title)}. Metres and seconds. Ways: {how}.",
         "// Say what is wanted below (docs/language.md)."],
        ["unit second"],
        [f'poi "{names[k]}"{label_text(shown[k], names[k])} //[{_pose(each)}]' for k, each in enumerate(places)],
        [f"connect {names[a]} and {names[b]} distance {_metres(places[a], places[b]):g}" for a, b in ways],
        [f'agent "{agents[k]}"{label_text(name, agents[k])} controllable speed {speed:g} location {names[k]}'
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
        found.append(proposal(title, taken))
        taken.add(found[-1])
    return found


def _called(place: Waypoint) -> str:
    """What people call it, as a label can hold it."""
    return one_line(place.name)[:_LONGEST].strip()


def _pose(place: Waypoint) -> str:
    values = (f"{round(value, 3) + 0.0:.3f}" for value in (place.x, place.y, place.z))  # no -0.000
    turned = (f"{value + 0.0:.6g}" for value in place.orientation)
    return ", ".join((*values, *turned))


def _metres(one: Waypoint, other: Waypoint) -> float:
    return max(round(math.dist((one.x, one.y, one.z), (other.x, other.y, other.z)), 1), 0.1)
