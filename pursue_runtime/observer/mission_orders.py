"""A mission that takes what people order, where all is proven to be kept with it. Times are seconds of ROS time."""

from __future__ import annotations

from typing import Callable, List, Mapping, Optional, Tuple

from pursue_runtime.model import Move
from pursue_runtime.observer.mission_status import MissionStatus
from pursue_runtime.observer.ordering import (
    ATTEMPTS,
    PATIENCE,
    WINDOW,
    Effect,
    OrderAnswer,
    PersonOrder,
    Refused,
    called,
    effect,
    read_order,
)
from pursue_runtime.observer.planning import Ordered, PlanRequest, Proposal, covers
from pursue_runtime.sentences import as_sentence, in_words
from pursue_runtime.state import LIVE, RUNNING, SystemState
from pursue_runtime.zones import INFINITY

BUSY = "what is under way changes faster than plans are found; order it again later"
"""Why an order is refused that no plan came for in time."""

NOTHING: Mapping[str, float] = {}


class MissionOrders(MissionStatus):
    """Looks at one order after the other: a plan is requested from the state behind it, and the order is taken together
    with that plan, or refused. Until then the plan in force goes on, and nothing of the order is in the state."""

    def on_order(self, text: str, now: float) -> List[SystemState]:
        """Take what a person orders, such as `tea within 5 min`."""
        try:
            order = read_order(text, now, self._unit)
            if self.status != RUNNING:
                why = f": {self.reason}" if self.reason else ""
                raise Refused(f"the mission is {self.status}{why}; order it again when it runs")
            if self.ending.says:
                raise Refused(self.ending.says)
            effect(self.model, self.position(now), order)
            self.ordering.add(order)
        except Refused as refusal:
            self._say(self.ordering.say, called(text), str(refusal))
            return []
        self._log("info", f"ordered: {order.text}")
        return self._status_changes(now)

    def _refuse(self, order: PersonOrder, why: str, possible: float = 0.0) -> None:
        """Refuse the order that is looked at."""
        self._say(self.ordering.answer, order.text, why, possible)

    def _say(self, say: Callable[[OrderAnswer], None], text: str, why: str, possible: float = 0.0) -> None:
        answer = OrderAnswer(text, False, possible=possible, why=as_sentence(why))
        say(answer)
        self._log("info", f"the order {text} is refused: {in_words(answer.why)}")

    # A plan with the order --------------------------------------------------------------------------------------------

    def _look_at_orders(self, now: float) -> bool:
        """Request a plan with the order that came first; False where none waits."""
        while self.ordering.first is not None:
            order = self.ordering.first
            try:
                self._request_with(order, effect(self.model, self.position(now), order), now)
                return True
            except Refused as refusal:
                self._refuse(order, str(refusal))
                self._planning.reset()
        return False

    def _request_with(self, order: PersonOrder, done: Effect, now: float) -> None:
        """Request a plan from the state behind the order, unless there is a request. Raises Refused after too many."""
        passed = (now - order.came) / self._unit
        if done.deadline is not None and passed >= done.deadline:
            raise Refused("its time was over before a plan was found")
        ends = [delay for name, delay in self._bounds(self.position(now)) if name not in self.late | set(self.lost)]
        if self.ways.turns:
            raise Refused("a robot that cannot go on is about to turn round; order it again then")
        ahead = max(self._planning.lead_time, self.ordering.lead_time) / self._unit
        if min(ends, default=INFINITY) < ahead:
            if now > order.came + PATIENCE:
                raise Refused(BUSY)
            self._planning.reset()
            return  # something ends before a plan can come: then the order is looked at again
        ordered = Ordered(order.event, order.came, done.clocks, WINDOW / self._unit)
        excused = frozenset(self.late | set(self.lost))
        place = self.counts["taken"], order.came
        before = self._planning.request
        self._planning.request_plan(
            place, done.after(self.position(now), passed), now, ahead, excused, {}, self.ways, ordered
        )  # fmt: skip
        request = self._planning.request
        self.ordering.attempts += request is not None and request is not before
        if self._planning.no_plan_reason or self.ordering.attempts > ATTEMPTS:
            raise Refused(BUSY)

    def on_no_plan(self, number: int, why: str, now: float) -> List[SystemState]:
        """Take that there is no plan for the request of this number: an order is refused, or as in MissionStatus."""
        return self.on_refused(number, why, 0.0, now)

    def on_refused(self, number: int, why: str, more: float, now: float) -> List[SystemState]:
        """The same; `more`: so many time units later than it is wanted the order could be promised, 0: that is not
        known."""
        request, order = self._planning.request, self.ordering.first
        if request is None or request.number != number or request.order is None or order is None:
            return super().on_no_plan(number, why, now)
        self._planning.reset()
        self._refuse(order, why, (order.within or 0.0) + more if more else 0.0)
        return self._status_changes(now)

    # Taking it --------------------------------------------------------------------------------------------------------

    def order_begins(self) -> Optional[float]:
        """Return when an acknowledged plan with an order may come into force; None: there is none."""
        proposal = self._planning.acknowledged()
        return None if proposal is None or proposal.request.order is None else _begin(proposal.request, self._unit)

    def _put_plan_in_force(self, now: float) -> List[SystemState]:
        proposal, order = self._planning.acknowledged(), self.ordering.first
        if proposal is None or proposal.request.order is None or self.status not in LIVE:
            return super()._put_plan_in_force(now)
        begin = _begin(proposal.request, self._unit)
        if now < begin - 1e-9:
            return []  # it is proven from then on
        ordered = proposal.request.order
        if order is None or (order.event, order.came) != (ordered.event, ordered.came) or self.status != RUNNING:
            self._planning.reset()
            return self._status_changes(now)
        try:
            done = effect(self.model, self.position(now), order)
        except Refused as refusal:
            self._planning.reset()
            self._refuse(order, str(refusal))
            return self._status_changes(now)
        position = done.after(self.position(now), (now - order.came) / self._unit)
        asked = proposal.request
        if (position.locations, position.values) != (asked.locations, asked.values):
            self._planning.reset()  # an assumption was broken: it is proven for another state
            return self._status_changes(now)
        late = now > begin + ordered.window * self._unit + 1e-9
        if late or not covers(proposal.cover, position, self._tolerance):
            self._planning.expire(proposal, now)
            self.ordering.lead_time = self._planning.lead_time
            return self._status_changes(now)
        return self._accept(proposal, order, done, now)

    def _accept(self, proposal: Proposal, order: PersonOrder, done: Effect, now: float) -> List[SystemState]:
        """Take the order with its plan: both are in the next state."""
        self.in_force = proposal.data
        self.plan, self._cover = proposal.data["plan"], proposal.cover
        self._planning.put_in_force(proposal)
        by = 0.0 if done.deadline is None else order.came + done.deadline * self._unit
        self.ordering.answer(OrderAnswer(order.text, True, by))
        self._log("info", f"the order {order.text} is accepted, with plan {self.plan}")
        since = {clock: order.came - at * self._unit for clock, at in done.clocks.items()}
        states = self._take(done.moves, now, since=since)
        self.ending.on_order(done.clocks)
        self._since = {}  # nothing that was decided with the plan before stands
        return states

    def _conclude(self, trigger: str, reason: str, now: float) -> None:
        super()._conclude(trigger, reason, now)
        for order in tuple(self.ordering.waiting):
            self._refuse(order, f"the mission is {self.status}")

    def _take(
        self, moves: Optional[Tuple[Move, ...]], now: float, why: str = "", commanded: bool = False,
        since: Mapping[str, float] = NOTHING,
    ) -> List[SystemState]:
        """Apply the moves of one event."""
        raise NotImplementedError


def _begin(request: PlanRequest, unit: float) -> float:
    """When the proof of a plan begins."""
    return request.stamp + request.ahead * unit
