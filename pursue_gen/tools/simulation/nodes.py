"""The nodes of a workspace on simulated wires: what their thin ROS parts do, around the run time."""

from __future__ import annotations

import json
from typing import Any, Dict, List, Mapping, Optional, Protocol, Sequence, Union

from pursue_gen.tools.simulation.event_queue import Action, EventQueue, Timer
from pursue_gen.tools.simulation.stage import Stage
from pursue_runtime.controller.scheduler import CommandScheduler
from pursue_runtime.event_words import Word, parse_word
from pursue_runtime.observer.journal import Journal, replay
from pursue_runtime.observer.mission import Mission
from pursue_runtime.observer.planning import PlanRequest
from pursue_runtime.observer.returning import Inbox, take_up
from pursue_runtime.orders import Order
from pursue_runtime.resend import StateRepeats
from pursue_runtime.sentences import Log
from pursue_runtime.state import LIVE, SystemState
from pursue_runtime.strategy import Strategy
from pursue_runtime.ui import mission_view as ui
from pursue_runtime.ui.environment import TraceEnvironment

TICK = 1e-9
"""Seconds by which an alarm rings after its moment, so that its moment has come by any clock."""


class MissionLinks(Protocol):
    """What the nodes need of the mission around them."""

    events: EventQueue
    faulty: bool

    def publish(self, state: SystemState) -> None:
        """The observer publishes a state."""

    def repeat(self, state: SystemState) -> None:
        """The observer publishes a state once more, unchanged."""

    def publish_plan(self, plan: Dict[str, Any]) -> None:
        """The observer publishes another plan."""

    def request_plan(self, request: Optional[PlanRequest]) -> None:
        """The observer requests another plan (None: it needs none)."""

    def publish_word(self, node: str, word: Word, latest: float) -> None:
        """A controller or the UI publishes a word, which without faults arrives by the time `latest`."""

    def command_robot(self, node: str, order: Order, seq: int, newest: int, again: bool) -> None:
        """A controller sends its robot an order, because of state `seq`; `newest` is the newest one that it knows,
        `again`: it was restarted since its last order."""


class MemoryJournal(Journal):
    """A journal as lines of text, which outlive the process that writes them, as on a disk."""

    def __init__(self, mission: Mission, lines: List[str], log: Log) -> None:
        """Replay the lines into a fresh mission. Raises DataError where they do not fit it."""
        super().__init__(mission, "", {}, log)
        self._lines = lines
        entries = [json.loads(line) for line in lines]
        replay(mission, entries)
        self.last = max((float(entry["at"]) for entry in entries), default=0.0)

    def _write(self, entry: Mapping[str, Any], sync: bool = False) -> None:
        self._lines.append(json.dumps(entry))


class ObserverNode:
    """The observer. `alive` False: it was killed; its journal is kept. `life` counts its processes: what was sent to
    one never comes to the next. `looks_back`: what it publishes now may have happened while there was no observer."""

    def __init__(self, stage: Stage, links: MissionLinks, log: Log) -> None:
        self.alive, self.life, self.looks_back = True, 1, False
        self._stage, self._links, self._log = stage, links, log
        self._lines: List[str] = []
        self._timer = Timer(links.events, self._on_alarm)
        self._repeat_timer = Timer(links.events, self._repeat)
        self._repeats = StateRepeats(stage.reaction)
        self._proposed = 0
        self.mission = self._mission()
        self._inbox = Inbox(self.mission, MemoryJournal(self.mission, self._lines, log), log)

    def _mission(self) -> Mission:
        stage = self._stage
        return Mission(stage.model, stage.cover, self._log, on_uncovered="plan", controllers=tuple(stage.strategies))

    @property
    def is_returning(self) -> bool:
        """True while it hears first what happened when there was no observer."""
        return self._inbox.returning is not None

    def call(self, name: str, *args: Any) -> None:
        """Calls the mission, and publishes what follows."""
        if self.alive:
            self.looks_back = self.is_returning
            self._publish(self._inbox.call(name, *args, now=self._links.events.now))

    def on_reported(self, node: str) -> None:
        """A node has reported all that it had to."""
        if self.alive:
            self.looks_back = self.is_returning
            self._publish(self._inbox.on_reported(node, self._links.events.now))

    def awaits(self, node: str) -> bool:
        """True while it has returned, and the node has not said that it has reported all that it had to."""
        returning = self._inbox.returning
        return self.alive and returning is not None and node in returning.missing()

    def _on_alarm(self) -> None:
        now = self._links.events.now
        self.looks_back = self.is_returning
        self._publish(self._inbox.on_alarm(now, now))

    def heartbeat(self) -> None:
        """Publishes the state again."""
        if self.alive and not self.is_returning:
            if self.mission.proposal is not None:
                self._proposed = 0
            self.looks_back = False
            self._publish([self.mission.state(self._links.events.now)])

    def restart(self, seen: Mapping[str, SystemState]) -> None:
        """A new process: it has the journal, and what other nodes have seen last."""
        self.alive = True
        self.life += 1
        self.mission, now = self._mission(), self._links.events.now
        journal = MemoryJournal(self.mission, self._lines, self._log)
        reporting = [node for node, state in seen.items() if state.status in LIVE]
        returning = take_up(self.mission, journal, seen, reporting, now, now)
        self._inbox = Inbox(self.mission, journal, self._log, returning)
        self._proposed = 0
        self._repeats = StateRepeats(self._stage.reaction)
        self.looks_back = returning is not None
        self._publish([self.mission.state(returning.floor if returning else now)])

    def kill(self) -> None:
        """It is killed."""
        self.alive = False
        self._timer.set()
        self._repeat_timer.set()

    def _publish(self, states: Sequence[SystemState]) -> None:
        links, mission = self._links, self.mission
        for state in states:
            links.publish(state)
            if links.faulty:  # without faults a repeated state changes nothing
                self._repeats.on_publish(state, links.events.now)
                self._repeat_timer.set(self._repeats.next_moment())
        proposal = mission.proposal or mission.in_force
        if proposal is not None and proposal["plan"] != self._proposed:
            self._proposed = proposal["plan"]
            links.publish_plan(proposal)
        links.request_plan(mission.plan_request)
        self._timer.set(*self._inbox.next_moments(links.events.now))

    def _repeat(self) -> None:
        state = self._repeats.due(self._links.events.now)
        if state is not None:
            self._links.repeat(state)
        self._repeat_timer.set(self._repeats.next_moment())


