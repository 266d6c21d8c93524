"""What a building file of Open-RMF's traffic editor says of places, lanes, doors, lifts and robots; read with a place
for every error.

Vertices are numbered in each level from 0 on, as in the editor; their coordinates are pixels of the level's drawing,
with y downwards, or degrees of longitude and latitude (`coordinate_system: wgs84`). What is for a simulator's picture
alone (walls, floors, models, layers) is passed over.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Iterator, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, error
from pursue_gen.files import compose_yaml, read_text, span_of
from pursue_runtime.bounded import DATA, BadText, node_value

_HINT = "name a *.building.yaml of Open-RMF's traffic editor"
DEGREES = "wgs84"
"""The coordinate system of buildings whose coordinates are longitude and latitude."""

Properties = Mapping[str, Any]
"""Name → value, of what the editor writes as `name: [type, value]`."""


@dataclass(frozen=True)
class Vertex:
    """A point of a level; `name` is empty where it has none."""

    x: float
    y: float
    name: str
    properties: Properties
    span: Span


@dataclass(frozen=True)
class Edge:
    """A lane, a door or a measurement: between two vertices of its level."""

    start: int
    end: int
    properties: Properties
    span: Span


@dataclass(frozen=True)
class Level:
    """A floor. `elevation`: metres; `fiducials`: name → coordinates of what is above each other on all levels."""

    name: str
    elevation: float
    vertices: Tuple[Vertex, ...]
    lanes: Tuple[Edge, ...]
    doors: Tuple[Edge, ...]
    measurements: Tuple[Edge, ...]
    fiducials: Mapping[str, Tuple[float, float]]
    span: Span


@dataclass(frozen=True)
class Building:
    """What the file holds; `levels` in its order."""

    name: str
    coordinates: str
    levels: Tuple[Level, ...]
    reference: str


def read_building(file: Path) -> Building:
    """The building of a file. Raises PursueError (exit status 2) with all that is wrong."""
    text = read_text(file, "a *.building.yaml", DATA.size)
    reader = _Reader(str(file))
    building = reader.building(compose_yaml(text, str(file), "IMP001", _HINT, DATA))
    if reader.findings:
        raise PursueError(reader.findings)
    return building


@dataclass
class _Reader:
    """Goes through the tree of nodes and collects what is wrong."""

    file: str
    findings: List[Diagnostic] = field(default_factory=list)

    def building(self, root: Any) -> Building:
        """All of the file."""
        entries = self._entries(root, "the file")
        levels = self._entries(entries.get("levels"), "levels", needed=root)
        found = tuple(self._level(name, node) for name, node in levels.items())
        coordinates = self._text(entries.get("coordinate_system"), "reference_image")
        if not found and not self.findings:
            self._wrong("the building has no level", root)
        reference = self._text(entries.get("reference_level_name"), next(iter(levels), ""))
        return Building(self._text(entries.get("name"), "building"), coordinates, found, reference)

    def _level(self, name: str, node: Any) -> Level:
        entries = self._entries(node, f"level {name}")
        vertices = tuple(self._vertices(entries.get("vertices")))
        lanes, doors, measurements = (
            tuple(self._edges(entries.get(kind), kind, len(vertices))) for kind in ("lanes", "doors", "measurements")
        )
        fiducials: Dict[str, Tuple[float, float]] = {}
        for item in self._items(entries.get("fiducials"), "fiducials"):
            values = self._sequence(item, "a fiducial", "[x, y, name]", 3)
            if values:
                fiducials[self._text(values[2], "")] = (self._number(values[0]), self._number(values[1]))
        elevation = self._number(entries["elevation"]) if "elevation" in entries else 0.0
        return Level(name, elevation, vertices, lanes, doors, measurements, fiducials, span_of(node, self.file))

    def _vertices(self, node: Any) -> Iterator[Vertex]:
        for item in self._items(node, "vertices"):
            values = self._sequence(item, "a vertex", "[x, y, z, name]", 3)
            x, y = (self._number(value) for value in values[:2]) if values else (0.0, 0.0)
            name = self._text(values[3], "") if len(values) > 3 else ""
            properties = self._properties(values[4]) if len(values) > 4 else {}
            yield Vertex(x, y, name, properties, span_of(item, self.file))

    def _edges(self, node: Any, kind: str, vertices: int) -> Iterator[Edge]:
        one = {"lanes": "a lane", "doors": "a door"}.get(kind, "a measurement")
        for item in self._items(node, kind):
            values = self._sequence(item, one, "[vertex, vertex, {…}]", 2)
            ends = [self._number(value) for value in values[:2]]
            if not ends:
                continue
            if any(end != int(end) or not 0 <= end < vertices for end in ends):
                self._wrong(f"{one} between vertices that the level does not have (it has {vertices})", item)
                continue
            properties = self._properties(values[2]) if len(values) > 2 else {}
            yield Edge(int(ends[0]), int(ends[1]), properties, span_of(item, self.file))

    def _properties(self, node: Any) -> Properties:
        """`name: [type, value]`, and what has no type as it is."""
        found: Dict[str, Any] = {}
        for name, value in self._entries(node, "properties").items():
            try:
                plain = node_value(value)
            except BadText as problem:
                self._wrong(problem.reason, value)
                continue
            found[name] = plain[1] if isinstance(plain, list) and len(plain) == 2 else plain
        return found

    def _entries(self, node: Any, what: str, needed: Optional[Any] = None) -> Dict[str, Any]:
        """Key → the node of its value; nothing for a node that is not there, but where it is `needed` in another."""
        if node is None and needed is None:
            return {}
        if node is None or node.id != "mapping":
            self._wrong(f"{what}: a mapping is expected", needed if node is None else node)
            return {}
        return {str(key.value): value for key, value in node.value}

    def _items(self, node: Any, what: str) -> List[Any]:
        if node is None:
            return []
        if node.id != "sequence":
            self._wrong(f"{what}: a list is expected", node)
            return []
        return list(node.value)

    def _sequence(self, node: Any, what: str, form: str, least: int) -> List[Any]:
        if node.id != "sequence" or len(node.value) < least:
            self._wrong(f"{what} is written {form}", node)
            return []
        return list(node.value)

    def _number(self, node: Any) -> float:
        try:
            value = node_value(node)
            if isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < 1e9:
                return float(value)
        except BadText:
            pass
        self._wrong("a number is expected", node)
        return 0.0

    def _text(self, node: Any, otherwise: str) -> str:
        return otherwise if node is None or node.id != "scalar" else str(node.value)

    def _wrong(self, message: str, node: Any) -> None:
        self.findings.append(error("IMP001", message, span_of(node, self.file), _HINT))
