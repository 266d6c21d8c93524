"""Position numbers: the original's digits where they tell positions apart, others where they do not."""

from __future__ import annotations

from typing import List, Tuple

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.diagnostics import Severity, Span
from pursue_gen.language.scenario import Connection, Poi
from pursue_gen.tga.positions import Positions, positions


def numbered(count: int, pairs: List[Tuple[int, int]]) -> Positions:
    """Positions for POIs p1 … p<count> with these connections, each on the line of its number."""
    pois = [Poi(f"p{i}", None, Span("test.pur", 1, 1, 1, 2)) for i in range(1, count + 1)]
    spans = [Span("test.pur", line, 1, line, 2) for line in range(1, len(pairs) + 1)]
    return positions(pois, [Connection(f"p{a}", f"p{b}", 1, span, (span, span)) for (a, b), span in zip(pairs, spans)])


def test_digits_of_both_pois() -> None:
    codes = numbered(14, [(3, 12), (2, 1)])
    assert codes.note is None
    assert (codes.at("p14"), codes.going("p3", "p12"), codes.going("p12", "p3")) == (14, -312, -123)
    assert (codes.going("p1", "p2"), codes.doing("p2"), codes.doing("p14")) == (-12, -22, -1414)


def test_a_collision_is_reported_and_avoided() -> None:
    codes = numbered(11, [(2, 3), (1, 11)])
    assert codes.note is not None
    assert codes.note.severity is Severity.WARNING
    assert codes.note.code == "TGA011"
    assert "-111" in codes.note.message
    assert codes.note.span is not None
    assert codes.note.span.line == 2
    assert codes.going("p1", "p11") != codes.going("p11", "p1")


def test_no_number_is_too_small_for_uppaal() -> None:
    codes = numbered(120, [(100, 101)])
    assert codes.note is not None
    assert min(codes.ways.values()) >= -32768


def test_two_ways_in_opposite_directions_have_the_numbers_of_one_way_in_both() -> None:
    assert numbered(3, [(1, 2), (2, 1)]).ways == numbered(3, [(1, 2)]).ways


@given(
    st.integers(2, 130).flatmap(
        lambda count: st.tuples(
            st.just(count),
            st.lists(
                st.tuples(st.integers(1, count), st.integers(1, count)).filter(lambda p: p[0] < p[1]), unique=True
            ),
        )
    )
)
def test_positions_are_distinguished(case: Tuple[int, List[Tuple[int, int]]]) -> None:
    count, pairs = case
    codes = numbered(count, pairs)
    numbers = [*codes.pois.values(), *codes.ways.values()]
    assert len(set(numbers)) == len(numbers) == 2 * count + 2 * len(pairs)
    assert all(number > 0 for number in codes.pois.values())
    assert all(-32768 <= number < 0 for number in codes.ways.values())
