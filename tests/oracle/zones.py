"""What only oracles ask of zones and federations, as the native zone library has it too."""

from __future__ import annotations

from functools import lru_cache
from typing import Iterable, List, Optional, Sequence, Tuple

from pursue_gen.zones.dbm import INF, LE_ZERO, Dbm, raw
from pursue_gen.zones.federation import Federation


def hull(one: Dbm, other: Dbm) -> Dbm:
    """The smallest zone that includes both."""
    assert one.dim == other.dim
    return Dbm(one.dim, tuple(map(max, one.m, other.m)))


def reset(zone: Dbm, indices: Iterable[int]) -> Dbm:
    """The zone after these clocks are set to 0."""
    dim, m = zone.dim, list(zone.m)
    for i in indices:
        assert 0 < i < dim
        for j in range(dim):
            m[i * dim + j] = m[j]
            m[j * dim + i] = m[j * dim]
        m[i * dim + i] = LE_ZERO
    return Dbm(dim, tuple(m))


def before_reset(zone: Dbm, indices: Iterable[int]) -> Optional[Dbm]:
    """The valuations that setting these clocks to 0 takes into the zone; None if there are none."""
    dim, clocks = zone.dim, tuple(indices)
    assert 0 not in clocks
    inside = zone.constrained_all((i, 0, LE_ZERO) for i in clocks)
    if inside is None:
        return None
    m = list(inside.m)
    for i in clocks:
        for j in range(dim):
            m[i * dim + j] = INF
            m[j * dim + i] = m[j * dim]
        m[i] = m[i * dim + i] = LE_ZERO
    return Dbm(dim, tuple(m))


def extrapolated(zone: Dbm, max_constants: Sequence[int]) -> Dbm:
    """A zone that includes this one and differs only beyond the constants (ExtraM, Behrmann et al. 2006).

    `max_constants[i]` is the largest scaled constant that clock i is compared with; entry 0 is 0.
    """
    assert len(max_constants) == zone.dim and max_constants[0] == 0
    highs, lows = _extrapolation(tuple(max_constants))
    m = [INF if bound > high else bound if bound >= low else low for bound, high, low in zip(zone.m, highs, lows)]
    if tuple(m) == zone.m:
        return zone
    _close(m, zone.dim)
    return Dbm(zone.dim, tuple(m))


def lasting(federation: Federation, delay: int, universe: Dbm) -> Federation:
    """The points of the universe from which every time in [0, delay] stays in the federation.

    Time may leave the universe.
    """
    assert delay >= 0
    inside = federation.intersect_zone(universe)
    if delay == 0 or not inside:
        return inside
    if len(federation.zones) == 1:
        zone: Optional[Dbm] = federation.zones[0]
        for i in range(1, universe.dim):
            bound = INF if zone is None else zone.m[i * universe.dim]
            if zone is not None and bound < INF:
                zone = zone.constrained(i, 0, bound - 2 * delay)
        return Federation() if zone is None else Federation((zone,)).intersect_zone(universe)
    outside = Federation((universe.up_within(delay),)).minus(federation)
    return inside.minus(union(zone.down_within(delay) for zone in outside.zones))


def union(zones: Iterable[Dbm]) -> Federation:
    """The union of the zones, without those that lie in another."""
    return Federation().union(Federation(tuple(zones)))


def includes_zone(federation: Federation, zone: Dbm) -> bool:
    """True if every point of the zone is in it."""
    return any(mine.includes(zone) for mine in federation.zones) or not Federation((zone,)).minus(federation)


def past(federation: Federation) -> Federation:
    """The valuations from which some time leads into it."""
    return union(zone.down() for zone in federation.zones)


@lru_cache(maxsize=4096)
def _extrapolation(max_constants: Tuple[int, ...]) -> Tuple[Tuple[int, ...], Tuple[int, ...]]:
    """For each bound of a matrix: above what it becomes infinite, and what it is at least."""
    dim = len(max_constants)
    pairs = [(i, j) for i in range(dim) for j in range(dim)]
    highs = (INF if i == j else raw(max_constants[i], strict=False) for i, j in pairs)
    lows = (-INF if i == j else raw(-max_constants[j], strict=True) for i, j in pairs)
    return tuple(highs), tuple(lows)


def _close(m: List[int], dim: int) -> None:
    """Makes the matrix of a zone that holds a point canonical, in place (Floyd and Warshall)."""
    for k in range(dim):
        row_k = m[k * dim : k * dim + dim]
        for i in range(dim):
            m_ik = m[i * dim + k]
            if m_ik >= INF or i == k:
                continue
            at = i * dim
            for m_kj in row_k:
                if m_kj < INF:
                    through = m_ik + m_kj - ((m_ik | m_kj) & 1)
                    if through < m[at]:
                        m[at] = through
                at += 1
