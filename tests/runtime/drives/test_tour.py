"""The order of drives: all ways so often as is wanted, with few drives more."""

from __future__ import annotations

from typing import Dict, List, Set, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_runtime.drives.tour import Way, next_way

PLACES = "abcdef"


@st.composite
def two_way(draw: st.DrawFn) -> List[Way]:
    """The ways of a connected building, in both directions."""
    size = draw(st.integers(2, len(PLACES)))
    pairs = {(PLACES[draw(st.integers(0, at - 1))], PLACES[at]) for at in range(1, size)}
    more = draw(st.sets(st.tuples(st.sampled_from(PLACES[:size]), st.sampled_from(PLACES[:size])), max_size=5))
    pairs |= {(a, b) for a, b in more if a < b}
    return [way for a, b in sorted(pairs) for way in ((a, b), (b, a))]


ENDS = st.tuples(st.sampled_from(PLACES), st.sampled_from(PLACES))
ONE_WAY = st.sets(ENDS.filter(lambda way: way[0] != way[1]), max_size=12)


def driven(ways: List[Way], start: str, times: int, most: int) -> Tuple[List[Way], Dict[Way, int]]:
    """The drives from a place on, and what is left at their end."""
    left, place, tour = dict.fromkeys(ways, times), start, []
    for _ in range(most):
        way = next_way(place, left, ways)
        if way is None:
            break
        assert way[0] == place and way in left
        tour.append(way)
        left[way] -= 1
        place = way[1]
    return tour, left


def reached(ways: List[Way], start: str) -> Set[str]:
    found = {start}
    for _ in PLACES:
        found |= {b for a, b in ways if a in found}
    return found


@given(two_way(), st.integers(1, 4))
def test_ways_in_both_directions_need_no_drive_more(ways: List[Way], times: int) -> None:
    tour, left = driven(ways, "a", times, 10_000)
    assert len(tour) == times * len(ways) and set(left.values()) == {0}
    assert tour[-1][1] == "a"


@given(ONE_WAY, st.integers(1, 3))
def test_whatever_the_ways_are_a_tour_ends(some: Set[Way], times: int) -> None:
    ways = sorted(some)
    tour, left = driven(ways, "a", times, 2000)
    assert len(tour) < 2000
    there = {way for way in ways if way[0] in reached(ways, "a")}
    assert {way for way in ways if left[way] < times} <= there
    if all("a" in reached(ways, place) for place in reached(ways, "a")):  # one can always go on
        assert all(left[way] <= 0 for way in there)


def test_a_tour_that_is_broken_off_has_driven_all_ways_about_equally_often() -> None:
    ways = [("a", "b"), ("b", "a"), ("a", "c"), ("c", "a")]
    tour, _ = driven(ways, "a", 5, 12)
    assert {way: tour.count(way) for way in ways} == dict.fromkeys(ways, 3)


def test_of_ways_that_lead_nowhere_else_the_last_one_is_driven_last() -> None:
    ways = [("a", "end"), ("a", "b"), ("b", "a")]
    assert driven(ways, "a", 1, 10)[0] == [("a", "b"), ("b", "a"), ("a", "end")]


def test_where_nothing_is_left_there_is_no_way() -> None:
    assert next_way("a", {("a", "b"): 0}, [("a", "b")]) is None
    assert next_way("b", {("a", "b"): 1}, [("a", "b")]) is None
