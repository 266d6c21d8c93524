"""Plans in the observer: what a plan covers, and the request, proposal and acknowledgement of a new one."""

from __future__ import annotations

from typing import AbstractSet, Any, Dict, FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Set, Tuple

from pursue_runtime.model import Position, Written
from pursue_runtime.observer.ways import Block, Ways, blocked_reason, check_avoids
from pursue_runtime.sentences import as_sentence, marked
from pursue_runtime.state import SystemState
from pursue_runtime.strategy import Cover, read_cover
from pursue_runtime.zones import EPSILON, INFINITY, Zone, holds, last_moment

MIN_LEAD_TIME = 1.0
"""Seconds between a request and the time for which its plan is computed: finding and distributing it takes time."""

MOST_LATE_PLANS = 5
"""Plans in a row that may arrive too late to be put in force."""

EXACT = 0.00001
"""Time units by which clocks may differ that are differences of the same two times, as numbers of ROS time have so many
digits. Not measured."""

UNKNOWN = 1000
"""More requests than a mission can have made without a trace of them in the journal."""


Spread = Mapping[str, Mapping[str, float]]
"""By how much more or less clocks of a foreseen state may be, in time units: for each the events on whose moments its
own depends, and by how much each of them may be sooner or later than expected. Clocks that are not named are exact."""


class Ordered(NamedTuple):
    """What a person has ordered, in the state of a request: the event, when it came (seconds), the clocks that it
    starts, with the values that they began with, for how many time units its plan may come into force once it has
    begun, and by what clocks of the state may differ, which is foreseen. `asked`: what was written, which is not in the
    state, as a planner is asked for it; None: the order is one of the scenario."""

    event: str
    came: float
    clocks: Dict[str, float]
    window: float
    spread: Spread
    asked: Optional[Mapping[str, Any]] = None


class PlanRequest(NamedTuple):
    """A request for a plan from this state; clocks are those at `stamp` (seconds), `ahead` is in time units. With an
    `order` the state is that of its begin: `ahead` time units after the stamp.

    The plan must not rely on the agents in `excused`, nor send anybody along the ways in `blocked`, or the agent alone
    that stands behind a way. The robots in `turning` turn round when it begins, and may be back at any time. Those in
    `awaited` are late; the plan relies on them for so many time units more, counted from `stamp`. `order`: the state is
    the one behind an order of a person, which is taken together with the plan. `written`: the orders that people have
    written, whose automata are in the state. Nothing is sent to the robots that are `out_of_service`.
    """

    number: int
    locations: Dict[str, str]
    values: Dict[str, int]
    clocks: Dict[str, float]
    stamp: float
    ahead: float
    excused: Tuple[str, ...]
    blocked: Tuple[Block, ...] = ()
    turning: Tuple[str, ...] = ()
    awaited: Optional[Mapping[str, float]] = None
    order: Optional[Ordered] = None
    out_of_service: Tuple[str, ...] = ()
    written: Tuple[Written, ...] = ()

    def data(self) -> Dict[str, Any]:
        """Return what a planner is asked, without the game."""
        own = ("number", "stamp", "order", "written")
        asked = {key: value for key, value in self._asdict().items() if key not in own}
        if self.written:
            asked["written"] = [{"says": each.says, "within": each.within} for each in self.written]
        if self.order is None:
            return asked
        ordered = {"window": self.order.window, "sooner": self.order.clocks, "spread": self.order.spread}
        return {**asked, "ahead": 0.0, **ordered, **({} if self.order.asked is None else {"asked": self.order.asked})}

    def begin(self, unit: float) -> float:
        """Return when the proof of its plan begins, in seconds; `unit`: those of a time unit."""
        return self.stamp + self.ahead * unit

    def is_of(self, position: Position, since: float) -> bool:
        """Return True where a mission is where the order's plan is proven from, so many time units after its begin."""
        if (position.locations, position.values) != (self.locations, self.values):
            return False
        off = {clock: position.clocks[clock] - value - since for clock, value in self.clocks.items()}
        spread = {} if self.order is None else self.order.spread
        exact = all(abs(value) <= EXACT for clock, value in off.items() if clock not in spread)
        pairs = ((one, other) for one in spread for other in ("", *spread))
        return exact and all(
            abs(off[one] - off.get(other, 0.0)) <= apart(spread[one], spread.get(other, {})) + EXACT
            for one, other in pairs
        )


