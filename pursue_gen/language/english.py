"""Numbers and lists as English has them."""

from __future__ import annotations

from typing import Iterable


def units(amount: object) -> str:
    """`1 unit`, `2 units`, of a number of them or its text."""
    return f"{amount} unit{'' if str(amount) == '1' else 's'}"


def listed(names: Iterable[str]) -> str:
    """`a`, `a and b`, `a, b and c`."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last
