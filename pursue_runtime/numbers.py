"""Numbers in texts, exactly, with as many digits as 64 bits hold."""

from __future__ import annotations

import re
from fractions import Fraction

DIGITS = 18
"""The most digits of a whole number; it fits 64 bits."""

_SHOWN = 40

_WHOLE = re.compile(rf"[-+]?[0-9]{{1,{DIGITS}}}")
_OVER = rf"/0*[1-9][0-9]{{0,{DIGITS}}}"
_POINT = rf"(?:\.[0-9]{{1,{DIGITS}}})?(?:e[-+]?[0-9]{{1,2}})?"
_EXACT = re.compile(rf"{_WHOLE.pattern}(?:{_OVER}|{_POINT})")


def whole(text: str) -> int:
    """The whole number in a text of decimal digits. Raises ValueError where it is none, or has too many digits."""
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"{quoted(text)} is not a whole number of at most {DIGITS} digits")
    return int(text)


def exact(value: object) -> Fraction:
    """The number in a text such as `7`, `0.1` or `1/20`, or a number, as a fraction. Raises ValueError otherwise."""
    text = str(value)
    if isinstance(value, bool) or not _EXACT.fullmatch(text):
        raise ValueError(f"{quoted(text)} is not a number such as 0.1 or 1/20")
    return Fraction(text)


def quoted(text: str) -> str:
    """The text in quotes as a message can hold it: cut where it is long."""
    return repr(text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "...")
