"""The simulated world: robots, people and other agents end what they do, early and late in the model's window alike.

The run time's simulator reports the ends, one simulator for each agent; here is drawn when they end, and what fails.
"""

from __future__ import annotations

import random
from typing import Callable, Dict, Optional, Sequence

from pursue_gen.tools.simulation.connections import drawn_share
from pursue_gen.tools.simulation.event_queue import EventQueue, Timer
from pursue_gen.tools.simulation.faults import Breakdown, FaultPlan
from pursue_gen.tools.simulation.stage import Stage
from pursue_runtime.event_words import FAILED, ORDERED, RobotReport, Word, format_word
from pursue_runtime.locations import action_of, is_action, is_movement, is_under_way
from pursue_runtime.orders import Order, parse_orders
from pursue_runtime.resend import RepeatedReport, resend_timeout
from pursue_runtime.simulator.simulator import EndWindow, Simulator, end_window, picked, report_of
from pursue_runtime.state import SystemState

INSIDE = 1e-3
"""Time units by which the earliest end is inside its window, which opens with a strict bound."""


class FaultyDurations:
    """How long each activity of an agent takes; in the place of the simulator's `Delays`."""

    def __init__(self, fault_plan: FaultPlan, seed: str, reserve: float) -> None:
        """`reserve`: time units by which a usual end is before the end of its window, so that a report that is lost
        can be published again in time."""
        self._fault_plan, self._seed, self._reserve = fault_plan, seed, reserve

    def draw(self, window: EndWindow, agent: str, number: int) -> float:
        """Time units from the start of the agent's `number`-th activity to its end: each end of the window with
        probability 1/4."""
        part = drawn_share(random.Random(f"{self._seed}/{agent}/{number}"))
        inside = min(INSIDE, (window.high - window.low) / 2)
        width = max(0.0, window.high - window.low - inside - self._reserve)
        usual = window.low + inside + part * width
        return self._fault_plan.duration(window.low, window.high, usual)

    def pick(self, words: Sequence[str], agent: str, number: int) -> str:
        """With which of these words it ends."""
        return picked(words, f"{self._seed}/{agent}/{number}")


