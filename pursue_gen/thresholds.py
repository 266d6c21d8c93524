"""The search for a threshold: the number from which on something holds, as larger numbers make it easier."""

from __future__ import annotations

from typing import Callable, Optional, Tuple


def narrowed(low: int, high: int, holds: Callable[[int], Optional[bool]], part: int = 0) -> Tuple[int, int]:
    """The numbers `low` and `high`, between which the threshold is, brought next to each other by halving.

    It does not hold at `low`, and it holds at `high`: neither is asked for. The search ends early where `holds` is None
    (not known), and, with `part`, where the two are apart by no more than that part of `high`: 12 for a twelfth.
    """
    while high - low > max(1, high // part if part else 1):
        middle = (low + high) // 2
        outcome = holds(middle)
        if outcome is None:
            break
        low, high = (low, middle) if outcome else (middle, high)
    return low, high


def from_below(first: int, holds: Callable[[int], bool], part: int = 0, most: Optional[int] = None) -> Optional[int]:
    """About the threshold, from above: tries `first`, then twice as much each time, then narrows that down.

    None where it does not hold at any of those up to `most`. It holds nowhere below 1. `part`: as for `narrowed`.
    """
    low, high = 0, first
    while not holds(high):
        low, high = high, 2 * high
        if most is not None and high > most:
            return None
    return narrowed(low, high, holds, part)[1]
