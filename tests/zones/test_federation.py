"""Federations: every operation against its definition, point by point."""

from __future__ import annotations

from hypothesis import given

from pursue_gen.zones.dbm import Dbm, raw
from pursue_gen.zones.federation import Federation, predt
from tests.synthesis.zones import DIM, Point, delays, federations, later, points, times, zones


@given(federations, federations, points)
def test_union_intersect_minus(a: Federation, b: Federation, point: Point) -> None:
    in_a, in_b = a.contains(point), b.contains(point)
    assert a.union(b).contains(point) == (in_a or in_b)
    assert a.intersect(b).contains(point) == (in_a and in_b)
    assert a.minus(b).contains(point) == (in_a and not in_b)


@given(federations, federations, zones)
def test_includes(a: Federation, b: Federation, zone: Dbm) -> None:
    assert a.includes(b) == (not b.minus(a))
    assert a.includes_zone(zone) == (not Federation.of(zone).minus(a))
    assert a.union(b).includes(a)


@given(federations, points)
def test_reduced_has_the_same_points_in_no_more_zones(federation: Federation, point: Point) -> None:
    reduced = federation.reduced()
    assert reduced.contains(point) == federation.contains(point)
    assert reduced.includes(federation) and federation.includes(reduced)
    assert len(reduced.zones) <= len(federation.zones)


@given(federations, points, delays)
def test_past_and_future(federation: Federation, point: Point, delay: int) -> None:
    hits = [t for t in times(point, delay) if federation.contains(later(point, t))]
    assert federation.down().contains(point) == bool(hits)
    assert federation.down_within(delay).contains(point) == any(t <= delay for t in hits)
    assert not federation.contains(point) or federation.up().contains(later(point, times(point)[1]))


@given(federations, federations, points)
def test_predt_is_its_definition_with_a_closed_interval(good: Federation, bad: Federation, point: Point) -> None:
    wins = False
    for t in times(point):
        if bad.contains(later(point, t)):
            break
        if good.contains(later(point, t)):
            wins = True
            break
    assert predt(good, bad).contains(point) == wins


@given(federations, zones, points, delays)
def test_lasting(federation: Federation, universe: Dbm, point: Point, delay: int) -> None:
    stays = all(federation.contains(later(point, t)) for t in times(point, delay) if t <= delay)
    assert federation.lasting(delay, universe).contains(point) == (universe.contains(point) and stays)


def test_touching_zones_merge_and_zones_with_a_gap_do_not() -> None:
    low = Dbm.of(DIM, [(1, 0, raw(2, False))])
    high = Dbm.of(DIM, [(0, 1, raw(-2, True))])
    open_low = Dbm.of(DIM, [(1, 0, raw(2, True))])
    assert low and high and open_low
    assert Federation.of(low, high).reduced() == Federation.of(Dbm.universe(DIM))
    assert len(Federation.of(open_low, high).reduced().zones) == 2


def test_a_tie_is_lost() -> None:
    at_two = Dbm.of(2, [(1, 0, raw(2, False)), (0, 1, raw(-2, False))])
    after_two = Dbm.of(2, [(0, 1, raw(-2, True))])
    assert at_two and after_two
    assert not predt(Federation.of(at_two), Federation.of(at_two))
    assert not predt(Federation.of(after_two), Federation.of(after_two)), "no first instant: the race is lost as well"
    assert predt(Federation.of(at_two), Federation.of(after_two)).includes_zone(at_two.down())


def test_the_empty_federation() -> None:
    assert not Federation() and not predt(Federation(), Federation.of(Dbm.universe(2)))
    assert Federation.of(Dbm.zero(2)).includes(Federation())
