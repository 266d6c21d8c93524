"""When a controller publishes its commands, and which orders its robots get. Times are seconds of ROS time."""

from __future__ import annotations

from typing import Callable, Dict, FrozenSet, List, Optional, Tuple

from pursue_runtime.event_words import PLANNED, Word
from pursue_runtime.locations import is_under_way
from pursue_runtime.orders import Order, parse_orders
from pursue_runtime.resend import resend_timeout
from pursue_runtime.state import HOLDING, LIVE, RUNNING, WAITING, SystemState, older, rewinds
from pursue_runtime.strategy import Command, Entry, Plans, Strategy
from pursue_runtime.zones import EPSILON

UNREADY = 0.2
"""Seconds of real time until a command whose robot is not ready for it is looked at again."""


class CommandScheduler:
    """Finds in each state when the next command of the strategy is due, and which orders are new."""

    def __init__(self, strategy: Strategy, name: str = "") -> None:
        """`name`: the controller's, with which it acknowledges new plans."""
        self.state: Optional[SystemState] = None
        self.planned: Optional[Tuple[float, Command]] = None
        self.is_new = False  # the last state was a new one, in which there is something to decide
        self.counts = dict.fromkeys(("taken", "sent", "sent_again", "too_late", "not_ours", "old"), 0)
        self._name = name
        self._agents = strategy.agents
        self._since: Dict[Entry, SystemState] = {}  # in which is decided what stands in the present state
        self._own = strategy
        self._plans = Plans(strategy)
        self._newest = 0
        self._ordered: FrozenSet[Tuple[str, str, int]] = frozenset()  # the orders that were given, and still stand
        self._unanswered = 0
        self._patience: Optional[float] = None
        self._waits = False  # a command is due, but its robot is not ready for it

    def next_wakeup(self) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `on_timer`: a time, or seconds of real time until a word counts as lost."""
        return (self.planned[0] if self.planned and not self._waits else None), self._patience

    def add_plan(self, plan: int, strategy: Strategy, now: float) -> Word:
        """Add a plan for the states that name it; return the word that acknowledges it."""
        self._plans.add(plan, strategy)
        self._newest = max(plan, self._newest)
        if self.state is not None and self.state.plan == plan and self.planned is None:
            self._since = {}
            self._look_for_what_stands(None, self.state)
            self._plan(now)
        return self._receipt(plan)

    def repeated_receipt(self) -> Optional[Word]:
        """Return the acknowledgement of the newest plan once more, while the mission may be waiting for it."""
        waits = self.state is not None and self.state.status == HOLDING and self.state.plan < self._newest
        return self._receipt(self._newest) if waits else None

    def _receipt(self, plan: int) -> Word:
        return Word(self._name, PLANNED, plan)

    def on_state(self, state: SystemState, now: float) -> List[Order]:
        """Take a state, find the next command, and return the orders for our robots that are new."""
        before = self.state
        self.is_new = False
        if before is not None and (older(state, before) or rewinds(state, before)):
            self.counts["old"] += 1
            return []
        self.state = state
        if state.status == WAITING:  # new plans belong to a mission that has begun: these are of an earlier one
            self._plans, self._newest = Plans(self._own), 0
        orders = self._new_orders(state)
        if before is not None and (before.seq, before.status) == (state.seq, state.status):
            # The answer to a ping, or a heartbeat; a robot that has acknowledged an order may get the next command.
            self.is_new = self.planned is not None and before.orders != state.orders
            self._waits = self._waits and not self.is_new
            return orders
        self.is_new = self._look_for_what_stands(before, state)
        if self.is_new:
            self.planned, self._patience, self._unanswered, self._waits = None, None, 0, False
        if self.is_new and state.status in LIVE:
            self._plan(now)
        if before is not None and self._is_by_hand(before, state):
            self.counts["not_ours"] += 1
        self.counts["taken"] += len(orders)
        return orders

    def on_timer(self, now: float, may_begin: Callable[[Command], bool] = lambda command: True) -> Optional[Word]:
        """Return the word to publish now: a command that is due, or one that got no answer. Ensures that the strategy
        of the plan in force gives that command in the newest state, now.

        A command is not published unless `may_begin` is true of it; one by which the agent leaves where it is not
        before it has acknowledged what it was ordered to do at once.
        """
        state = self.state
        if state is None or state.status != RUNNING:
            return None
        self._patience, self._waits = None, False
        strategy = self._plans.strategy_for(state)
        if strategy is None:
            return None
        if self.planned is None:  # the last word was not answered
            self.planned = strategy.decided(self._since, now)
        elif now > self.planned[0] + strategy.lateness(state) + EPSILON:
            self.planned = strategy.decided(self._since, now)
            self.counts["too_late"] += self.planned is None or self.planned[0] > now
        if self.planned is None or now < self.planned[0]:
            return None
        command = self.planned[1]
        busy = {order.agent for order in parse_orders(state.orders) if order.at_once}
        if (command.agent in busy and command.origin != command.target) or not may_begin(command):
            self._patience, self._waits = UNREADY, True
            return None
        self.planned = None
        self._patience = resend_timeout(self._unanswered + 1, strategy.reaction * state.unit)
        self.counts["sent_again" if self._unanswered else "sent"] += 1
        self._unanswered += 1
        return Word(command.agent, command.event, state.seq)

    def _plan(self, now: float) -> None:
        """Find the next command: none while the mission holds, or before the plan in force has arrived."""
        strategy = self._plans.strategy_for(self.state) if self.state and self.state.status == RUNNING else None
        self.planned = strategy.decided(self._since, now) if strategy else None

    def _look_for_what_stands(self, before: Optional[SystemState], state: SystemState) -> bool:
        """Find in which states is decided what stands in this one; return True unless all is as in the one before."""
        strategy, known = self._plans.strategy_for(state), self._since
        self._since = strategy.since(known, before, state) if strategy is not None else {}
        return not known or known != self._since

    def _new_orders(self, state: SystemState) -> List[Order]:
        """Return the orders for our agents that were not given yet."""
        if state.status not in LIVE:
            self._ordered = frozenset()
            return []
        standing = [order for order in parse_orders(state.orders) if order.agent in self._agents]
        known, self._ordered = self._ordered, frozenset(order.key for order in standing)
        return [order for order in standing if order.key not in known]

    def _is_by_hand(self, before: SystemState, state: SystemState) -> bool:
        """Return True if somebody else than the strategy had one of our agents begin what it does now."""
        here = state.locations.get(state.agent, "")
        begins = here != before.locations.get(state.agent, "") and is_under_way(here)
        return state.agent in self._agents and begins and not state.commanded
