"""Thresholds are found by halving: what is next to each other stays so, and what is not known ends the search."""

from __future__ import annotations

from typing import List, Optional

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.thresholds import from_below, narrowed


@given(st.integers(-50, 50), st.integers(1, 200), st.data())
def test_the_two_numbers_next_to_the_threshold_are_found(low: int, width: int, data: st.DataObject) -> None:
    threshold = data.draw(st.integers(low + 1, low + width))
    asked: List[int] = []

    def holds(number: int) -> bool:
        asked.append(number)
        return number >= threshold

    assert narrowed(low, low + width, holds) == (threshold - 1, threshold)
    assert len(asked) <= width.bit_length() and all(low < number < low + width for number in asked)


@given(st.integers(1, 1000), st.integers(0, 30))
def test_what_is_not_known_leaves_the_threshold_between(threshold: int, known: int) -> None:
    left = known

    def holds(number: int) -> Optional[bool]:
        nonlocal left
        left -= 1
        return None if left < 0 else number >= threshold

    low, high = narrowed(0, 1000, holds)
    assert low < threshold <= high
    assert known < 10 or high - low == 1


@given(st.integers(1, 3000), st.integers(2, 20), st.integers(1, 100))
def test_from_below_it_is_found_about(threshold: int, part: int, first: int) -> None:
    found = from_below(first, lambda number: number >= threshold, part)
    assert found is not None and threshold <= found <= threshold + max(1, found // part)
    assert from_below(first, lambda number: number >= threshold) == threshold


def test_it_is_not_looked_for_beyond_the_most() -> None:
    assert from_below(8, lambda number: False, most=32) is None
    assert from_below(8, lambda number: number >= 20, most=32) == 20
