"""Federations: finite unions of zones, and the operators of timed games on them.

The timed predecessor is that of Cassez, David, Fleury, Larsen and Lime (Efficient on-the-fly algorithms for the
analysis of timed games, CONCUR 2005), here with a closed interval: a tie is lost.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Iterable, List, Sequence, Tuple

from pursue_gen.zones.dbm import Dbm, Number, attend


@dataclass(frozen=True)
class Federation:
    """The union of its zones, all of one dimension. They may overlap; none of them is empty; no zone: no point.

    Operations require federations of one dimension (an empty one has any), and delays of 0 or more, in scaled time.
    """

    zones: Tuple[Dbm, ...] = ()

    def __bool__(self) -> bool:
        """True if there is a point in it."""
        return bool(self.zones)

    def contains(self, point: Sequence[Number]) -> bool:
        """True if the valuation is in it; `point[k]` is the value of clock k + 1."""
        return any(zone.contains(point) for zone in self.zones)

    def union(self, other: Federation) -> Federation:
        """The points in either, without zones that lie in one other zone."""
        if not other.zones:
            return self
        return Federation(_maximal(self.zones + other.zones))

    def intersect(self, other: Federation) -> Federation:
        """The points in both."""
        common = (mine.intersect(its) for mine in self.zones for its in other.zones)
        return Federation(_maximal(zone for zone in common if zone is not None))

    def intersect_zone(self, zone: Dbm) -> Federation:
        """The points that are also in the zone."""
        return self.intersect(Federation((zone,)))

    def minus(self, other: Federation) -> Federation:
        """The points that are not in the other."""
        rest: Sequence[Dbm] = self.zones
        for its in other.zones:
            rest = [piece for part in rest for piece in part.minus(its)]
            if not rest:
                break
        return Federation(tuple(rest))

    def reduced(self) -> Federation:
        """The same points in fewer zones: none inside another, and no two whose union is convex."""
        zones = list(_maximal(self.zones))
        while True:
            hulls = (one.joined(other) for one, other in combinations(zones, 2))
            hull = next((each for each in hulls if each is not None), None)
            if hull is None:
                return Federation(tuple(zones))
            zones = [zone for zone in zones if not hull.includes(zone)] + [hull]

    def disjoint(self) -> Tuple[Dbm, ...]:
        """The same points in zones that do not overlap, few of them."""
        zones: List[Dbm] = []
        for zone in self.reduced().zones:
            zones += Federation((zone,)).minus(Federation(tuple(zones))).zones
        return tuple(zones)


def predt(good: Federation, bad: Federation) -> Federation:
    """The timed predecessor: points from which some time t leads to good, and no time in [0, t] leads to bad."""
    result: List[Dbm] = []
    for target in good.zones:
        past = target.down()
        reachable: List[Dbm] = [past]
        for obstacle in bad.zones:
            if past.is_disjoint(obstacle):
                continue
            before = _predt_convex(target, past, obstacle)
            reachable = list(_maximal(zone for a in reachable for zone in _common(a, before)))
            if not reachable:
                break
        result += reachable
    return Federation(_maximal(result))


def _predt_convex(target: Dbm, past: Dbm, obstacle: Dbm) -> List[Dbm]:
    """The timed predecessor of convex sets: (G's past minus B's past), and the past of (G within B's past, minus B)."""
    danger = obstacle.down()
    zones = list(past.minus(danger))
    threatened = target.intersect(danger)
    if threatened is not None:
        zones += [piece.down() for piece in threatened.minus(obstacle)]
    return zones


def _common(zone: Dbm, others: Iterable[Dbm]) -> List[Dbm]:
    """What the zone has in common with each of the others."""
    return [common for common in (zone.intersect(other) for other in others) if common is not None]


def _maximal(zones: Iterable[Dbm]) -> Tuple[Dbm, ...]:
    """The zones that do not lie in another one, in their order."""
    kept: List[Dbm] = []
    for zone in zones:
        attend()
        if any(other.includes(zone) for other in kept):
            continue
        kept = [other for other in kept if not zone.includes(other)]
        kept.append(zone)
    return tuple(kept)
