"""What a strategy may rely on that agents do at most, at least or never."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Union

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.conditions import Condition
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref


@dataclass(frozen=True)
class AtMost:
    """`assume: agent does event at_most times times`: it begins the event no more often."""

    agent: Ref
    event: Ref
    times: int
    span: Span = NOWHERE


@dataclass(frozen=True)
class Waits:
    """`assume: agent waits time between event`: so many time units from the end of one to the beginning of the next."""

    agent: Ref
    event: Ref
    time: Number
    span: Span = NOWHERE


@dataclass(frozen=True)
class Leaves:
    """`assume: agent leaves place within time`: so many time units after it came (or the start) it has set off."""

    agent: Ref
    place: Ref
    time: Number
    span: Span = NOWHERE


@dataclass(frozen=True)
class NeverAt:
    """`assume: agent never at place`: it does not set off to that place."""

    agent: Ref
    place: Ref
    span: Span = NOWHERE


@dataclass(frozen=True)
class NeverHolds:
    """`assume: not (condition)`: nobody makes it hold, nor sets off where it could hold on arrival.

    It is about agents that are not controlled alone.
    """

    condition: Condition
    span: Span = NOWHERE


AboutOne = Union[AtMost, Waits, Leaves, NeverAt]
"""An assumption about one agent."""

Assumption = Union[AtMost, Waits, Leaves, NeverAt, NeverHolds]
"""What agents that are not controlled are assumed to do, or not to do."""
