"""Numbers with their unit behind them, as people write them: what times and lengths share, and lengths, which count
metres: `12 m`, `80 cm`."""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Any, Callable, ClassVar, Mapping, NamedTuple, Optional, Type, TypeVar

from pursue_gen.diagnostics import units
from pursue_gen.language.numbers import Decimal, Number, decimal_text, exact, read_number

_PART = re.compile(r"(\S+)\s+([a-z]+)")
_Self = TypeVar("_Self", bound="Measured")


class Units(NamedTuple):
    """What may stand behind numbers of one kind. `called`: the kind, in a sentence; `sizes`: each unit in the smallest
    one that is computed with, itself 1; `others`: other words → the unit to write; `text`: so many as one writes them;
    `examples`: some, for messages.
    """

    called: str
    sizes: Mapping[str, Number]
    others: Mapping[str, str]
    text: Callable[[Number], str]
    examples: str

    def knows(self, text: str) -> bool:
        """True for a number with one of these units behind it, or with another word for one."""
        words = [unit for _, unit in _PART.findall(text)]
        return bool(words) and all(unit in self.sizes or unit in self.others for unit in words)

    def read(self, text: str) -> Written:
        """What a number with a unit behind it says, or several of them, the largest first: `2 min 30 s`."""
        if not self.knows(text):
            return Written(None)
        parts = [(number, self.others.get(unit, unit), unit) for number, unit in _PART.findall(text)]
        numbers = [read_number(number) for number, _, _ in parts]
        if None in numbers:
            return Written(None)
        sizes = [self.sizes[unit] for _, unit, _ in parts]
        found = exact(sum((Fraction(number or 0) * size for number, size in zip(numbers, sizes)), Fraction()))
        if sizes != sorted(set(sizes), reverse=True):
            return Written(None, self.text(found))
        if any(unit != word for _, unit, word in parts):
            return Written(None, " ".join(f"{number} {unit}" for number, unit, _ in parts))
        return Written(found)

    def apart(self, text: str) -> Optional[str]:
        """What to write in place of a number to which its unit is glued, as in `2min`; None: it is something else."""
        found = re.fullmatch(rf"([0-9.]+)({'|'.join((*self.sizes, *self.others))})", text)
        return f"{found[1]} {self.others.get(found[2], found[2])}" if found and read_number(found[1]) else None


class Written(NamedTuple):
    """A number with its unit as it stands in a text: its value; or what to write in its place, None: nothing known."""

    value: Optional[Number]
    instead: Optional[str] = None


class Measured(Decimal):
    """A number in a scenario of which it is known what it counts. It is shown as any number; `written` is how its
    author wrote it, with a unit or without. `unit`: how many of the smallest unit that is computed with 1 is.

    What is computed from it is a plain number.
    """

    __slots__ = ("unit", "written")
    unit: Number
    written: str
    units: ClassVar[Units]
    """What may stand behind it."""

    def __new__(cls: Type[_Self], number: Number, unit: Number, written: str) -> _Self:
        made: Any = super().__new__(cls, number)
        made.unit, made.written = unit, written
        return made  # type: ignore[no-any-return]

    @property
    def has_unit(self) -> bool:
        """True where a unit stands behind it."""
        return " " in self.written

    @property
    def in_words(self) -> str:
        """It for people, always with its unit."""
        return self.written if self.has_unit else self.told(self)

    def told(self, number: Number) -> str:
        """Another number that counts the same, with its unit."""
        return self.units.text(exact(Fraction(number) * self.unit))

    @classmethod
    def from_float(cls, number: float) -> Fraction:  # type: ignore[override]
        """The fraction that a float is, as comparisons ask for it: nothing is known of what it counts."""
        return Fraction.from_float(number)

    def __reduce__(self) -> Any:
        return type(self), (exact(self), self.unit, self.written)

    def __copy__(self: _Self) -> _Self:
        return self

    def __deepcopy__(self: _Self, memo: Any) -> _Self:
        return self


# Lengths --------------------------------------------------------------------------------------------------------------

_OTHERS = {
    "metre": "m", "metres": "m", "meter": "m", "meters": "m",
    "centimetre": "cm", "centimetres": "cm", "centimeter": "cm", "centimeters": "cm",
}  # fmt: skip
"""Other words for the units, which the reader answers with what to write."""


def length_text(metres: Number) -> str:
    """So many metres as one writes them: `12 m`, `0.125 m`."""
    return f"{decimal_text(metres)} m"


LENGTHS = Units("a length", {"cm": Fraction(1, 100), "m": 1}, _OTHERS, length_text, "12 m, 80 cm")
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
