"""Random zones and points for the property tests, and what holds along a point's future, worked out point by point."""

from __future__ import annotations

from fractions import Fraction
from typing import List, Sequence, Tuple

from hypothesis import assume
from hypothesis import strategies as st

from pursue_gen.zones.dbm import Dbm, raw
from pursue_gen.zones.federation import Federation

CLOCKS = 3
DIM = CLOCKS + 1
LARGEST = 4
"""No constant in a random zone is larger."""

Point = Tuple[Fraction, ...]


def _constraints() -> st.SearchStrategy[List[Tuple[int, int, int]]]:
    one = st.tuples(
        st.integers(0, CLOCKS), st.integers(0, CLOCKS), st.integers(-LARGEST, LARGEST), st.booleans()
    ).filter(lambda c: c[0] != c[1])
    return st.lists(one.map(lambda c: (c[0], c[1], raw(c[2], c[3]))), max_size=5)


def _zone(constraints: List[Tuple[int, int, int]]) -> Dbm:
    zone = Dbm.of(DIM, constraints)
    assume(zone is not None)
    assert zone is not None
    return zone


zones: st.SearchStrategy[Dbm] = _constraints().map(_zone)
federations: st.SearchStrategy[Federation] = st.lists(zones, max_size=3).map(lambda z: Federation(tuple(z)))
points: st.SearchStrategy[Point] = st.tuples(
    *[st.integers(0, 6 * (LARGEST + 1)).map(lambda n: Fraction(n, 6)) for _ in range(CLOCKS)]
)
delays = st.integers(0, 3)
resets = st.sets(st.integers(1, CLOCKS)).map(lambda s: tuple(sorted(s)))


def later(point: Sequence[Fraction], time: Fraction) -> Point:
    """The point after that time."""
    return tuple(x + time for x in point)


def times(point: Sequence[Fraction], *also: int) -> List[Fraction]:
    """Times at which, and between which, anything that the constants can tell of the point's future may change.

    Differences of clocks stay, so it changes only where some clock is at a constant: these times and one between each
    two of them (and one after all) stand for every time >= 0. `also` are further times that a test asks about.
    """
    marks = {Fraction(0), *(Fraction(t) for t in also)}
    for x in point:
        marks |= {c - x for c in range(0, 3 * LARGEST) if c >= x}
    ordered = sorted(marks)
    between = [(a + b) / 2 for a, b in zip(ordered, ordered[1:])]
    return sorted([*ordered, *between, ordered[-1] + 1])


def past_times(point: Sequence[Fraction], *also: int) -> List[Fraction]:
    """The same for the way back, as far as all clocks stay >= 0."""
    furthest = min(point)
    marks = {Fraction(0), furthest, *(Fraction(t) for t in also if t <= furthest)}
    for x in point:
        marks |= {x - c for c in range(0, 3 * LARGEST) if 0 <= x - c <= furthest}
    ordered = sorted(marks)
    return sorted([*ordered, *((a + b) / 2 for a, b in zip(ordered, ordered[1:]))])
