"""Windows from measured times: they hold what they claim, and say when they cannot claim anything."""

from __future__ import annotations

from fractions import Fraction
from math import comb
from random import Random
from typing import List

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from benchmarks.calibration import NOISES, coverage
from pursue_gen.tools.calibration.windows import (
    COUNTED,
    FEW,
    FITTED,
    GUESSED,
    confidence_of,
    held_out,
    outliers,
    quantile,
    rounded,
    spread_of,
    times_needed,
    tolerance_factor,
    window_of,
)

TIMES = st.lists(st.floats(0.01, 1000.0), min_size=1, max_size=60)


@given(TIMES)
def test_a_window_holds_all_that_was_measured_where_times_are_few(times: List[float]) -> None:
    window = window_of(times)
    assert 0 < window.low <= min(times) and max(times) <= window.high
    assert window.basis == (GUESSED if len(times) < FEW else FITTED)


def test_times_that_are_all_alike_still_get_a_window() -> None:
    window = window_of([13.2, 13.25, 13.3, 13.25, 13.2])
    assert (window.low, window.high) == pytest.approx((0.95 * 13.2, 1.05 * 13.3), rel=0.01)


@given(TIMES, st.randoms())
def test_the_order_of_times_does_not_matter(times: List[float], random: Random) -> None:
    mixed = random.sample(times, len(times))
    ours, theirs = window_of(times), window_of(mixed)
    assert (ours.low, ours.high) == pytest.approx((theirs.low, theirs.high))
    assert spread_of(times).median == spread_of(mixed).median


@given(TIMES, st.floats(0.1, 10.0))
def test_another_unit_gives_the_same_window_in_that_unit(times: List[float], unit: float) -> None:
    one, other = window_of(times), window_of([time * unit for time in times])
    assert (other.low, other.high) == pytest.approx((one.low * unit, one.high * unit))


@example([999.0, 336.9481241291444, 677.7260046093555, 0.99999, 0.14], 0.001)  # as wide as doubles are coarse
@given(TIMES, st.sampled_from([0.001, 0.1, 0.5, 1.0, 7.0]))
def test_rounding_only_makes_a_window_larger_and_never_leaves_it_empty(times: List[float], step: float) -> None:
    window = window_of(times)
    low, high = rounded(window, step)
    assert 0 <= low < high
    assert low * step < window.low + 1e-6 and high * step >= window.high * (1 - 1e-12) - 1e-6
    assert low == 0 or low * step <= min(times)


@given(TIMES)
def test_figures_are_in_order(times: List[float]) -> None:
    spread = spread_of(times)
    figures = [spread.least, spread.quarter, spread.median, spread.three_quarters, spread.p95, spread.most]
    assert figures == sorted(figures) and spread.count == len(times)
    assert quantile(sorted(times), 0.0) == min(times) and quantile(sorted(times), 1.0) == max(times)


@given(st.integers(1, 80), st.integers(0, 4), st.sampled_from([0.5, 0.9, 0.99]))
def test_the_confidence_is_that_of_the_order_statistics(count: int, dropped: int, share: float) -> None:
    p, outside = Fraction(share), 2 * (dropped + 1)
    tail = sum(comb(count, k) * (1 - p) ** k * p ** (count - k) for k in range(min(outside, count + 1)))
    expected = 0.0 if outside > count + 1 else float(1 - tail)
    assert confidence_of(count, dropped, share) == pytest.approx(expected, abs=1e-9)


def test_so_many_times_are_needed_without_an_assumption() -> None:
    assert times_needed(0.99, 0.95) == 473  # the published figures of Wilks's two-sided interval
    assert times_needed(0.95, 0.95) == 93
    assert times_needed(0.90, 0.95) == 46
    many = [1.0 + number / 1000 for number in range(473)]
    assert window_of(many).basis == COUNTED and window_of(many[1:]).basis == FITTED
    assert (window_of(many).low, window_of(many).high) == (min(many), max(many))
    more = [1.0 + number / 1000 for number in range(1500)]
    assert min(more) < window_of(more).low and window_of(more).high < max(more)


def test_with_very_many_times_as_many_are_outside_as_may_be() -> None:
    many = [float(number) for number in range(1, 100_001)]
    window = window_of(many)
    assert 450 < window.low < 500 and window.low - 1 == 100_000 - window.high  # some 1,000 in all, less for confidence


@pytest.mark.parametrize(
    ("count", "factor"), [(5, 6.598), (10, 4.433), (20, 3.615), (50, 3.126), (100, 2.934)]
)
def test_the_factor_is_the_published_one_or_a_little_more(count: int, factor: float) -> None:
    assert factor - 0.005 <= tolerance_factor(count, 0.99, 0.95) <= 1.04 * factor


def test_times_that_are_far_from_the_others_are_outliers() -> None:
    usual = [5.0, 5.1, 4.9, 5.2, 4.8, 5.0, 5.1]
    assert outliers([*usual, 9.0]) == (7,)
    assert outliers([*usual, 5.3]) == ()
    assert outliers([5.0, 5.1, 9.0]) == ()  # too few to say


def test_what_is_held_out_is_not_in_the_window_that_it_is_held_against() -> None:
    steady = [5.0 + 0.01 * (number % 5) for number in range(40)]
    assert held_out(steady) == (40, 40)
    assert held_out([*steady, 50.0]) == (40, 41)
    assert held_out([5.0]) == (0, 0)


@pytest.mark.parametrize("times", [[], [0.0], [-1.0, 2.0]])
def test_what_is_no_time_is_refused(times: List[float]) -> None:
    with pytest.raises(ValueError, match="more than 0"):
        window_of(times)


@pytest.mark.parametrize("noise", sorted(NOISES))
@pytest.mark.parametrize("count", [10, 30])
def test_windows_hold_99_percent_of_later_drives(noise: str, count: int) -> None:
    # The random numbers are the same each time. Seldom blocked ways are known only from many drives: see the table.
    assert coverage(noise, count, windows=60, later=200, seed=7) >= (0.97 if noise == "blocked" else 0.99)
