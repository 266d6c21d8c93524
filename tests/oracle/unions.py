"""Unions of zones, as lists: what the checker does with them."""

from __future__ import annotations

from typing import List, Sequence

from pursue_gen.zones.dbm import Dbm


def without(pieces: Sequence[Dbm], zone: Dbm) -> List[Dbm]:
    """The points of the pieces that are not in the zone."""
    return [part for piece in pieces for part in piece.minus(zone)]


def outside(zone: Dbm, others: Sequence[Dbm]) -> List[Dbm]:
    """The points of the zone that are in none of the others."""
    if any(other.includes(zone) for other in others):
        return []
    rest = [zone]
    for other in others:
        # Asked once for the whole: the parts are many.
        if not zone.is_disjoint(other):
            rest = without(rest, other)
            if not rest:
                break
    return rest


def merged(zones: Sequence[Dbm]) -> List[Dbm]:
    """The same points in fewer zones where two make one."""
    result: List[Dbm] = []
    for zone in zones:
        k = 0
        while k < len(result):
            other = result[k]
            if other.includes(zone):
                zone = other
            elif not zone.includes(other):
                both = zone.joined(other)
                if both is None:
                    k += 1
                    continue
                zone = both
            del result[k]
            k = 0
        result.append(zone)
    return result


def with_neighbours(zone: Dbm, others: Sequence[Dbm]) -> Dbm:
    """The zone together with those of the others with which it makes one zone."""
    grown = True
    while grown:
        grown = False
        for other in others:
            both = None if zone.includes(other) else zone.joined(other)
            if both is not None:
                zone, grown = both, True
    return zone
