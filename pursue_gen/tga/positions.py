"""The numbers of an agent's positions.

POIs count from 1. On the way from POI i to POI j the original writes the digits of both, negative: -ij; at work at
POI i: -ii. With ten POIs or more two ways may get one number (-111 is 1 to 11 and 11 to 1). Where that happens, or a
number would not fit UPPAAL's 16-bit integers, every way and every work place gets a number of its own instead:
-1, -2, … both directions of each connection in the order of their declaration, then the POIs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import Diagnostic, warning
from pursue_gen.language.scenario import Connection, Poi

_SMALLEST = -32768

Way = Tuple[str, str]
"""From one POI to another; from a POI to itself: at work there."""


@dataclass(frozen=True)
class Positions:
    """The numbers of a scenario's positions. `note`: a remark where they are not the original's."""

    pois: Mapping[str, int]
    ways: Mapping[Way, int]
    note: Optional[Diagnostic] = None

    def at(self, poi: str) -> int:
        """At a POI."""
        return self.pois[poi]

    def going(self, a: str, b: str) -> int:
        """On the way from a to b."""
        return self.ways[a, b]

    def doing(self, poi: str) -> int:
        """At work at a POI."""
        return self.ways[poi, poi]


def positions(pois: Sequence[Poi], connections: Sequence[Connection]) -> Positions:
    """The numbers for these POIs and connections."""
    numbers = {poi.name: number for number, poi in enumerate(pois, start=1)}
    ways: List[Way] = [way for connection in connections for way in _both(connection)]
    ways += [(poi.name, poi.name) for poi in pois]
    digits = {(a, b): -int(f"{numbers[a]}{numbers[b]}") for a, b in ways}
    note = _note(digits, connections)
    codes = {way: -number for number, way in enumerate(dict.fromkeys(ways), start=1)} if note else digits
    return Positions(numbers, codes, note)


def _both(connection: Connection) -> Tuple[Way, Way]:
    """Both directions of a connection, the declared one first: numbers do not depend on what can be taken."""
    return (connection.a, connection.b), (connection.b, connection.a)


def _note(digits: Mapping[Way, int], connections: Sequence[Connection]) -> Optional[Diagnostic]:
    """Why the digits cannot be used, None where they can."""
    spans = {way: connection.span for connection in connections for way in _both(connection)}
    end = "positions on the way and at work are numbered -1, -2, … instead of by the digits of their POIs"
    hint = "nothing has to be changed; tools that read the original's position numbers will not understand these"
    seen: Dict[int, Way] = {}
    for way, code in digits.items():
        if code < _SMALLEST:
            return warning(
                "TGA011", f"{_shown(way)} would be number {code}, too small for UPPAAL: {end}", spans.get(way), hint
            )
        if code in seen:
            both = f"{_shown(seen[code])} and {_shown(way)} would both be number {code}"
            return warning("TGA011", f"{both}: {end}", spans.get(way, spans.get(seen[code])), hint)
        seen[code] = way
    return None


def _shown(way: Way) -> str:
    return f"being at work at {way[0]}" if way[0] == way[1] else f"the way from {way[0]} to {way[1]}"
