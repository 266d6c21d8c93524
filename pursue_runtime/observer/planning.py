"""Plans as the observer sees them: what one covers; and planning again: what is asked for, what was
found, who has it. No ROS."""

from __future__ import annotations

from typing import Any, Dict, FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.model import Position
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import StateTable, read_cover
from pursue_runtime.zones import EPSILON, INFINITY, Zone, holds, last_moment

FIRST_AHEAD = 1.0
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
        self.wanted: Optional[PlanRequest] = None
        self.proposal: Optional[Proposal] = None
        self.excused: FrozenSet[str] = frozenset()
        self.hopeless = ""
        self.took = FIRST_AHEAD
        self._controllers = tuple(controllers)
        self._missing: Set[str] = set()
        self._number = 0
        self._attempts = 0
        self._place: object = None

    def mark(self) -> Tuple[object, ...]:
        """What a step of planning changes."""
        return self._number, self.wanted is None, self.proposal is None, self.hopeless, len(self._missing)

    def unexcused(self, lost: Mapping[str, str]) -> str:
        """Who is lost but expected by the plan in force, and why; "" for nobody."""
        return " and ".join(f"{name} {lost[name]}" for name in sorted(set(lost) - self.excused))

    def want(self, place: object, position: Position, stamp: float, excused: FrozenSet[str], ahead: float) -> None:
        """A plan from this position is needed. `place` tells positions apart: nothing is asked for twice."""
        if place != self._place:
            self.drop()
            self._place = place
        elif self.wanted or self.proposal or self.hopeless:
            return
        if self._attempts == ATTEMPTS:
            self.hopeless = f"{ATTEMPTS} plans came too late to begin"
            return
        self._attempts += 1
        self._number += 1
        what = position.locations, position.values, position.clocks
        self.wanted = PlanRequest(self._number, *what, stamp, ahead, tuple(sorted(excused)))

    def drop(self) -> None:
        """No other plan is needed any more."""
        self.wanted = self.proposal = self._place = None
        self.hopeless, self._attempts, self.took = "", 0, FIRST_AHEAD

    def found(self, number: int, answer: Mapping[str, Any]) -> bool:
        """A plan was found; False for an answer that nobody waits for. Raises DataError or KeyError on bad data."""
        if self.wanted is None or number != self.wanted.number:
            return False
        data = {"format": 1, "plan": number, **{key: answer[key] for key in ("strategies", "people", "cover")}}
        self.proposal = Proposal(data, read_cover(answer["cover"]), self.wanted)
        self.wanted = None
        self._missing = set(self._controllers)
        return True

    def not_found(self, number: int, why: str) -> None:
        """There is no plan for what was asked under this number."""
        if self.wanted is not None and number == self.wanted.number:
            self.wanted, self.hopeless = None, why

    def has(self, node: str, number: int) -> None:
        """A controller says that it has a plan."""
        if self.proposal is not None and self.proposal.data["plan"] == number:
            self._missing.discard(node)

    def ready(self) -> Optional[Proposal]:
        """The plan that every controller has."""
        return None if self._missing else self.proposal

    def begin(self, proposal: Proposal) -> None:
        """It is in force."""
        self.excused = frozenset(proposal.request.excused)
        self.drop()

    def miss(self, proposal: Proposal, now: float) -> None:
        """It does not fit the clocks of now: the next one is given more time to be there."""
        self.took = (now - proposal.request.stamp) * 1.3 + FIRST_AHEAD
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