def apart(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """Return by how much more or less the difference of two clocks may be: what both have in common cancels out."""
    return sum(value for key, value in (*one.items(), *other.items()) if (key in one) != (key in other))


class Proposal(NamedTuple):
    """A plan that is in force as soon as every controller has it: `data` is what goes to them."""

    data: Dict[str, Any]
    cover: Cover
    request: PlanRequest


class Planning:
    """The steps from one plan to the next: request, proposal, acknowledgement by all controllers, in force.

    `excused`: the agents on which the plan in force does not rely; `avoided`: the ways along which it sends nobody;
    `idle`: the robots to which it sends nothing; `not_assumed`: the variables of the assumptions on which it does not
    rely; `lead_time`: seconds from a request to the begin of its plan, more once a plan came too late, until one is in
    force; `no_plan_reason`: why there is no plan from here; `searched`: the seconds of real time that the planner has
    needed so far, 0 while they are within ~planning_limit; `written`: the orders that people have written.
    """

    def __init__(self, controllers: Iterable[str]) -> None:
        self.request: Optional[PlanRequest] = None
        self.proposal: Optional[Proposal] = None
        self.excused: FrozenSet[str] = frozenset()
        self.avoided: FrozenSet[Block] = frozenset()
        self.idle: FrozenSet[str] = frozenset()
        self.not_assumed: FrozenSet[str] = frozenset()
        self.no_plan_reason = ""
        self.searched = 0.0
        self.lead_time = MIN_LEAD_TIME
        self._controllers = tuple(controllers)
        self._unacknowledged: Set[str] = set()
        self._number = 0
        self._attempts = 0
        self._place: object = None
        self.written: Tuple[Written, ...] = ()

    def revision(self) -> Tuple[object, ...]:
        """Return a value that changes with each step of planning."""
        open_ones = self.request is None, self.proposal is None, len(self._unacknowledged)
        return (self._number, self.no_plan_reason, self.searched, *open_ones)

    def unexcused(self, lost: Mapping[str, str]) -> str:
        """Return which lost agents the plan in force relies on, and why they are lost; "" if there are none."""
        return " and ".join(f"{marked(name)} {lost[name]}" for name in sorted(set(lost) - self.excused))

    def unavoided(self, blocked: AbstractSet[Block]) -> str:
        """Return that blocked ways are such as the plan in force may use; "" if there are none."""
        return blocked_reason(blocked, self.avoided)

    def commanding(self, out: AbstractSet[str]) -> str:
        """Return to which of the robots out of service the plan in force may send something; "": to none."""
        return " and ".join(f"{marked(name)} is out of service" for name in sorted(out - self.idle))

    def request_plan(
        self,
        place: object,
        position: Position,
        stamp: float,
        ahead: float,
        excused: FrozenSet[str],
        awaited: Mapping[str, float],
        ways: Ways,
        order: Optional[Ordered] = None,
        out: FrozenSet[str] = frozenset(),
    ) -> None:
        """Request a plan from this position, unless there is a request, a proposal or a failure for this `place`."""
        place = place, excused, sorted(awaited), ways.revision(), out, None if order is None else order.came
        if place != self._place:
            known = self.lead_time
            self.reset()
            self._place, self.lead_time = place, known
        elif self.request or self.proposal or self.no_plan_reason:
            return
        if self._attempts == MOST_LATE_PLANS:
            self.no_plan_reason = f"{MOST_LATE_PLANS} plans came too late to begin"
            return
        self._attempts += 1
        self._number += 1
        self.searched = 0.0
        what = position.locations, position.values, position.clocks, stamp, ahead
        gone = tuple(sorted(excused))
        asked = PlanRequest(self._number, *what, gone, *ways.revision(), awaited or None, order, written=self.written)
        self.request = asked._replace(out_of_service=tuple(sorted(out)))

    def adopt(self, absent: AbstractSet[str]) -> None:
        """Start anew from a state in which these agents are late or lost: others that were excused may be back."""
        self.reset()
        self.renumber()
        self.excused &= absent

    def renumber(self) -> None:
        """Give requests new numbers from here on: a controller may have a plan with the next one, of a request that was
        lost."""
        self._number += UNKNOWN
        if self.request is not None:
            self.request = self.request._replace(number=self._number)

    def reset(self) -> None:
        """Drop the request and the proposal: no other plan is needed."""
        self.request = self.proposal = self._place = None
        self.no_plan_reason, self.searched, self._attempts, self.lead_time = "", 0.0, 0, MIN_LEAD_TIME

    def on_long_search(self, number: int, seconds: float) -> None:
        """Note that the planner has searched for so many seconds for the request of this number, and goes on."""
        if self.request is not None and number == self.request.number:
            self.searched = seconds

    def progress(self) -> str:
        """Return how the search for a plan is going, for the reason of the state."""
        if not self.searched:
            return "looking for another plan"
        return f"no other plan was found in {self.searched:g} s (~planning_limit), still looking"

    def on_plan(self, number: int, answer: Mapping[str, Any], unneeded: AbstractSet[str] = frozenset()) -> bool:
        """Make the planner's answer the proposal; return False if it was not requested. Controllers that are `unneeded`
        and have nothing to do in it need not acknowledge it. Raises DataError, KeyError."""
        if self.request is None or number != self.request.number:
            return False
        check_avoids(answer, self.request.blocked)
        data = {"format": 1, "plan": number, **{key: answer[key] for key in ("strategies", "people", "cover")}}
        if isinstance(answer.get("takes"), dict):
            begins = {"stamp": self.request.stamp, "ahead": self.request.ahead, "excused": list(self.request.excused)}
            data["takes"] = {**answer["takes"], **begins}
        if self.request.order is not None:
            data["order"] = self.request.order.event
        if self.request.out_of_service:
            data["out_of_service"] = list(self.request.out_of_service)
        if self.request.written or "adds" in answer:
            data["adds"] = answer["adds"]
            if self.request.order is not None and self.request.order.asked is not None:
                data["order"] = str(answer["adds"]["written"][-1]["event"])
        if self.request.awaited:
            data["awaited"] = sorted(self.request.awaited)
        self.proposal = Proposal(data, read_cover(answer["cover"]), self.request)
        self.request = None
        self._unacknowledged = set(self._controllers) - without_commands(answer, unneeded)
        return True

    def on_no_plan(self, number: int, why: str) -> Optional[PlanRequest]:
        """Note that there is no plan for the request of this number, and return that; None: it is not looked for."""
        request = self.request
        if request is None or number != request.number:
            return None
        self.request, self.no_plan_reason = None, as_sentence(why)
        return request

    def refuse(self, why: str) -> None:
        """Drop the proposal: it is of no use."""
        self.proposal, self.no_plan_reason = None, why

    def on_receipt(self, node: str, number: int) -> None:
        """Note that a controller has acknowledged a plan."""
        if self.proposal is not None and self.proposal.data["plan"] == number:
            self._unacknowledged.discard(node)

    def acknowledged(self) -> Optional[Proposal]:
        """Return the proposal once every controller has acknowledged it."""
        return None if self._unacknowledged else self.proposal

    def put_in_force(self, proposal: Proposal) -> None:
        """Note that the proposal is in force."""
        self.excused = frozenset(proposal.request.excused)
        self.avoided = frozenset(proposal.request.blocked)
        self.idle = frozenset(proposal.request.out_of_service)
        self.not_assumed = frozenset(name for name, value in proposal.request.values.items() if value == 0)
        self.reset()

    def expire(self, proposal: Proposal, now: float) -> None:
        """Drop a proposal that does not cover the present clocks; the next one gets a longer lead time."""
        self.lead_time = (now - proposal.request.stamp) * 1.3 + MIN_LEAD_TIME
        self.proposal = None


def without_commands(plan: Mapping[str, Any], nodes: AbstractSet[str]) -> Set[str]:
    """Return those of the controllers that have nothing to do in a plan."""
    known = {node: plan["strategies"].get(node) for node in nodes}
    return {node for node, own in known.items() if own is not None and not own["strategy"]}


# What a plan covers; `tolerance` is how far clocks may be off, in time units ------------------------------------------


def covers(cover: Cover, position: Position, tolerance: float) -> bool:
    """Return True if the plan has a decision at this position: each entry that applies has one."""
    applying = _zones(cover, position)
    return bool(applying) and all(any(holds(z, position.clocks, tolerance) for z in zones) for zones in applying)


def stays(cover: Optional[Cover], position: Position, tolerance: float) -> float:
    """Return the time units until the covered zones are left if only time passes; negative: they have been left."""
    if cover is None:
        return INFINITY
    moments = [last_moment(zones, position.clocks, tolerance) for zones in _zones(cover, position)]
    return min(moments, default=-INFINITY)


def is_uncovered(cover: Optional[Cover], position: Position, tolerance: float, patience: float) -> bool:
    """Return True if the plan has no decision here, and had none `patience` time units ago."""
    if cover is None or covers(cover, position, tolerance):
        return False
    return patience <= tolerance or stays(cover, position, tolerance) <= EPSILON - patience


def _zones(cover: Cover, position: Position) -> List[List[Zone]]:
    """Return the zones of each entry that applies; none where a part of the plan has no decision."""
    return cover.zones(SystemState(0, 0.0, *position))
