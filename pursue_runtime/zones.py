"""Zones of clocks, and when they are reached while only time passes.

Clocks, bounds and delays are in time units.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import Iterable, List, Mapping, NamedTuple, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.numbers import quoted

INFINITY = float("inf")

EPSILON = 1e-6
"""Two moments (in time units) that are closer than this are the same: clocks travel as decimals."""


class Constraint(NamedTuple):
    """`left - right <= bound`, or `<` where strict; left or right "" is the constant 0."""

    left: str
    right: str
    bound: float
    strict: bool

    def holds(self, clocks: Mapping[str, float], slack: float = 0.0) -> bool:
        """True where the clocks satisfy it, or miss it by no more than `slack`."""
        left, right = clocks[self.left] if self.left else 0.0, clocks[self.right] if self.right else 0.0
        excess = left - right - self.bound - slack
        return excess < 0.0 if self.strict and slack == 0.0 else excess <= EPSILON


Zone = Tuple[Constraint, ...]


_NUMBER = r"-?\d{1,18}(?:\.\d{1,18}|/0{0,17}[1-9]\d{0,17})?"
_SIDE = r"[A-Za-z_]\w*(?:\s*-\s*[A-Za-z_]\w*)?|" + _NUMBER
_COMPARISON = re.compile(rf"\s*({_SIDE})\s*(<=|<|>=|>|==)\s*({_SIDE})\s*", re.ASCII)


def parse_zone(text: str) -> Zone:
    """Reads comparisons joined by `&&`, or `always`. Raises DataError."""
    if text.strip() == "always":
        return ()
    constraints: List[Constraint] = []
    for part in text.split("&&"):
        match = _COMPARISON.fullmatch(part)
        if match is None:
            raise DataError(f"not a comparison of clocks: {quoted(part.strip())} in {quoted(text)}")
        first, operator, second = match.groups()
        (left, less, low), (right, minus, high) = _side(first), _side(second)
        if (left and right and (less or minus)) or not (left or right):
            raise DataError(f"too many clocks, or none: {quoted(part.strip())}")
        # left - less + low OP right - minus + high; what is subtracted on one side is added on the other
        plus, minus, bound = left or minus, less or right, high - low
        if operator in ("<", "<=", "=="):
            constraints.append(Constraint(plus, minus, bound, operator == "<"))
        if operator in (">", ">=", "=="):
            constraints.append(Constraint(minus, plus, -bound, operator == ">"))
    return tuple(constraints)


def _side(text: str) -> Tuple[str, str, float]:
    """One side of a comparison: clock, subtracted clock, number."""
    if re.fullmatch(_NUMBER, text):
        return "", "", float(Fraction(text)) if "/" in text else float(text)
    plus, _, minus = text.partition("-")
    return plus.strip(), minus.strip(), 0.0


def holds(zone: Zone, clocks: Mapping[str, float], slack: float = 0.0) -> bool:
    """True where the clocks are in the zone, or beside it by no more than `slack` in any bound."""
    return all(constraint.holds(clocks, slack) for constraint in zone)


def was_reached(zones: Iterable[Zone], clocks: Mapping[str, float], slack: float = 0.0) -> bool:
    """True if the clocks are in one of the zones, or have passed through it while only time passed.

    What they miss by no more than `slack` counts as reached: the clock of another machine may be ahead.
    """
    return any(all(c.holds(clocks, slack) for c in zone if c.right) for zone in zones)


def due(zones: Iterable[Zone], clocks: Mapping[str, float], margin: float = 0.02) -> Optional[float]:
    """The earliest delay (≥ 0) after which the clocks are in one of the zones, None: never while only time passes.

    Exact on bounds that belong to the zone; where a zone opens with a strict bound there is no first moment: then the
    delay is `margin` inside the zone, or half way through it where it is narrower than two margins.
    """
    delays = [delay for delay in (_due(zone, clocks, margin) for zone in zones) if delay is not None]
    return min(delays) if delays else None


def _due(zone: Zone, clocks: Mapping[str, float], margin: float) -> Optional[float]:
    earliest, opens_after = 0.0, False
    latest, closes_before = INFINITY, False
    for constraint in zone:
        left, right, bound, strict = constraint
        if left and right:  # time does not change a difference
            if not constraint.holds(clocks):
                return None
        elif right:  # -clock <= bound: from here on
            moment = -bound - clocks[right]
            if (moment, strict) > (earliest, opens_after):
                earliest, opens_after = moment, strict
        else:
            moment = bound - clocks[left]
            if (moment, not strict) < (latest, not closes_before):
                latest, closes_before = moment, strict
    if earliest > latest + EPSILON or ((opens_after or closes_before) and earliest >= latest):
        return None
    if opens_after:
        return earliest + min(margin, (latest - earliest) / 2)
    return max(0.0, min(earliest, latest))


def last_moment(zones: Iterable[Zone], clocks: Mapping[str, float], slack: float = 0.0) -> float:
    """The delay after which time has left the last of the zones; negative: it has left them so long ago.

    Minus infinity: no zone was or will be passed while only time passes.
    """
    return max((_last_moment(zone, clocks, slack) for zone in zones), default=-INFINITY)


def _last_moment(zone: Zone, clocks: Mapping[str, float], slack: float) -> float:
    first, last = -INFINITY, INFINITY
    for constraint in zone:
        left, right, bound, _ = constraint
        if left and right:
            if not constraint.holds(clocks, slack):
                return -INFINITY
        elif right:
            first = max(first, -bound - clocks[right])
        else:
            last = min(last, bound - clocks[left])
    return last if first <= last + 2 * slack + EPSILON else -INFINITY
