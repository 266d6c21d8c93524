"""What could be promised where an order of a person cannot be promised as soon as it is wanted."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Callable, Optional

from pursue_gen.tools.replanning.request import Request

_STEPS = 6
"""How often the time is halved in which an order could be promised: each step is a search. Not measured."""


def longer(request: Request, is_won: Callable[[Request], bool]) -> Optional[float]:
    """How many time units later than it is wanted an order could be promised, rounded up to tenths; None: not at all,
    as far as it is known. A search for a request with that order is asked, at most 7 times."""
    most = max(request.sooner.values())
    if not is_won(_later(request, most)):
        return None
    least = Fraction(0)
    for _ in range(_STEPS):
        if most - least <= max(Fraction(1), most / 50):
            break
        middle = (least + most) / 2
        if is_won(_later(request, middle)):
            most = middle
        else:
            least = middle
    return float(-(-most * 10 // 1) / 10)


def _later(request: Request, by: Fraction) -> Request:
    """The request with an order that may be answered later, but no later than the scenario promises."""
    clocks = dict(request.clocks)
    for name, ahead in request.sooner.items():
        if name in clocks:
            clocks[name] = max(Fraction(0), clocks[name] - min(ahead, by))
    return replace(request, clocks=clocks)
