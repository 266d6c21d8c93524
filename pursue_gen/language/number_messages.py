"""What is wrong with a number, and what to write in its place."""

from __future__ import annotations

import re
from typing import Optional

from pursue_gen.diagnostics import Diagnostic, Span, error
from pursue_gen.language.numbers import MOST_DIGITS, Number
from pursue_gen.language.tokens import shown

_LARGEST_POWER = 6
"""The largest number has so many zeros."""


def no_number(text: str, value: Optional[Number], most: int, span: Span) -> Diagnostic:
    """A time, distance or speed that cannot be read, or is too large or too fine; `value` is what it says."""
    if value is None:
        return error("PML014", f"expected a number, found {shown(text)}", span, _instead(text))
    if value > most:
        return _too_large(text, most, span)
    message = f"{shown(text, 20)} has more than {MOST_DIGITS} digits after the point"
    return error("PML280", message, span, "round it, or choose a smaller unit")


def no_count(text: str, value: Optional[Number], most: int, span: Span) -> Diagnostic:
    """What cannot be a number of times, or a rank."""
    if value is not None and value > most:
        return _too_large(text, most, span)
    hint = "write digits only" if value is None else "write it without decimals"
    return error("PML014", f"expected a whole number, found {shown(text)}", span, hint)


def _too_large(text: str, most: int, span: Span) -> Diagnostic:
    message = f"{shown(text, 20)} is too large: {most} is the largest number"
    return error("PML014", message, span, "choose a larger unit")


def _instead(text: str) -> str:
    """What to write."""
    if re.fullmatch(r"[0-9]{1,9}\.", text):
        return f"write {text[:-1]}: a point stands between digits"
    if re.fullmatch(r"\.[0-9]{1,9}", text):
        return f"write 0{text}: a point stands between digits"
    power = re.fullmatch(r"([1-9])[eE]([0-9])", text)
    if power and int(power.group(2)) <= _LARGEST_POWER:
        return f"write {power.group(1)}{'0' * int(power.group(2))}: all digits of it"
    unit = re.fullmatch(r"([0-9]{1,9}(?:\.[0-9]{1,9})?)[^\W\d]+", text)
    if unit:
        return f"write {unit.group(1)}: a number stands alone, in the unit of your choice"
    return "write digits only, with a point before decimals: 3 or 2.5"
