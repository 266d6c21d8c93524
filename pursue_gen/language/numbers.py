"""Numbers as people write them: whole ones and decimals, exact in all that is computed from them."""

from __future__ import annotations

import re
from fractions import Fraction
from math import ceil, floor
from typing import Optional, Tuple, Union

Number = Union[int, Fraction]
"""A time, a distance or an inverse speed. A whole one is an int wherever `exact` has made it."""

MOST_DIGITS = 3
"""Digits after the point of a number in a scenario, and of a time that comes of it."""


_FORM = re.compile(r"[0-9]+(\.[0-9]+)?")
_LONGEST = 100
"""Letters of a number: far more than any that is not too large."""


class Decimal(Fraction):
    """A fraction that is shown as people write it, like 2.5."""

    __slots__ = ()

    def __str__(self) -> str:
        return decimal_text(self)


def exact(number: Number) -> Number:
    """The number as an int where it is whole, else as a fraction that is shown as a decimal where it is one."""
    return int(number) if number.denominator == 1 else Decimal(number)


def decimal_text(number: Number) -> str:
    """The number as an integer, as a decimal where that is exact, else as a fraction `n/d`."""
    places = next((k for k in range(number.denominator.bit_length()) if 10**k % number.denominator == 0), None)
    if places is None:
        return f"{number.numerator}/{number.denominator}"
    if places == 0:
        return str(number.numerator)
    digits = str(abs(number.numerator) * 10**places // number.denominator).rjust(places + 1, "0")
    return f"{'-' if number < 0 else ''}{digits[:-places]}.{digits[-places:]}"


def time_text(at: Number) -> str:
    """A time in units, with at most three decimals."""
    return f"{float(at):.3f}".rstrip("0").rstrip(".")


def tenths_above(number: Number) -> Number:
    """An upper bound for people, rounded up to tenths: less is not guaranteed."""
    return exact(Fraction(ceil(number * 10), 10))


def at_most(number: Number) -> str:
    """The same as a text."""
    return decimal_text(tenths_above(number))


def tenths_below(number: Number) -> Number:
    """A lower bound for people, rounded down to tenths."""
    return exact(Fraction(floor(number * 10), 10))


def at_least(number: Number) -> str:
    """The same as a text."""
    return decimal_text(tenths_below(number))


def read_number(text: str) -> Optional[Number]:
    """The number that digits say, perhaps with a point between them; None where the text says none, or is endless."""
    return exact(Fraction(text)) if len(text) <= _LONGEST and _FORM.fullmatch(text) else None


def rounded_text(value: float, digits: int) -> str:
    """A number without an exponent, with so many digits after the point at most, and no needless zeros."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def whole_below(number: Number, least: int) -> range:
    """The whole numbers below a number, down to the least one."""
    return range(ceil(number) - 1, least - 1, -1)


def whole_above(number: Number, most: Number) -> range:
    """The whole numbers above a number, up to the largest one."""
    return range(floor(number) + 1, floor(most) + 1)


def is_fine(number: Number) -> bool:
    """True for a number with at most MOST_DIGITS digits after the point."""
    return bool(10**MOST_DIGITS % number.denominator == 0)


Window = Tuple[Number, Number]
"""Something ends later than the first time and at the second one at the latest (time units from its start)."""


def window_of(low: Number, high: Optional[Number]) -> Window:
    """The window of something for which the author wrote one number or two: one alone leaves one time unit."""
    return exact(low), exact(low + 1 if high is None else high)
