"""Times as people write them: `2 min`, `8 h`, `30 s`, in a scenario that says what one unit of time is."""

from __future__ import annotations

from fractions import Fraction
from typing import ClassVar, List, Optional

from pursue_gen.diagnostics import units
from pursue_gen.language.measures import Measured, Units
from pursue_gen.language.numbers import Number, decimal_text, exact, time_text

SECONDS = {"s": 1, "min": 60, "h": 3600}
"""Seconds of each unit that may stand behind a number; the smallest first."""

_OTHERS = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "mins": "min", "minute": "min", "minutes": "min",
    "hr": "h", "hrs": "h", "hour": "h", "hours": "h",
}  # fmt: skip
"""Other words for them, which the reader answers with what to write."""

_NAMES = {Fraction(1): "seconds", Fraction(60): "minutes", Fraction(3600): "hours"}
_SMALLEST = 2
"""So many of a unit are told in it: from 2 min on, 127 s are 2 min 7 s."""


def duration_text(seconds: Number) -> str:
    """So many seconds as one writes them: `90 s`, `2 min 7 s`, `8 h`."""
    left = Fraction(seconds)
    found: List[str] = []
    for unit, size in (("h", SECONDS["h"]), ("min", SECONDS["min"])):
        whole = left // size
        if whole and (found or left % size == 0 or whole >= _SMALLEST):
            found.append(f"{whole} {unit}")
            left -= whole * size
    if left or not found:
        found.append(f"{decimal_text(exact(left))} s")
    return " ".join(found)


TIMES = Units("a time", SECONDS, _OTHERS, duration_text, "30 s, 2 min, 1 h 30 min")
"""What may stand behind a time."""


class Time(Measured):
    """A number of time units in a scenario that says how long one is. `unit`: the seconds of a time unit."""

    __slots__ = ()
    units: ClassVar[Units] = TIMES


def has_unit(text: str) -> bool:
    """True for a number with a unit behind it."""
    return " " in text or "\t" in text


def words_for(number: Number, unit: Optional[Number]) -> str:
    """A number of time units for people: `120 s`, `2 min 7 s`, `120 time units` where `unit` (seconds) is None."""
    if unit is None:
        return f"{decimal_text(number)} time unit{'' if number == 1 else 's'}"
    return duration_text(exact(Fraction(number) * unit))


def unit_name(unit: Optional[Number]) -> str:
    """What numbers of time units count, in the plural: `seconds`, `units of 10 s`; `time units` where `unit` (seconds)
    is None."""
    if unit is None:
        return "time units"
    return _NAMES.get(Fraction(unit)) or f"units of {duration_text(unit)}"


def in_unit(amount: str, unit: Optional[Number]) -> str:
    """So many of them: `5 units`, `1 second`, `5 units of 10 s`."""
    name = "units" if unit is None else unit_name(unit)
    first, *more = name.split(" ")
    return " ".join((amount, first[:-1] if amount == "1" else first, *more))


def time_units(number: Number) -> str:
    """A time of a scenario in a sentence: `2 min`, or `120 time units`."""
    return number.in_words if isinstance(number, Time) else words_for(number, None)


def moment(at: Number, unit: Optional[Number]) -> str:
    """A moment with at most three decimals, in time units, with the sign of the unit (`61.5 s`) where it has one."""
    sign = next((sign for sign, size in SECONDS.items() if unit is not None and size == unit), "")
    return f"{time_text(at)} {sign}".rstrip()


def units_of_time(number: object) -> str:
    """A time in a sentence: `2 min`, or `120 units of time`."""
    return number.in_words if isinstance(number, Time) else f"{units(number)} of time"


def written_time(number: object) -> str:
    """A time, or a length, as it is written."""
    return number.written if isinstance(number, Measured) else str(number)


def like(number: Number, other: object) -> Number:
    """A number as one would write it where `other` stands, which counts the same."""
    if not isinstance(other, Measured):
        return number
    return type(other)(number, other.unit, other.told(number) if other.has_unit else decimal_text(number))


def instead(new: Number, old: object) -> str:
    """`3 min instead of 2 min`."""
    return f"{written_time(like(new, old))} instead of {written_time(old)}"


def in_units(number: Number, unit: Optional[Number]) -> Number:
    """A number of time units that is written with its unit, where the scenario says what that is (`unit`: seconds)."""
    return number if unit is None else Time(number, unit, words_for(number, unit))


def window_text(low: object, high: Optional[object]) -> str:
    """`5 s to 8 s`; `high` None: the first time alone."""
    return written_time(low) if high is None else f"{written_time(low)} to {written_time(high)}"
