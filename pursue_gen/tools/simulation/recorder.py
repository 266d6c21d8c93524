"""What is published in a simulated mission, recorded at its exact moments, and judged as missions on robots are; when
what agents report became true, and how far each robot drives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Set, Tuple

from pursue_gen.language.network_names import going
from pursue_gen.language.scenario import Scenario
from pursue_gen.tools.replay.check import check
from pursue_gen.tools.replay.finding import FAULT, UNRECORDED, WORLD, of_kind
from pursue_gen.tools.replay.game import Game
from pursue_gen.tools.replay.record import MissionRecord, RecordedWord, RobotOrder, read_word
from pursue_runtime.event_words import parse_report, parse_word, said_at
from pursue_runtime.locations import is_movement
from pursue_runtime.orders import Order
from pursue_runtime.state import ENDED, WAITING, SystemState

EPSILON = 5e-6
"""Moments (in time units) that are closer than this are the same: clocks and stamps travel as decimals."""


@dataclass(frozen=True)
class Judgement:
    """What was found in one mission. `problems`: what must never be; `untimely`: what came outside the model's windows;
    `lateness`: for how many time units a command was due at most, where there were faults; `latest`: which one."""

    problems: Tuple[str, ...]
    steps: int
    untimely: Tuple[str, ...]
    lateness: float
    latest: str


class Recorder:
    """Keeps states, words, orders and plans of one mission, each at its moment (seconds)."""

    def __init__(self) -> None:
        self.states: List[SystemState] = []
        self.plans: Dict[int, Mapping[str, Any]] = {}
        self.words: List[RecordedWord] = []
        self.orders: List[RobotOrder] = []
        self._misdated: List[str] = []

    def on_state(self, now: float, state: SystemState) -> None:
        """The observer publishes a state of this moment; an ended mission is as it was when it ended."""
        ended = bool(self.states) and self.states[-1].status in ENDED
        if not ended and state.status != WAITING and abs(state.stamp - now) > EPSILON * state.unit:
            self._misdated.append(f"state {state.seq} is of {now:.6f}, and says {state.stamp:.6f}")
        self.states.append(state)

    def on_word(self, now: float, text: str, node: str) -> None:
        """A node publishes a word."""
        self.words.append(read_word(now, text, node))

    def on_order(self, now: float, order: Order, node: str, again: bool) -> None:
        """A controller sends its robot an order; `again`: it was restarted since its last one."""
        action = "" if is_movement(order.location) and not order.at_once else order.event
        self.orders.append(RobotOrder(now, order.agent, node, None, action, order.seq, order.location, again))

    def record(self, now: float) -> MissionRecord:
        """All of it, up to this moment (seconds)."""
        said = tuple(self.words), tuple(self.orders), self.plans
        return MissionRecord(tuple(self.states), *said, exact_until=now)

    def judged(self, game: Game, faulty: bool, offset: float, now: float) -> Judgement:
        """The mission up to this moment (seconds), with faults or without.

        Without them nothing leaves the model; with them agents may, and messages may take any time, but no node does
        what it must not. `offset`: by how much (time units) the clocks of controllers may be wrong.
        """
        found = check(self.record(now), game, EPSILON, math.inf if faulty else 0.0, offset)
        levels = (FAULT, UNRECORDED) if faulty else (FAULT, UNRECORDED, WORLD)
        by_hand = of_kind(found.findings, "command")  # nobody is
        wrong = [each for each in found.findings if each.level in levels or each in by_hand]
        beside = {each.seq for each in of_kind(found.findings, "early", "late") if each.level == WORLD}
        steps = [step.state for step in found.steps if not game.is_deadline(*step.move[0])]
        text = "{0.event} by {0.agent} (state {0.seq}) came outside the model's window"
        untimely = [text.format(state) for state in steps if state.seq in beside]
        untimely += [each.text for each in of_kind(found.findings, "overdue")]
        problems = [*self._misdated, *(f"state {each.seq}: {each.text}" for each in wrong)]
        return Judgement(tuple(problems), len(found.steps), tuple(untimely), *found.longest_due)


class BecameTrue:
    """The moments (seconds) at which agents reported something for the first time, by its event."""

    def __init__(self) -> None:
        self._moments: Dict[str, List[float]] = {}
        self._known: Set[Tuple[str, str, Optional[int]]] = set()

    def note(self, agent: str, text: str, now: float) -> None:
        """An agent reports something; from the second time on that is no news."""
        report = parse_report(text) or parse_word(text)
        if report is not None and (agent, report.event, report.as_of) not in self._known:
            self._known.add((agent, report.event, report.as_of))
            self._moments.setdefault(report.event, []).append(now)

    def hear(self, text: str, now: float) -> None:
        """The observer gets a report; one that carries no time may count from now on."""
        report = parse_report(text) or parse_word(text)
        if report is not None and said_at(text) is None:
            self._moments.setdefault(report.event, []).append(now)

    def moment(self, state: SystemState, before: SystemState, now: float) -> float:
        """When what the state shows has happened, if the observer was away after the state `before`: when an agent
        reported it, as far as that is not before that state; what nobody has reported, when the state has it. Nobody
        that an observer reaches may have seen the state that was published last: then it begins before that."""
        reported = self._moments.get(state.event, []) if state.seq > before.seq else []
        moments = [max(before.stamp, min(moment, now)) for moment in reported] or [min(state.stamp, now)]
        return min(moments, key=lambda moment: abs(moment - state.stamp))


class Driven:
    """The ways that robots have set off on. `units`: their lengths together for each robot, in the scenario's units of
    distance."""

    def __init__(self, scenario: Scenario) -> None:
        self.units = {agent.name: 0.0 for agent in scenario.agents if agent.controllable and agent.mobile is not None}
        self._lengths: Dict[Tuple[str, str], float] = {
            (name, going(*end)): float(way.distance)
            for name in self.units
            for way in scenario.ways_of(name)
            for end in way.directions
        }
        self._places: Dict[str, str] = {}

    def on_state(self, state: SystemState) -> None:
        """The observer publishes a state."""
        for name in self.units:
            place = state.locations.get(name, "")
            if place != self._places.get(name):
                self.units[name] += self._lengths.get((name, place), 0.0)
                self._places[name] = place
