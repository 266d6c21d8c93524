"""When a controller publishes its commands, and what its agents have begun. Times are seconds of ROS time."""

from __future__ import annotations

from typing import Callable, Dict, List, NamedTuple, Optional, Tuple

from pursue_runtime.locations import action, action_of, is_movement, is_under_way
from pursue_runtime.resend import resend_timeout
from pursue_runtime.state import HOLDING, LIVE, RUNNING, WAITING, WON, SystemState, older, rewinds
from pursue_runtime.strategy import Command, Entry, Plans, Strategy
from pursue_runtime.words import PLANNED, Word
from pursue_runtime.zones import EPSILON

UNREADY = 0.2
"""Seconds of real time until a command whose robot is not known to be in its place is looked at again."""


class StartedActivity(NamedTuple):
    """A movement or an action that an agent has begun, for its robot."""

    agent: str
    trigger: str
    origin: str
    target: str


class CommandScheduler:
    """Finds in each state when the next command of the strategy is due, and what the agents have begun."""

    def __init__(self, strategy: Strategy, name: str = "") -> None:
        """`name`: the controller's, with which it acknowledges new plans."""
        self.state: Optional[SystemState] = None
        self.planned: Optional[Tuple[float, Command]] = None
        self.is_new = False  # the last state was a new one, in which there is something to decide
        self.joined: List[StartedActivity] = []  # what our robots do with others, who have begun it in the last state
        self.counts = dict.fromkeys(("taken", "sent", "sent_again", "too_late", "not_ours", "old"), 0)
        self._name = name
        self._agents = strategy.agents
        self._since: Dict[Entry, SystemState] = {}  # in which is decided what stands in the present state
        self._own = strategy
        self._plans = Plans(strategy)
        self._newest = 0
        self._unanswered = 0
        self._patience: Optional[float] = None

    def next_wakeup(self) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `on_timer`: a time, or seconds of real time until a word counts as lost."""
        return (self.planned[0] if self.planned else None), self._patience

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

    def on_state(self, state: SystemState, now: float) -> List[StartedActivity]:
        """Take a state, find the next command, and return what our agents have begun."""
        before = self.state
        self.is_new, self.joined = False, []
        if before is not None and (older(state, before) or rewinds(state, before)):
            self.counts["old"] += 1
            return []
        self.state = state
        if state.status == WAITING:  # new plans belong to a mission that has begun: these are of an earlier one
            self._plans, self._newest = Plans(self._own), 0
        if before is not None and (before.seq, before.status) == (state.seq, state.status):
            return []  # the answer to a ping, or a heartbeat
        self.is_new = self._look_for_what_stands(before, state)
        if self.is_new:
            self.planned, self._patience, self._unanswered = None, None, 0
        self.joined = self._joined(before, state) if state.status in (*LIVE, WON) else []
        if state.status == WON:  # what won it, if that is done at once
            return [order for order in self._begun(before, state) if order.origin == order.target]
        if state.status not in LIVE:
            return []
        if self.is_new:
            self._plan(now)
        orders = self._begun(before, state)
        self.counts["taken"] += len(orders)
        return orders

    def on_timer(self, now: float, is_placed: Callable[[str], bool] = lambda agent: True) -> Optional[Word]:
        """Return the word to publish now: a command that is due, or one that got no answer.

        One that begins an action is not published unless `is_placed` is true of its agent.
        """
        state = self.state
        if state is None or state.status != RUNNING:
            return None
        self._patience = None
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
        if not is_under_way(command.origin) and not is_movement(command.target) and not is_placed(command.agent):
            self._patience = UNREADY
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

    def _begun(self, before: Optional[SystemState], state: SystemState) -> List[StartedActivity]:
        """Return what our agents have begun since the state before, even if states in between were missed."""
        orders: List[StartedActivity] = []
        for agent in self._agents:
            target = state.locations.get(agent, "")
            origin = before.locations.get(agent, "") if before else ""
            own = state.agent == agent
            begins = origin != target and is_under_way(target)
            if own and before is not None and not self._holds(before, state):
                self.counts["not_ours"] += 1  # a report, or a word published by hand: the robot gets no order
            elif begins and not own and agent in state.lost and self._takes_part(agent, target):
                continue  # it is moved with the others, and nothing is expected of it
            elif begins and not own and self._joins_by_hand(state, agent, target):
                self.counts["not_ours"] += 1  # as for the one who does it
            elif begins or (own and origin == target and self._instant(state, target)):
                trigger = state.event if own else self._event(state, target)
                orders.append(StartedActivity(agent, trigger, origin, target))
        return orders

    def _event(self, state: SystemState, location: str) -> str:
        """Return the event that begins what is done there. A strategy knows it, also if a place has `_in_` in it."""
        strategies = (self._plans.strategy_for(state), self._own)
        known = (strategy.actions[location] for strategy in strategies if strategy and location in strategy.actions)
        shared = (event for events in self._own.reacts_to.values() for event in events)
        fitting = [event for event in shared if location.startswith(action(event, ""))]
        return next(known, max(fitting, key=len, default=action_of(location)))

    def _takes_part(self, agent: str, location: str) -> bool:
        """Return True if our robot takes part there in what another agent does."""
        return any(location.startswith(action(event, "")) for event in self._own.reacts_to.get(agent, ()))

    def _joins_by_hand(self, state: SystemState, agent: str, location: str) -> bool:
        """Return True if our robot takes part there in what was begun by hand for a robot or person that
        controllers command."""
        doers = self._own.reacts_to.get(agent, {}).get(state.event, ())
        return not state.commanded and state.agent in doers and location.startswith(action(state.event, ""))

    def _joined(self, before: Optional[SystemState], state: SystemState) -> List[StartedActivity]:
        """Return the collaborative events that others have begun since the state before, with our robots as partners:
        those that react to the event and are at its place."""
        orders: List[StartedActivity] = []
        for robot, events in self._own.reacts_to.items():
            place = state.locations.get(robot, "")
            if is_under_way(place):
                continue  # it is on its way, or busy with the event itself: that is begun like its own actions
            for event, doers in events.items():
                others = (agent for agent in state.locations if agent != robot)
                begun = {agent for agent in others if self._begins(before, state, agent, event, place)}
                by_hand = not state.commanded and state.event == event and begun <= {state.agent} & set(doers)
                if begun and not by_hand:
                    orders.append(StartedActivity(robot, event, place, place))
        return orders

    @staticmethod
    def _begins(before: Optional[SystemState], state: SystemState, agent: str, event: str, place: str) -> bool:
        """Return True if the agent has begun this event, at this place, since the state before."""
        here = state.locations[agent]
        if here == action(event, place):
            return before is None or before.locations.get(agent) != here
        return before is not None and (state.agent, state.event, here) == (agent, event, place)

    def _instant(self, state: SystemState, location: str) -> bool:
        """Return True if the last event is a command without duration, not the end of another one."""
        strategy = self._plans.strategy_for(state)
        return strategy is not None and strategy.instant(state.agent, state.event, location)

    def _holds(self, before: SystemState, state: SystemState) -> bool:
        """Return True if a command of the strategy led to the state, or states were missed so that it may have."""
        if before.status == HOLDING and state.seq == before.seq + 1:
            return False
        strategy = self._plans.strategy_for(before)
        if state.seq != before.seq + 1 or strategy is None:
            return True
        commands = strategy.commands(before)
        return any((command.agent, command.event) == (state.agent, state.event) for command in commands)