class ControllerNode:
    """A controller. `offset`: seconds by which its clock is ahead; `plan`: the number of the plan that it got last."""

    def __init__(self, stage: Stage, name: str, links: MissionLinks, offset: float) -> None:
        self.name, self.life, self.plan = name, 1, 0
        self.alive, self._restarted, self._newest = True, False, 0
        self._stage, self._links, self._offset = stage, links, offset
        self._timer = Timer(links.events, self._on_timer)
        self._scheduler = self._new()

    def _new(self) -> CommandScheduler:
        return CommandScheduler(self._stage.strategies[self.name], self.name)

    @property
    def seen(self) -> Optional[SystemState]:
        """The newest state that it has seen."""
        return self._scheduler.state if self.alive else None

    @property
    def _now(self) -> float:
        return self._links.events.now + self._offset

    def on_state(self, state: SystemState) -> None:
        """A state has come."""
        if not self.alive:
            return
        self._newest = max(self._newest, state.seq)
        for order in self._scheduler.on_state(state, self._now):
            if order.agent in self._stage.robots:
                self._links.command_robot(self.name, order, state.seq, self._newest, self._restarted)
        self._restarted = False
        receipt = self._scheduler.repeated_receipt()
        if receipt:
            self._links.publish_word(self.name, receipt, self._links.events.now)
        if self._scheduler.is_new:
            self._set_timer()  # a state in which nothing is new must not delay the next resend

    def on_plan(self, plan: Dict[str, Any]) -> None:
        """Another plan has come."""
        if self.alive:
            strategy = Strategy(plan["strategies"][self.name])
            self.plan = plan["plan"]
            word = self._scheduler.add_plan(self.plan, strategy, self._now)
            self._links.publish_word(self.name, word, self._links.events.now)
            self._set_timer()

    def say_again(self) -> None:
        """An observer has connected: a command that is due comes again."""
        if self.alive:
            self._on_timer()

    def restart(self) -> None:
        """A new process: it knows nothing."""
        self.alive = self._restarted = True
        self.life += 1
        self._newest = self.plan = 0
        self._scheduler = self._new()

    def kill(self) -> None:
        """It is killed."""
        self.alive = False
        self._timer.set()

    def _on_timer(self) -> None:
        decided = self._scheduler.next_wakeup()[0]
        word = self._scheduler.on_timer(self._now)
        if word:
            stage = self._stage
            moment = self._links.events.now if decided is None else decided - self._offset
            self._links.publish_word(self.name, word, moment + stage.reaction)
        self._set_timer()

    def _set_timer(self) -> None:
        moment, patience = self._scheduler.next_wakeup()
        due = None if moment is None else moment - self._offset + TICK
        resend = self._links.events.now + patience if patience is not None and self._links.faulty else None
        self._timer.set(due, resend)  # without faults no word is lost, and one that is sent again is stale


class PeopleNode:
    """The part of the UI that instructs human allies. It gets the states without delay."""

    def __init__(self, stage: Stage, links: MissionLinks) -> None:
        self._stage, self._links = stage, links
        self._ui = ui.MissionView(stage.model, TraceEnvironment(()), stage.people)
        self._timer = Timer(links.events, self._on_timer)

    def on_state(self, state: SystemState) -> None:
        """A state has come."""
        self._ui.on_state(state, self._links.events.now)
        self._on_timer()

    def on_plan(self, plan: Dict[str, Any]) -> None:
        """Another plan has come."""
        if plan["people"]:
            self._ui.add_plan(plan["plan"], Strategy(plan["people"]))
            self._on_timer()

    def say_again(self) -> None:
        """An observer has connected: an instruction that no state has answered comes again."""
        self._ui.say_again()
        self._on_timer()

    def _on_timer(self) -> None:
        now, stage = self._links.events.now, self._stage
        for text in self._ui.due(now, now):
            word = parse_word(text)
            assert word is not None, f"the user interface published {text!r}"
            self._links.publish_word("UI", word, now + stage.reaction)
        self._timer.set(*self._ui.next_moments(now))


def to_process(node: Union[ObserverNode, ControllerNode], deliver: Action) -> Action:
    """Delivers to the process that the node is now: what is on its way when that dies is lost."""
    life = node.life

    def arrive() -> None:
        if node.life == life:
            deliver()

    return arrive