class SimulatedAgent:
    """An agent that moves and acts. `publish` takes its reports."""

    def __init__(self, stage: Stage, agent: str, events: EventQueue, fault_plan: FaultPlan, seed: str,
                 publish: Callable[[str, str], None], promised: float) -> None:
        """`promised`: the strategy has it that an order comes so many seconds after its state at the latest."""
        self.agent = agent
        self._stage = stage
        self._events, self._fault_plan, self._publish, self._promised = events, fault_plan, publish, promised
        reserve = promised if "loss" in fault_plan.kinds else 0.0
        self._simulator = Simulator(stage.model, [agent], FaultyDurations(fault_plan, seed, reserve))
        self._timer = Timer(events, self._on_timer)
        self._breakdown = fault_plan.breakdown if fault_plan.breakdown and fault_plan.breakdown.robot == agent else None
        self._place = ""
        self._since = self._begun = 0
        """The numbers of the states in which it came to its place, and came to what it was ordered to do last."""
        self._activities = 0
        self._broken = False
        self._failed = -1  # the number of the state in which it came to what it has failed to finish
        self._report: Optional[RepeatedReport] = None  # that it has failed, or could finish that after all
        self._report_timer = Timer(events, self._say)
        self._stamp = 0.0
        self._receipts: Dict[int, int] = {}  # the orders that no state shows as acknowledged: how often each was said
        self._receipt_timer = Timer(events, self._acknowledge)

    def on_state(self, state: SystemState) -> None:
        """A state of the mission: it is what the world is like, for robots move by orders only."""
        place = state.locations.get(self.agent, "")
        if place != self._place:
            self._place, self._since, self._stamp = place, state.seq, state.stamp
        self._simulator.on_state(state, self._events.now)
        self._set_timer()

    def on_orders(self, state: SystemState) -> None:
        """A state, also one that was published again: which orders and reports it shows."""
        if self._report is not None:
            shown = self.agent in (state.lost if FAILED in self._report.word else state.finished)
            self._report.confirmed |= shown or state.locations.get(self.agent) != self._place
        if self._receipts:
            waiting = {order.seq for order in parse_orders(state.orders) if order.agent == self.agent}
            waiting -= {order.seq for order in parse_orders(state.orders) if order.acknowledged}
            self._receipts = {seq: sends for seq, sends in self._receipts.items() if seq in waiting}

    def _acknowledge(self) -> None:
        """Say which orders have come; again until a state shows it: on robots the order is sent again, and answered."""
        for seq, sends in list(self._receipts.items()):
            self._receipts[seq] = sends + 1
            self._publish(self.agent, format_word(Word(self.agent, ORDERED, seq)))
        if self._receipts and self._fault_plan.kinds:
            sends = max(self._receipts.values())
            self._receipt_timer.set(self._events.now + resend_timeout(sends, self._promised))

    def on_order(self, order: Order, seq: int) -> None:
        """A goal or an action for a robot, as of state `seq`. One that comes as promised lets it end anywhere in the
        model's window; one for something that is over, or is done at once, begins nothing."""
        if order.at_once or not is_movement(order.location):
            self._receipts[order.seq] = 0
            self._acknowledge()
        if order.at_once or order.location != self._place or seq < self._since or not is_under_way(self._place):
            return
        if self._begun == self._since:
            return  # given again by a controller that was started again
        now = self._events.now
        in_time = now <= self._stamp + self._promised + 1e-6
        action = action_of(self._place) if is_action(self._place) else ""
        self._simulator.on_order(self.agent, self._stamp if in_time else now, action)
        if self._begun < self._since:
            self._begun = self._since
            self._activities += 1
            self._may_break()
        self._set_timer()

    def _on_timer(self) -> None:
        now = self._events.now
        for word in self._simulator.due(now, now):
            if not self._broken and self._since != self._failed:
                self._publish(self.agent, word)
        self._set_timer()

    def say_again(self) -> None:
        """An observer has connected: what no state has shown is reported again."""
        self._simulator.say_again()
        self._on_timer()
        if self._report is not None:
            self._report.say_again()
            self._say()

    def _set_timer(self) -> None:
        self._timer.set(*self._simulator.next_moments())

    def _may_break(self) -> None:
        breakdown, window = self._breakdown, self._window()
        if breakdown is not None and breakdown.number == self._activities and window is not None:
            self._breakdown, begun = None, self._begun
            moment = self._events.now + window.low * breakdown.share
            self._events.schedule(moment, lambda: self._break(breakdown, begun))

    def _break(self, breakdown: Breakdown, begun: int) -> None:
        if self._since != begun:
            return  # it was done sooner
        self._broken, self._failed = True, begun
        self._fault_plan.count("failed" if breakdown.reported else "silent")
        if breakdown.reported:
            self._report = RepeatedReport(RobotReport(self.agent, FAILED, as_of=begun), self._promised)
            self._say()
        if breakdown.back is not None:
            self._events.schedule(self._events.now + breakdown.back, lambda: self._repair(begun))

    def _repair(self, begun: int) -> None:
        """It can go on: what it was at when it broke ends now, if that is still to end."""
        self._broken = False
        window = self._window()
        if window is not None and self._since == begun:
            self._report = RepeatedReport(report_of(self._stage.model, self.agent, window.event, begun), self._promised)
            self._say()

    def _say(self) -> None:
        """RepeatedReport that it has failed, or that it has finished what it was at; again until a state shows it."""
        report, now = self._report, self._events.now
        word = report.due(now, now) if report is not None else None
        if word is not None:
            self._publish(self.agent, word)
        self._report_timer.set(report.next_moment() if report is not None else None)

    def _window(self) -> Optional[EndWindow]:
        """When what it does ends by its model."""
        return end_window(self._stage.model, self._stage.model.automaton(self.agent), self._place)
