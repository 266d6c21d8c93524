"""What only the native zones have: fewer zones for a set, and work that is counted and can be ended."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Callable, List, Optional

import pytest
from hypothesis import given

from pursue_gen.zones.dbm import Dbm
from pursue_gen.zones.federation import Federation
from tests.synthesis.zones import DIM, Point, federations, points, zones
from tests.zones.twins import holds, native_zones, natives, python


def within(bound: int, value: Fraction) -> bool:
    """Whether a difference of clocks is within a raw bound."""
    return bool(value < bound >> 1 or (bound & 1 and value == bound >> 1))


@natives
@given(zone=zones, federation=federations, point=points)
def test_a_box_holds_what_is_between_the_bounds_of_each_clock(
    binding: Any, zone: Dbm, federation: Federation, point: Point
) -> None:
    parts = [part for part in (zone.intersect(other) for other in federation.zones) if part is not None]
    if not parts:
        return
    box = native_zones(binding, [zone])[0].boxed(native_zones(binding, parts))
    assert box.is_canonical()
    ways = [(0, x) for x in range(1, DIM)] + [(x, 0) for x in range(1, DIM)]
    values = (Fraction(0), *point)
    between = all(within(max(part.m[i * DIM + j] for part in parts), values[i] - values[j]) for i, j in ways)
    assert holds(box, point) == (zone.contains(point) and between)
    assert all(python(box).includes(part) for part in parts)


@natives
@given(zone=zones, inner=zones, point=points)
def test_around_a_zone_is_what_is_outside_of_it(binding: Any, zone: Dbm, inner: Dbm, point: Point) -> None:
    (outer, hole) = native_zones(binding, [zone, inner])
    pieces = outer.around(hole)
    assert all(piece.is_canonical() for piece in pieces)
    assert any(holds(piece, point) for piece in pieces) == (zone.contains(point) and not inner.contains(point))


def unit_squares(count: int) -> List[Dbm]:
    """Zones with gaps between them, so that none can be merged."""
    made = (
        Dbm.of(DIM, [(x, 0, 2 * (2 * k + 1) + 1) for x in (1, 2)] + [(0, x, -2 * 2 * k + 1) for x in (1, 2)])
        for k in range(count)
    )
    return [zone for zone in made if zone is not None]


OPERATIONS: List[Any] = [
    pytest.param(lambda b, z: b.minus([z[0]], z[1:]), id="minus"),
    pytest.param(lambda b, z: b.intersection(z, z), id="intersection"),
    pytest.param(lambda b, z: b.inserted(z, z[0]), id="inserted"),
    pytest.param(lambda b, z: b.reduced(z), id="reduced"),
    pytest.param(lambda b, z: b.disjoint(z), id="disjoint"),
    pytest.param(lambda b, z: b.predt(z[:1], z[1:]), id="predt"),
    pytest.param(lambda b, z: b.lasting(z, 1), id="lasting"),
]


@natives
@pytest.mark.parametrize("operation", OPERATIONS)
def test_long_work_on_zones_can_be_ended(
    binding: Any, operation: Callable[[Any, List[Any]], Optional[List[Any]]]
) -> None:
    from pursue_gen.zones.native import _zones

    many = native_zones(binding, unit_squares(30))
    assert len(many) == 30
    few = many[:2]
    assert len(_zones.within_effort(1000, 10**9, lambda: operation(binding, few) or [])) >= 1
    with pytest.raises(RuntimeError, match="enough"):
        _zones.within_effort(20, 10**9, lambda: operation(binding, many) or [])
    assert operation(binding, many), "without a limit it goes on as before"
