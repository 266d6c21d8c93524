"""What a scenario is to achieve: what always holds, and what is reached once."""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Optional, Tuple, Union

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.conditions import Condition, Not, Who
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref


@dataclass(frozen=True)
class Respond:
    """`if trigger then response within deadline` (time units): events, or conditions.

    A condition has to be answered when it comes to hold, and at the start where it holds; it answers as soon as it
    holds.
    """

    trigger: Union[Ref, Condition]
    response: Union[Ref, Condition]
    deadline: Number
    span: Span = NOWHERE
    optional: int = 0

    @property
    def conditions(self) -> Tuple[Condition, ...]:
        """Those of the two that are conditions."""
        return tuple(what for what in (self.trigger, self.response) if not isinstance(what, Ref))

    @property
    def events(self) -> Tuple[Ref, ...]:
        """Those of the two that are events."""
        return tuple(what for what in (self.trigger, self.response) if isinstance(what, Ref))


@dataclass(frozen=True)
class Avoid:
    """`avoid event`."""

    event: Ref
    span: Span = NOWHERE
    optional: int = 0


@dataclass(frozen=True)
class NeverWith:
    """`first never_with second`: two agents that never share a POI nor a connection; with `place` not this POI."""

    first: Ref
    second: Ref
    span: Span = NOWHERE
    place: Optional[Ref] = None
    optional: int = 0


@dataclass(frozen=True)
class Always:
    """`always condition`, or with `holds` False `avoid condition`: it holds at every moment, or at none."""

    condition: Condition
    holds: bool = True
    span: Span = NOWHERE
    optional: int = 0

    @property
    def broken_if(self) -> Condition:
        """The condition with which the objective is lost."""
        return Not(self.condition) if self.holds else self.condition


@dataclass(frozen=True)
class Patrol:
    """`patrol place every T by who`: it is at the place again so many time units after it left, or after the start.

    `who`: an agent, or any robot: then one of them. A statement with several places is several of these.
    `every`: in time units; None: the least that can be promised is to be found by solving (`solving.periods`). Then
    `least` says that nothing below it can be promised.
    `order`: the places of the statement, where each counts in its turn only (`in order`); () where all count always.
    """

    place: Ref
    every: Optional[Number]
    who: Who
    span: Span = NOWHERE
    order: Tuple[str, ...] = ()
    least: Optional[int] = None
    optional: int = 0

    @property
    def period(self) -> Number:
        """The time units from one visit to the next; they are known from solving on."""
        assert self.every is not None, "the period of a patrol has to be found first"
        return self.every


Safety = Union[Respond, Avoid, NeverWith, Always, Patrol]


@dataclass(frozen=True)
class Reach:
    """`do e1 and e2 after T within D`: each event happens, in any order, later than `after` and at most `within` time
    units from the start (None: without a deadline)."""

    events: Tuple[Ref, ...]
    after: Number = 0
    span: Span = NOWHERE
    within: Optional[Number] = None
    optional: int = 0


StatedObjective = Union[Safety, Reach]
"""An objective. `optional`: 0 for one that has to be met; else the number behind `optional`, 1 for what is to be kept
longest."""


class WhyGivenUp(enum.Enum):
    """Why an optional objective is not promised, in words that follow it."""

    IMPOSSIBLE = "cannot be promised together with the rest"
    TOO_MUCH_WORK = "was too much work to decide"
    REFUSED = (
        "is not decided: the independent checker refuses the strategy that was found for it (please report that, with "
        "the scenario)"
    )


@dataclass(frozen=True)
class GivenUp:
    """An optional objective that is not promised, and why."""

    objective: StatedObjective
    why: WhyGivenUp = WhyGivenUp.IMPOSSIBLE
