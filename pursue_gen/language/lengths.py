"""Lengths as people write them: `12 m`, `80 cm`. They count metres."""

from __future__ import annotations

from fractions import Fraction
from typing import ClassVar

from pursue_gen.diagnostics import units
from pursue_gen.language.measures import Measured, Units
from pursue_gen.language.numbers import Number, decimal_text

_CENTIMETRE = Fraction(1, 100)
_OTHERS = {
    "metre": "m", "metres": "m", "meter": "m", "meters": "m",
    "centimetre": "cm", "centimetres": "cm", "centimeter": "cm", "centimeters": "cm",
}  # fmt: skip
"""Other words for the units, which the reader answers with what to write."""


def length_text(metres: Number) -> str:
    """So many metres as one writes them: `12 m`, `0.125 m`."""
    return f"{decimal_text(metres)} m"


LENGTHS = Units("a length", {"cm": _CENTIMETRE, "m": 1}, _OTHERS, length_text, "12 m, 80 cm")
"""What may stand behind a length."""


class Length(Measured):
    """A length with its unit behind it, in metres; one without is a plain number."""

    __slots__ = ()
    units: ClassVar[Units] = LENGTHS


def metres(number: Number) -> str:
    """A length in metres for people: `80 cm` as it was written, else `12 m`."""
    return number.written if isinstance(number, Length) else length_text(number)


def units_of_distance(number: Number, in_metres: bool) -> str:
    """A distance in a sentence: `12 m`, or `12 units of distance`."""
    return metres(number) if in_metres or isinstance(number, Length) else f"{units(number)} of distance"


def unit_of_distance(in_metres: bool) -> str:
    """What distances count, in the singular."""
    return "metre" if in_metres else "unit of distance"
