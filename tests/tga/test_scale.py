"""Scales at which exact times are integers."""

from __future__ import annotations

from fractions import Fraction
from typing import List

from hypothesis import given
from hypothesis import strategies as st

from pursue_gen.tga.scale import common_denominator, least_common_multiple


@given(st.lists(st.integers(1, 12), max_size=4))
def test_the_least_common_multiple_is_the_least_one(numbers: List[int]) -> None:
    multiple = least_common_multiple(numbers)
    assert [n for n in range(1, multiple + 1) if all(n % number == 0 for number in numbers)] == [multiple]


@given(st.lists(st.fractions(0, 5, max_denominator=12), max_size=4))
def test_times_are_integers_at_their_common_denominator(times: List[Fraction]) -> None:
    scale = common_denominator(times)
    assert all((time * scale).denominator == 1 for time in times)
    assert not any(all((time * less).denominator == 1 for time in times) for less in range(1, scale))
