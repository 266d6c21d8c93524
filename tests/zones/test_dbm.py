"""Zones: every operation against its definition, point by point."""

from __future__ import annotations

from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.zones.dbm import INF, LE_ZERO, Dbm, add, complement, constant, is_strict, raw
from tests.synthesis.zones import (
    CLOCKS,
    DIM,
    LARGEST,
    Point,
    delays,
    later,
    past_times,
    points,
    resets,
    times,
    zones,
)

indices = st.integers(0, CLOCKS)
bounds = st.tuples(st.integers(-LARGEST, LARGEST), st.booleans())


def _holds(point: Point, i: int, j: int, c: int, strict: bool) -> bool:
    values = (Fraction(0), *point)
    return values[i] - values[j] < c if strict else values[i] - values[j] <= c


@given(bounds, bounds)
def test_raw_bounds_add_and_compare_as_bounds_do(a: Tuple[int, bool], b: Tuple[int, bool]) -> None:
    assert add(raw(*a), raw(*b)) == raw(a[0] + b[0], a[1] or b[1])
    assert (raw(*a) < raw(*b)) == ((a[0], not a[1]) < (b[0], not b[1]))
    assert (constant(raw(*a)), is_strict(raw(*a))) == a
    assert complement(raw(*a)) == raw(-a[0], not a[1])
    assert add(INF, raw(*a)) == INF == add(raw(*b), INF)


def _is_canonical(zone: Dbm) -> bool:
    return all(zone.m[i] <= LE_ZERO == zone.m[i * DIM + i] for i in range(DIM)) and all(
        zone.m[i * DIM + j] <= add(zone.m[i * DIM + k], zone.m[k * DIM + j])
        for i in range(DIM)
        for j in range(DIM)
        for k in range(DIM)
    )


@given(zones, zones, zones, delays)
def test_two_zones_are_joined_exactly_where_they_make_one(a: Dbm, b: Dbm, cut: Dbm, delay: int) -> None:
    parts = a.minus(cut)
    for one, other in [(a, b), *((part, cut) for part in parts), *((part.up_within(delay), cut) for part in parts)]:
        hull, joined = one.hull(other), one.joined(other)
        between = [rest for piece in hull.minus(one) for rest in piece.minus(other)]
        assert joined == (None if between else hull)


@given(zones, zones)
def test_an_intersection_is_canonical(a: Dbm, b: Dbm) -> None:
    common = a.intersect(b)
    assert common is None or _is_canonical(common)


@given(zones, delays, resets)
def test_what_operations_give_is_canonical(zone: Dbm, delay: int, clocks: Tuple[int, ...]) -> None:
    made = [zone, zone.up(), zone.down(), zone.up_within(delay), zone.up_after(delay), zone.down_within(delay)]
    made += [zone.reset(clocks), zone.extrapolated((0,) + (2,) * CLOCKS)]
    made += [z for z in (zone.before_reset(clocks), zone.lasting(delay)) if z is not None]
    assert all(_is_canonical(result) for result in made)


@given(zones, indices, indices, bounds, points)
def test_constrained(zone: Dbm, i: int, j: int, bound: Tuple[int, bool], point: Point) -> None:
    result = zone.constrained(i, j, raw(*bound))
    inside = result is not None and result.contains(point)
    assert inside == (zone.contains(point) and _holds(point, i, j, *bound))


@given(zones, zones, points)
def test_intersect_and_minus(a: Dbm, b: Dbm, point: Point) -> None:
    common = a.intersect(b)
    assert (common is not None and common.contains(point)) == (a.contains(point) and b.contains(point))
    pieces = sum(piece.contains(point) for piece in a.minus(b))
    assert pieces == (a.contains(point) and not b.contains(point)), "each point in one piece, and only once"


@given(zones, zones, points)
def test_includes_and_hull(a: Dbm, b: Dbm, point: Point) -> None:
    assert a.includes(b) == (not b.minus(a))
    hull = a.hull(b)
    assert hull.includes(a) and hull.includes(b)
    assert hull.contains(point) or not (a.contains(point) or b.contains(point))
    if a.has_gap(b) or a.is_disjoint(b):
        assert a.intersect(b) is None


@given(zones, points, delays)
def test_past(zone: Dbm, point: Point, delay: int) -> None:
    hits = [t for t in times(point, delay) if zone.contains(later(point, t))]
    assert zone.down().contains(point) == bool(hits)
    assert zone.down_within(delay).contains(point) == any(t <= delay for t in hits)


@given(zones, points, delays)
def test_future(zone: Dbm, point: Point, delay: int) -> None:
    hits = [t for t in past_times(point, delay) if zone.contains(later(point, -t))]
    assert zone.up().contains(point) == bool(hits)
    assert zone.up_within(delay).contains(point) == any(t <= delay for t in hits)
    assert zone.up_after(delay).contains(point) == any(t > delay for t in hits)


@given(zones, points, delays)
def test_lasting(zone: Dbm, point: Point, delay: int) -> None:
    result = zone.lasting(delay)
    stays = all(zone.contains(later(point, t)) for t in times(point, delay) if t <= delay)
    assert (result is not None and result.contains(point)) == stays


@given(zones, points, resets)
def test_reset_and_its_inverse(zone: Dbm, point: Point, clocks: Tuple[int, ...]) -> None:
    after = tuple(Fraction(0) if i + 1 in clocks else x for i, x in enumerate(point))
    assert not zone.contains(point) or zone.reset(clocks).contains(after)
    before = zone.before_reset(clocks)
    assert (before is not None and before.contains(point)) == zone.contains(after)
    if before is not None:
        assert zone.includes(before.reset(clocks)), "the image of the inverse image lies in the zone"


@given(zones, resets, points)
def test_reset_gives_nothing_but_images(zone: Dbm, clocks: Tuple[int, ...], point: Point) -> None:
    after = tuple(Fraction(0) if i + 1 in clocks else x for i, x in enumerate(point))
    image = zone.reset(clocks)
    origin = zone.constrained_all(
        constraint
        for i, x in enumerate(after, start=1)
        if i not in clocks
        for constraint in ((i, 0, raw(int(x), False)), (0, i, raw(-int(x), False)))
    )
    if all(x.denominator == 1 for x in after):
        assert image.contains(after) == (origin is not None)


@given(zones, points)
def test_extrapolation_only_forgets_what_lies_beyond_the_constants(zone: Dbm, point: Point) -> None:
    largest = (0, 2, 3, 1)
    wide = zone.extrapolated(largest)
    assert wide.includes(zone)
    assert wide.extrapolated(largest) == wide
    if all(x <= m for x, m in zip(point, largest[1:])):
        # The clocks are within the constants: nothing is forgotten there.
        assert wide.contains(point) == zone.contains(point)


def test_universe_and_zero() -> None:
    zero = (Fraction(0),) * CLOCKS
    assert Dbm.zero(DIM).contains(zero) and Dbm.universe(DIM).includes(Dbm.zero(DIM))
    assert not Dbm.zero(DIM).contains((Fraction(0), Fraction(1, 9), Fraction(0)))
    assert Dbm.of(DIM, [(1, 0, raw(2, True)), (0, 1, raw(-2, False))]) is None
    assert Dbm.zero(DIM).up().m[1 * DIM + 2] == LE_ZERO, "clocks grow at one rate"


def test_a_zone_is_a_value() -> None:
    zone = Dbm.zero(2)
    assert {zone: 1}[Dbm(2, (1, 1, 1, 1))] == 1
    with pytest.raises(AttributeError):
        zone.dim = 3  # type: ignore[misc]
