"""Plans as the observer sees them: what one covers; and planning again: what is asked for, what was
found, who has it. No ROS."""

from __future__ import annotations

from typing import Any, Dict, FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.model import Position
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import StateTable, read_cover
from pursue_runtime.zones import EPSILON, INFINITY, Zone, holds, last_moment

MIN_LEAD_TIME = 1.0
"""Seconds that a first plan is given to be there: it is made for the moment at which it can begin."""

ATTEMPTS = 5
"""So many plans in a row may come too late to begin."""

Cover = StateTable[Tuple[Zone, ...]]
"""The states and clocks in which a plan knows what to do."""


class PlanRequest(NamedTuple):
    """Asks for a plan that begins at this place; clocks are those of `stamp` (seconds), `ahead` is in time units.

    Nothing is to be expected of the agents that are `excused`.
    """

    number: int
    locations: Dict[str, str]
    values: Dict[str, int]
    clocks: Dict[str, float]
    stamp: float
    ahead: float
    excused: Tuple[str, ...]


class Proposal(NamedTuple):
    """A plan that is in force as soon as every controller has it: `data` is what goes to them."""

    data: Dict[str, Any]
    cover: Cover
    request: PlanRequest


class Planning:
    """The way from one plan to the next.

    `excused`: the agents that the plan in force expects nothing of; `hopeless`: why there is no plan for this place.
    """

    def __init__(self, controllers: Iterable[str]) -> None:
        self.request: Optional[PlanRequest] = None
        self.proposal: Optional[Proposal] = None
        self.excused: FrozenSet[str] = frozenset()
        self.no_plan_reason = ""
        self.lead_time = MIN_LEAD_TIME
        self._controllers = tuple(controllers)
        self._unacknowledged: Set[str] = set()
        self._number = 0
        self._attempts = 0
        self._place: object = None

    def revision(self) -> Tuple[object, ...]:
        """What a step of planning changes."""
        return self._number, self.request is None, self.proposal is None, self.no_plan_reason, len(self._unacknowledged)

    def unexcused(self, lost: Mapping[str, str]) -> str:
        """Who is lost but expected by the plan in force, and why; "" for nobody."""
        return " and ".join(f"{name} {lost[name]}" for name in sorted(set(lost) - self.excused))

    def request_plan(
        self, place: object, position: Position, stamp: float, excused: FrozenSet[str], ahead: float
    ) -> None:
        """A plan from this position is needed. `place` tells positions apart: nothing is asked for twice."""
        if place != self._place:
            self.reset()
            self._place = place
        elif self.request or self.proposal or self.no_plan_reason:
            return
        if self._attempts == ATTEMPTS:
            self.no_plan_reason = f"{ATTEMPTS} plans came too late to begin"
            return
        self._attempts += 1
        self._number += 1
        what = position.locations, position.values, position.clocks
        self.request = PlanRequest(self._number, *what, stamp, ahead, tuple(sorted(excused)))

    def reset(self) -> None:
        """No other plan is needed any more."""
        self.request = self.proposal = self._place = None
        self.no_plan_reason, self._attempts, self.lead_time = "", 0, MIN_LEAD_TIME

    def on_plan(self, number: int, answer: Mapping[str, Any]) -> bool:
        """A plan was found; False for an answer that nobody waits for. Raises DataError or KeyError on bad data."""
        if self.request is None or number != self.request.number:
            return False
        data = {"format": 1, "plan": number, **{key: answer[key] for key in ("strategies", "people", "cover")}}
        self.proposal = Proposal(data, read_cover(answer["cover"]), self.request)
        self.request = None
        self._unacknowledged = set(self._controllers)
        return True

    def on_no_plan(self, number: int, why: str) -> None:
        """There is no plan for what was asked under this number."""
        if self.request is not None and number == self.request.number:
            self.request, self.no_plan_reason = None, why

    def on_receipt(self, node: str, number: int) -> None:
        """A controller says that it has a plan."""
        if self.proposal is not None and self.proposal.data["plan"] == number:
            self._unacknowledged.discard(node)

    def acknowledged(self) -> Optional[Proposal]:
        """The plan that every controller has."""
        return None if self._unacknowledged else self.proposal

    def put_in_force(self, proposal: Proposal) -> None:
        """It is in force."""
        self.excused = frozenset(proposal.request.excused)
        self.reset()

    def expire(self, proposal: Proposal, now: float) -> None:
        """It does not fit the clocks of now: the next one is given more time to be there."""
        self.lead_time = (now - proposal.request.stamp) * 1.3 + MIN_LEAD_TIME
        self.proposal = None


# What a plan covers; `tolerance` is how far clocks may be off, in time units ------------------------------------------


def covers(cover: Cover, position: Position, tolerance: float) -> bool:
    """It knows what to do here and now."""
    return any(holds(zone, position.clocks, tolerance) for zone in _zones(cover, position))


def stays(cover: Optional[Cover], position: Position, tolerance: float) -> float:
    """The time units until time leaves what is covered; negative: it has."""
    return INFINITY if cover is None else last_moment(_zones(cover, position), position.clocks, tolerance)


def uncovered(cover: Optional[Cover], position: Position, tolerance: float, patience: float) -> str:
    """Why it does not know what to do; "" where it does, or where time left it less than `patience` (units) ago."""
    if cover is None or covers(cover, position, tolerance):
        return ""
    left = stays(cover, position, tolerance)
    if patience > tolerance and left > EPSILON - patience:
        return ""
    what = "at these clocks" if left > -INFINITY else "in this state"
    where = " ".join(f"{name}={value}" for name, value in _state(position).discrete().items())
    return f"no strategy {what}: {where}"


def _zones(cover: Cover, position: Position) -> List[Zone]:
    return [zone for zones in cover.find(_state(position)) for zone in zones]


def _state(position: Position) -> SystemState:
    return SystemState(0, 0.0, position.locations, position.values, position.clocks)
