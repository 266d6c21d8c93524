"""Windows that hold a share of later times, from the times that were measured.

With many times nothing is assumed of how they are distributed: between the k-th smallest and the k-th largest of n lies
at least the share p of all later ones, with a probability that follows from n, k and p alone (Wilks 1941). With fewer,
the logarithms of the times are taken to be normally distributed, and the window is their tolerance interval (Howe
1969, with the chi-square quantile of Wilson and Hilferty): a factor on both sides of the mean that grows as there are
fewer times. It reaches at least SLIGHT beyond what was measured: times of one day may be more alike than those of
several. With less than FEW times the window is a margin around them, and no share can be claimed.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, exp, floor, lgamma, log, sqrt
from statistics import NormalDist, fmean, stdev
from typing import List, Optional, Sequence, Tuple

from pursue_gen.thresholds import from_below, narrowed

SHARE, CONFIDENCE = 0.99, 0.95
"""Of all later times so many are to be in a window; with so high a probability they are. Not measured."""

FEW = 5
"""With less times there is a margin only: from half the shortest to twice the longest. Not measured."""

MARGIN = 2.0
"""A window of few times is from the shortest divided by so much to the longest times so much. Not measured."""

SLIGHT = 0.05
"""By this part of the shortest and of the longest time a window that is fitted reaches beyond them at least. Measured
on five drives of a robot."""

COUNTED, FITTED, GUESSED = "counted", "fitted", "guessed"
"""What a window rests on: order alone; times with a normally distributed logarithm; a margin."""

_FENCE = 3.0
"""Interquartile ranges beyond a quartile from which on a time is an outlier (Tukey's outer fence). Not measured: what
statistics takes."""
_FOR_OUTLIERS = 8
"""With less times none is an outlier: their quartiles say too little. Not measured."""
_PARTS = 10
"""So many parts of the times are each held against the window of all others. Not measured."""


@dataclass(frozen=True)
class Window:
    """From `low` to `high`, in the unit of the times; `basis` is COUNTED, FITTED or GUESSED."""

    low: float
    high: float
    basis: str


@dataclass(frozen=True)
class Spread:
    """Times in figures: how many, the extremes, quartiles, the 95th percentile, mean, and deviation (0 of one)."""

    count: int
    least: float
    quarter: float
    median: float
    three_quarters: float
    p95: float
    most: float
    mean: float
    deviation: float


def window_of(times: Sequence[float], share: float = SHARE, confidence: float = CONFIDENCE) -> Window:
    """The window of times, each more than 0. Raises ValueError for none."""
    ordered = sorted(times)
    if not ordered or ordered[0] <= 0:
        raise ValueError("expected times, each more than 0")
    if len(ordered) < FEW:
        return Window(ordered[0] / MARGIN, ordered[-1] * MARGIN, GUESSED)
    dropped = _dropped(len(ordered), share, confidence)
    if dropped is not None:
        return Window(ordered[dropped], ordered[-1 - dropped], COUNTED)
    logs = [log(time) for time in ordered]
    reach = tolerance_factor(len(logs), share, confidence) * stdev(logs)
    low, high = exp(fmean(logs) - reach), exp(fmean(logs) + reach)
    return Window(min(low, (1 - SLIGHT) * ordered[0]), max(high, (1 + SLIGHT) * ordered[-1]), FITTED)


def spread_of(times: Sequence[float]) -> Spread:
    """The figures of one time or more."""
    ordered = sorted(times)
    parts = (quantile(ordered, share) for share in (0.25, 0.5, 0.75, 0.95))
    deviation = stdev(ordered) if len(ordered) > 1 else 0.0
    quarter, median, three_quarters, p95 = parts
    return Spread(
        len(ordered), ordered[0], quarter, median, three_quarters, p95, ordered[-1], fmean(ordered), deviation
    )


def quantile(ordered: Sequence[float], share: float) -> float:
    """The quantile of sorted values, between two of them in proportion."""
    place = share * (len(ordered) - 1)
    below = floor(place)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])


def outliers(times: Sequence[float]) -> Tuple[int, ...]:
    """The places of the times that are far from the others: beyond a quartile by more than three times the distance of
    the quartiles. None among less than eight.
    """
    if len(times) < _FOR_OUTLIERS:
        return ()
    ordered = sorted(times)
    low, high = quantile(ordered, 0.25), quantile(ordered, 0.75)
    fence = _FENCE * (high - low)
    return tuple(place for place, time in enumerate(times) if not low - fence <= time <= high + fence)


def times_needed(share: float = SHARE, confidence: float = CONFIDENCE) -> int:
    """How many times it takes until their least and their most make a window without assuming a distribution."""
    found = from_below(2, lambda count: confidence_of(count, 0, share) >= confidence)
    assert found is not None, "the confidence comes to 1"
    return found


def confidence_of(count: int, dropped: int, share: float) -> float:
    """With which probability the window of so many times without so many at each end holds the share, whatever their
    distribution is.
    """
    outside = 2 * (dropped + 1)  # at least so many of the parts between the times lie outside
    if outside > count + 1:
        return 0.0
    ways = lgamma(count + 1)
    terms = (  # logarithms: share**count is too small for a number where there are very many times
        ways - lgamma(number + 1) - lgamma(count - number + 1) + number * log(1 - share) + (count - number) * log(share)
        for number in range(outside)
    )
    return max(0.0, 1.0 - sum(map(exp, terms)))


@lru_cache(maxsize=None)
def _dropped(count: int, share: float, confidence: float) -> Optional[int]:
    """How many times may be left out at each end; None: there are too few."""
    if confidence_of(count, 0, share) < confidence:
        return None
    # The confidence falls with each one that is left out.
    return narrowed(0, count, lambda dropped: confidence_of(count, dropped, share) < confidence)[0]


@lru_cache(maxsize=None)
def tolerance_factor(count: int, share: float, confidence: float) -> float:
    """How many deviations of normally distributed values their tolerance interval reaches to each side (Howe)."""
    normal, freedom = NormalDist(), count - 1
    part = 2 / (9 * freedom)
    chi = freedom * (1 - part + normal.inv_cdf(1 - confidence) * sqrt(part)) ** 3
    return normal.inv_cdf((1 + share) / 2) * sqrt((1 + 1 / count) * freedom / chi)


def held_out(times: Sequence[float], share: float = SHARE) -> Tuple[int, int]:
    """How many of the times are in the window that the others make, and of how many that was tried.

    The times are dealt into ten parts in turn; each part is held against the window of the nine others.
    """
    parts: List[List[float]] = [list(times[number::_PARTS]) for number in range(min(_PARTS, len(times)))]
    held = 0
    if len(parts) < 2:
        return 0, 0
    for number, part in enumerate(parts):
        others = [time for other, each in enumerate(parts) if other != number for time in each]
        window = window_of(others, share)
        held += sum(window.low <= time <= window.high for time in part)
    return held, len(times)


def rounded(window: Window, step: float) -> Tuple[int, int]:
    """The window in whole steps, larger on both sides and never empty: below `low` and not below `high`."""
    low = max(0, ceil(window.low / step - _NEAR) - 1)
    return low, max(low + 1, ceil(window.high / step - _NEAR))


_NEAR = 1e-9
"""Steps by which a window's end may be beside a whole number of them by rounding."""
