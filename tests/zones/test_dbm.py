"""Zones: every operation against its definition, point by point, in each implementation."""

from __future__ import annotations

from fractions import Fraction
from typing import Tuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.zones.dbm import INF, LE_ZERO, Dbm, add, complement, constant, is_strict, raw
from tests.oracle import zones as oracle
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
from tests.zones.twins import Twin, before_reset, extrapolated, holds, hull, python, reset, twins

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


@twins
@given(a=zones, b=zones, cut=zones, delay=delays)
def test_two_zones_are_joined_exactly_where_they_make_one(twin: Twin, a: Dbm, b: Dbm, cut: Dbm, delay: int) -> None:
    parts = a.minus(cut)
    for one, other in [(a, b), *((part, cut) for part in parts), *((part.up_within(delay), cut) for part in parts)]:
        whole = hull(one, other)
        between = [rest for piece in whole.minus(one) for rest in piece.minus(other)]
        joined = twin.zone(one).joined(twin.zone(other))
        assert (None if joined is None else python(joined)) == (None if between else whole)


@twins
@given(a=zones, b=zones)
def test_an_intersection_is_canonical(twin: Twin, a: Dbm, b: Dbm) -> None:
    common = twin.zone(a).intersect(twin.zone(b))
    assert common is None or _is_canonical(python(common))


@twins
@given(zone=zones, other=zones, delay=delays, clocks=resets)
def test_results_are_canonical(twin: Twin, zone: Dbm, other: Dbm, delay: int, clocks: Tuple[int, ...]) -> None:
    its = twin.zone(zone)
    made = [its, its.up(), its.down(), its.up_within(delay), its.down_within(delay), hull(its, twin.zone(other))]
    made += [reset(its, clocks), extrapolated(its, (0,) + (2,) * CLOCKS), *its.minus(twin.zone(other))]
    made += [before for before in (before_reset(its, clocks),) if before is not None]
    assert all(_is_canonical(python(result)) for result in made)


@twins
@given(zone=zones, i=indices, j=indices, bound=bounds, point=points)
def test_constrained(twin: Twin, zone: Dbm, i: int, j: int, bound: Tuple[int, bool], point: Point) -> None:
    # Only Python's takes a bound on the difference of a clock and itself.
    result = (zone if i == j else twin.zone(zone)).constrained(i, j, raw(*bound))
    inside = result is not None and holds(result, point)
    assert inside == (zone.contains(point) and _holds(point, i, j, *bound))


@twins
@given(a=zones, b=zones, point=points)
def test_intersect_and_minus(twin: Twin, a: Dbm, b: Dbm, point: Point) -> None:
    mine, its = twin.zone(a), twin.zone(b)
    common = mine.intersect(its)
    assert (common is not None and holds(common, point)) == (a.contains(point) and b.contains(point))
    pieces = sum(holds(piece, point) for piece in mine.minus(its))
    assert pieces == (a.contains(point) and not b.contains(point)), "each point in one piece, and only once"


@twins
@given(a=zones, b=zones, point=points)
def test_includes_and_hull(twin: Twin, a: Dbm, b: Dbm, point: Point) -> None:
    mine, its = twin.zone(a), twin.zone(b)
    assert mine.includes(its) == (not its.minus(mine))
    whole = hull(mine, its)
    assert whole.includes(mine) and whole.includes(its)
    assert holds(whole, point) or not (a.contains(point) or b.contains(point))
    if mine.is_disjoint(its):
        assert mine.intersect(its) is None


@given(zones, zones)
def test_a_gap_leaves_no_common_point(a: Dbm, b: Dbm) -> None:
    if a.has_gap(b):
        assert a.intersect(b) is None


@twins
@given(zone=zones, point=points, delay=delays)
def test_past(twin: Twin, zone: Dbm, point: Point, delay: int) -> None:
    hits = [t for t in times(point, delay) if zone.contains(later(point, t))]
    assert holds(twin.zone(zone).down(), point) == bool(hits)
    assert holds(twin.zone(zone).down_within(delay), point) == any(t <= delay for t in hits)


@twins
@given(zone=zones, point=points, delay=delays)
def test_future(twin: Twin, zone: Dbm, point: Point, delay: int) -> None:
    hits = [t for t in past_times(point, delay) if zone.contains(later(point, -t))]
    assert holds(twin.zone(zone).up(), point) == bool(hits)
    assert holds(twin.zone(zone).up_within(delay), point) == any(t <= delay for t in hits)


@twins
@given(zone=zones, point=points, clocks=resets)
def test_reset_and_its_inverse(twin: Twin, zone: Dbm, point: Point, clocks: Tuple[int, ...]) -> None:
    its = twin.zone(zone)
    after = tuple(Fraction(0) if i + 1 in clocks else x for i, x in enumerate(point))
    assert not zone.contains(point) or holds(reset(its, clocks), after)
    before = before_reset(its, clocks)
    assert (before is not None and holds(before, point)) == zone.contains(after)
    if before is not None:
        assert its.includes(reset(before, clocks)), "the image of the inverse image lies in the zone"


@twins
@given(zone=zones, clocks=resets, point=points)
def test_reset_gives_nothing_but_images(twin: Twin, zone: Dbm, clocks: Tuple[int, ...], point: Point) -> None:
    after = tuple(Fraction(0) if i + 1 in clocks else x for i, x in enumerate(point))
    image = reset(twin.zone(zone), clocks)
    origin = zone.constrained_all(
        constraint
        for i, x in enumerate(after, start=1)
        if i not in clocks
        for constraint in ((i, 0, raw(int(x), False)), (0, i, raw(-int(x), False)))
    )
    if all(x.denominator == 1 for x in after):
        assert holds(image, after) == (origin is not None)


@twins
@given(zone=zones, point=points)
def test_extrapolation_adds_only_what_lies_beyond_the_constants(twin: Twin, zone: Dbm, point: Point) -> None:
    largest = (0, 2, 3, 1)
    wide = extrapolated(twin.zone(zone), largest)
    assert wide.includes(twin.zone(zone))
    assert extrapolated(wide, largest) == wide
    if all(x <= m for x, m in zip(point, largest[1:])):
        assert holds(wide, point) == zone.contains(point), "within the constants nothing is added"
    assert python(wide) == oracle.extrapolated(zone, largest), "the implementations agree on what is"


@twins
def test_the_universe_and_the_start_are_the_same_in_all(twin: Twin) -> None:
    for zone in (Dbm.universe(DIM), Dbm.zero(DIM)):
        assert python(twin.zone(zone)) == zone
    kind = type(twin.zone(Dbm.zero(DIM)))
    assert python(kind.universe(DIM)) == Dbm.universe(DIM) and python(kind.zero(DIM)) == Dbm.zero(DIM)


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
