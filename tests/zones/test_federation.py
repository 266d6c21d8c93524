"""Federations: every operation against its definition, point by point, in each implementation."""

from __future__ import annotations

from hypothesis import given

from pursue_gen.zones.dbm import Dbm, raw
from pursue_gen.zones.federation import Federation, predt
from tests.oracle.zones import past
from tests.synthesis.zones import DIM, Point, delays, federations, later, points, times, zones
from tests.zones.twins import Twin, holds, includes, includes_zone, lasting, python, twins


@twins
@given(a=federations, b=federations, point=points)
def test_union_intersect_minus(twin: Twin, a: Federation, b: Federation, point: Point) -> None:
    mine, its = twin.federation(a), twin.federation(b)
    in_a, in_b = a.contains(point), b.contains(point)
    assert holds(mine.union(its), point) == (in_a or in_b)
    assert holds(mine.intersect(its), point) == (in_a and in_b)
    assert holds(mine.minus(its), point) == (in_a and not in_b)


@twins
@given(a=federations, b=federations, zone=zones)
def test_includes(twin: Twin, a: Federation, b: Federation, zone: Dbm) -> None:
    mine, its, alone = twin.federation(a), twin.federation(b), twin.federation(Federation((zone,)))
    assert includes(mine, its) == (not its.minus(mine))
    assert includes_zone(mine, twin.zone(zone)) == (not alone.minus(mine))
    assert includes(mine.union(its), mine)


@twins
@given(federation=federations, point=points)
def test_reduced_has_the_same_points_in_no_more_zones(twin: Twin, federation: Federation, point: Point) -> None:
    its = twin.federation(federation)
    reduced = its.reduced()
    assert holds(reduced, point) == federation.contains(point)
    assert includes(reduced, its) and includes(its, reduced)
    assert len(reduced.zones) <= len(federation.zones)


@twins
@given(federation=federations, point=points)
def test_disjoint_zones_hold_each_point_once(twin: Twin, federation: Federation, point: Point) -> None:
    zones_with_it = [zone for zone in twin.federation(federation).disjoint() if holds(zone, point)]
    assert len(zones_with_it) == federation.contains(point)


@given(federations, points, delays)
def test_past(federation: Federation, point: Point, delay: int) -> None:
    hits = [t for t in times(point, delay) if federation.contains(later(point, t))]
    assert past(federation).contains(point) == bool(hits)


@twins
@given(good=federations, bad=federations, point=points)
def test_predt_is_its_definition_with_a_closed_interval(
    twin: Twin, good: Federation, bad: Federation, point: Point
) -> None:
    wins = False
    for t in times(point):
        if bad.contains(later(point, t)):
            break
        if good.contains(later(point, t)):
            wins = True
            break
    assert holds(twin.predt(twin.federation(good), twin.federation(bad)), point) == wins


@twins
@given(federation=federations, universe=zones, point=points, delay=delays)
def test_lasting(twin: Twin, federation: Federation, universe: Dbm, point: Point, delay: int) -> None:
    stays = all(federation.contains(later(point, t)) for t in times(point, delay) if t <= delay)
    stay = lasting(twin.federation(federation), delay, twin.zone(universe))
    assert holds(stay, point) == (universe.contains(point) and stays)


@twins
def test_touching_zones_merge_and_zones_with_a_gap_do_not(twin: Twin) -> None:
    low = Dbm.of(DIM, [(1, 0, raw(2, False))])
    high = Dbm.of(DIM, [(0, 1, raw(-2, True))])
    open_low = Dbm.of(DIM, [(1, 0, raw(2, True))])
    assert low and high and open_low
    (whole,) = twin.federation(Federation((low, high))).reduced().zones
    assert python(whole) == Dbm.universe(DIM)
    assert len(twin.federation(Federation((open_low, high))).reduced().zones) == 2


@twins
def test_a_tie_is_lost(twin: Twin) -> None:
    at_two = Dbm.of(2, [(1, 0, raw(2, False)), (0, 1, raw(-2, False))])
    after_two = Dbm.of(2, [(0, 1, raw(-2, True))])
    assert at_two and after_two
    at, after = twin.federation(Federation((at_two,))), twin.federation(Federation((after_two,)))
    assert not twin.predt(at, at)
    assert not twin.predt(after, after), "no first instant: the race is lost as well"
    assert includes_zone(twin.predt(at, after), twin.zone(at_two.down()))


def test_the_empty_federation() -> None:
    assert not Federation() and not predt(Federation(), Federation((Dbm.universe(2),)))
    assert includes(Federation((Dbm.zero(2),)), Federation())
