"""A mission that takes what people order, where all is proven to be kept with it. Times are seconds of ROS time."""

from __future__ import annotations

from typing import Any, Callable, FrozenSet, List, Mapping, Optional, Tuple

from pursue_runtime.data import DataError
from pursue_runtime.model import ORDER_DESK, Model, Move, Position
from pursue_runtime.observer.foresight import Foreseen, Foresight
from pursue_runtime.observer.mission_status import MissionStatus
from pursue_runtime.observer.ordering import (
    ATTEMPTS,
    CANCEL,
    FAR,
    JOIN,
    MOST_LEAD_TIME,
    PATIENCE,
    QUIET,
    WINDOW,
    Effect,
    OrderAnswer,
    PersonOrder,
    Refused,
    called,
    effect,
    meant,
    read_order,
)
from pursue_runtime.observer.planning import MIN_LEAD_TIME, Ordered, PlanRequest, Proposal, covers
from pursue_runtime.sentences import as_sentence, in_words
from pursue_runtime.state import LIVE, RUNNING, SystemState

NOT_IN_TIME = "no plan was found within {:.1f} s, and what is under way is not known for longer; order it again later"
"""Why an order is refused that no plan came for in time: how long a search could take."""

NOTHING: Mapping[str, float] = {}


class MissionOrders(MissionStatus):
    """Looks at one order after the other: a plan is requested from the state behind it, and the order is taken together
    with that plan, or refused. Until then the plan in force goes on, and nothing of the order is in the state."""

    def on_order(self, text: str, now: float) -> List[SystemState]:
        """Take what a person orders, such as `tea within 5 min`."""
        try:
            order = read_order(text, now, self._unit, self.model)
            if self.status != RUNNING:
                why = f": {self.reason}" if self.reason else ""
                raise Refused(f"the mission is {self.status}{why}; order it again when it runs")
            if self.ending.says:
                raise Refused(self.ending.says)
            if order.how == CANCEL and self._withdraw(order):
                return self._status_changes(now)
            order = meant(self.model, self.position(now), order)
            self._effect(self.position(now), order)
            self.ordering.add(order)
        except Refused as refusal:
            self._say(self.ordering.say, called(text), str(refusal))
            return []
        self._log("info", f"ordered: {order.text}")
        return self._status_changes(now)

    def _effect(self, position: Position, order: PersonOrder) -> Effect:
        """Return what an order does in this position. Raises Refused."""
        if not order.is_service:
            return effect(self.model, position, order)
        self.service.check(order, self.robots.displaced, self.silent)
        return Effect((), {}, None)

    def _withdraw(self, cancel: PersonOrder) -> bool:
        """Take back an order that waits for its answer; return False where none does."""
        order = self.ordering.withdraw(cancel)
        if order is None:
            return False
        self._say(self.ordering.say, order.text, "it was cancelled")
        self.ordering.say(OrderAnswer(cancel.text, True))
        return True

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
                order = self.ordering.waiting[0] = meant(self.model, self.position(now), order)
                self._request_with(order, self._effect(self.position(now), order), now)
                return True
            except Refused as refusal:
                self._refuse(order, str(refusal))
                self._planning.reset()
        return False

    def _request_with(self, order: PersonOrder, done: Effect, now: float) -> None:
        """Request a plan from the state behind the order, unless there is a request. Raises Refused after too many."""
        if self.ways.turns:
            raise Refused("a robot that cannot go on is about to turn round; order it again then")
        excused = frozenset(self.late | set(self.lost))
        asked = self._asked()
        if asked is not None and self._still_comes(asked, order, excused, now):
            return
        if done.deadline is not None and (now - order.came) / self._unit >= done.deadline:
            raise Refused("its time was over before a plan was found")
        if asked is not None and self._planning.request is not None and now > asked.begin(self._unit):
            self.ordering.lead_time = min(MOST_LEAD_TIME, (now - asked.stamp) * 1.3 + MIN_LEAD_TIME)  # it takes longer
        least = max(MIN_LEAD_TIME, self.ordering.lead_time) / self._unit
        foreseen = self._foresee(order, excused, now, least, least + FAR / self._unit)
        if foreseen is None:
            if now > order.came + PATIENCE:
                raise Refused(NOT_IN_TIME.format(least * self._unit))
            self._planning.reset()
            return  # something ends before a plan can come: then the order is looked at again
        after, ahead, spread = foreseen
        waited = (now - order.came) / self._unit + ahead
        says = None if order.event else {"says": order.says, "within": order.within, "waited": waited}
        ordered = Ordered(order.word, order.came, done.clocks, WINDOW / self._unit, spread, says)
        place = now + ahead * self._unit, order.text
        before = self._planning.request
        out = self.service.after(order)
        self._planning.request_plan(place, after, now, ahead, excused, {}, self.ways, ordered, out)
        request = self._planning.request
        self.ordering.attempts += request is not None and request is not before
        if self._planning.no_plan_reason or self.ordering.attempts > ATTEMPTS:
            raise Refused(self._planning.no_plan_reason or NOT_IN_TIME.format(least * self._unit))

    def _asked(self) -> Optional[PlanRequest]:
        """Return the request that is looked at, or whose plan goes to the controllers."""
        proposal = self._planning.proposal
        return self._planning.request or (None if proposal is None else proposal.request)

    def _still_comes(self, asked: PlanRequest, order: PersonOrder, excused: FrozenSet[str], now: float) -> bool:
        """Return True while the plan that is asked for can come into force."""
        mine = asked.order is not None and (asked.order.event, asked.order.came) == (order.word, order.came)
        gone, out = (tuple(sorted(names)) for names in (excused, self.service.after(order)))
        if not mine or (*asked[6:9], asked.out_of_service) != (gone, *self.ways.revision(), out):
            return False
        left = (asked.begin(self._unit) - now) / self._unit
        if left > 0.0:
            foreseen = self._foresee(order, excused, now, left, left)
            return foreseen is not None and asked.is_of(foreseen.position, 0.0)
        return left >= -WINDOW / self._unit and asked.is_of(self._behind(order, self.position(now), now), -left)

    def _foresee(
        self, order: PersonOrder, gone: FrozenSet[str], now: float, least: float, most: float
    ) -> Optional[Foreseen]:
        """Return the state behind the order that comes in so many time units; None: that is not known."""
        foresight = Foresight(self._automata, self._cover, gone)
        found = foresight.find(self.position(now), least, most, QUIET / self._unit)
        if found is None:
            return None
        try:
            return found._replace(position=self._behind(order, found.position, now + found.begins * self._unit))
        except Refused:
            return None

    def _behind(self, order: PersonOrder, position: Position, at: float) -> Position:
        """Return the position behind the order at that time. Raises Refused."""
        return self._effect(position, order).after(position, (at - order.came) / self._unit)

    def on_plan(self, number: int, answer: Mapping[str, Any], now: float) -> List[SystemState]:
        """Take the planner's answer, as in MissionStatus; one for what was written has what it adds to the model."""
        request = self._planning.request
        if request is not None and request.number == number and request.order is not None and request.order.asked:
            try:
                self.model.extended(answer["adds"])
            except (DataError, KeyError) as problem:
                return self.on_no_plan(number, f"the plan cannot be read: {problem}", now)
        return super().on_plan(number, answer, now)

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
        if order.how == JOIN:
            return self._join_anyway(order, now)
        why = f"no plan without it was found, so it goes on: {why}" if order.how == CANCEL else why
        self._refuse(order, why, (order.within or 0.0) + more if more else 0.0)
        return self._status_changes(now)

    # Taking it --------------------------------------------------------------------------------------------------------

    def order_begins(self) -> Optional[float]:
        """Return when an acknowledged plan with an order may come into force; None: there is none."""
        proposal = self._planning.acknowledged()
        return None if proposal is None or proposal.request.order is None else proposal.request.begin(self._unit)

    def _put_plan_in_force(self, now: float) -> List[SystemState]:
        proposal, order = self._planning.acknowledged(), self.ordering.first
        if proposal is None or proposal.request.order is None or self.status not in LIVE:
            return super()._put_plan_in_force(now)
        begin = proposal.request.begin(self._unit)
        if now < begin - 1e-9:
            return []  # it is proven from then on
        ordered = proposal.request.order
        if order is None or (order.word, order.came) != (ordered.event, ordered.came) or self.status != RUNNING:
            self._planning.reset()
            return self._status_changes(now)
        try:
            done = self._effect(self.position(now), order)
        except Refused as refusal:
            self._planning.reset()
            self._refuse(order, str(refusal))
            return self._status_changes(now)
        position = done.after(self.position(now), (now - order.came) / self._unit)
        if not proposal.request.is_of(position, (now - begin) / self._unit):
            self._planning.reset()  # it is proven for another state
            return self._status_changes(now)
        model = self.model
        if not order.event:
            model, order = self._with_written(proposal, order)
            here = model.completed(self.position(now))
            done = effect(model, here, order._replace(within=None))
            position = done.after(here, (now - order.came) / self._unit)
        late = now > begin + ordered.window * self._unit + 1e-9
        if late or not covers(proposal.cover, position, self._tolerance):
            self._planning.expire(proposal, now)
            self.ordering.lead_time = self._planning.lead_time
            return self._status_changes(now)
        if model is not self.model:
            self._extend(model, now)
        return self._accept(proposal, order, done, now)

    def _with_written(self, proposal: Proposal, order: PersonOrder) -> Tuple[Model, PersonOrder]:
        """Return the model with what was written, and the order with its event."""
        model = self.model.extended(proposal.data["adds"])
        return model, order._replace(event=model.written[-1].event)

    def _extend(self, model: Model, now: float) -> None:
        """Go on with a model that has what was written."""
        self.model = self.ending.model = self.ways.model = model
        self._automata.extend(model, now)
        self._planning.written = model.written

    def _accept(self, proposal: Proposal, order: PersonOrder, done: Effect, now: float) -> List[SystemState]:
        """Take the order with its plan: both are in the next state."""
        self.in_force = proposal.data
        self.plan, self._cover = proposal.data["plan"], proposal.cover
        self._planning.put_in_force(proposal)
        if order.is_service:
            return self._serve(order, now)
        by = 0.0 if done.deadline is None else order.came + done.deadline * self._unit
        self.ordering.answer(OrderAnswer(order.text, True, by))
        self._log("info", f"the order {order.text} is accepted, with plan {self.plan}")
        self.taken = {"event": order.word, "plan": self.plan, "since": {}}
        if order.how == CANCEL:
            return self._forget(order, done, now)
        since = {clock: order.came - at * self._unit for clock, at in done.clocks.items()}
        self.taken["since"] = since
        states = self._take(done.moves, now, since=since)
        self.ending.on_order(done.clocks)
        self._since = {}  # nothing that was decided with the plan before stands
        return states

    def _serve(self, order: PersonOrder, now: float) -> List[SystemState]:
        """Take a robot out of service, or bring it back: nothing else changes."""
        says = self.service.take(order, self.position(now))
        self.ordering.answer(OrderAnswer(order.text, True, why=says))
        self._log("info", in_words(says))
        self._new_state(now)
        self._event, self._agent = order.word, order.event
        self.counts["taken"] += 1
        moves = self._evaluate(now, "")
        return [self.state(now), *self._take(moves, now)]

    def _join_anyway(self, order: PersonOrder, now: float) -> List[SystemState]:
        """Bring a robot back under the plan in force, which sends it nothing, and keeps all promises."""
        try:
            self._effect(self.position(now), order)
        except Refused as refusal:
            self._refuse(order, str(refusal))
            return self._status_changes(now)
        return self._serve(order, now)

    def _forget(self, order: PersonOrder, done: Effect, now: float) -> List[SystemState]:
        """Let a promise fall away, in a state with the plan that does without it."""
        self.ending.on_cancel(done.moves)
        self._automata.turn(done.moves, now)
        self._new_state(now)
        self._event, self._agent = order.word, self.model.of_kind(ORDER_DESK)[0].name
        self.counts["taken"] += 1
        moves = self._evaluate(now, "")
        return [self.state(now), *self._take(moves, now)]

    def _conclude(self, trigger: str, reason: str, now: float) -> None:
        super()._conclude(trigger, reason, now)
        for order in tuple(self.ordering.waiting):
            self._refuse(order, f"the mission is {self.status}")

    def _evaluate(self, now: float, why: str) -> Optional[Tuple[Move, ...]]:
        """Return what objectives do next by themselves."""
        raise NotImplementedError

    def _take(
        self, moves: Optional[Tuple[Move, ...]], now: float, why: str = "", commanded: bool = False,
        since: Mapping[str, float] = NOTHING,
    ) -> List[SystemState]:
        """Apply the moves of one event."""
        raise NotImplementedError

