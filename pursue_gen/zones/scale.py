"""Exact times as integers: the factors that make them so."""

from __future__ import annotations

from fractions import Fraction
from math import gcd
from typing import Iterable


def least_common_multiple(numbers: Iterable[int]) -> int:
    """The least positive multiple of all of the positive numbers; 1 for none."""
    result = 1
    for number in numbers:
        result = result * number // gcd(result, number)
    return result


def common_denominator(times: Iterable[Fraction]) -> int:
    """The least scale at which all of the times are integers; 1 for none."""
    return least_common_multiple({time.denominator for time in times})
