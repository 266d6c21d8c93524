"""Simulated robots, people and other agents: when each of their movements and actions ends.

A robot moves when it gets its goal, and acts when it gets its action; all other agents begin when the observer has
taken the start. The end comes a drawn delay later, inside the model's window, and is reported once; the state that
follows is the receipt.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Collection, Dict, List, NamedTuple, Optional, Protocol, Sequence, Tuple

from pursue_runtime.event_words import Word, format_word
from pursue_runtime.locations import TO_BE_SAID, action, is_movement, is_under_way
from pursue_runtime.model import Automaton, Edge, Model
from pursue_runtime.resend import resend_timeout
from pursue_runtime.state import LIVE, SystemState, older, rewinds

DELAYS = ("random", "early", "middle", "late")

INSIDE = (0.1, 0.2)  # time units: how far inside its window an end stays; more where being late would break it
SAME = 0.5  # time units: starts that are closer than this, and than half a rest, are one start
EARLY = 1.5  # time units by which an order may seem older than the start it is for: two nodes have two clocks


class EndWindow(NamedTuple):
    """The end `event` of what an agent does there: its clock is in (low, high], in time units."""

    event: str
    clock: str
    low: float
    high: float


@dataclass
class Activity:
    """A movement or an action that goes on; moments are seconds of ROS time, `sent` of the real clock. `at_once`: the
    word is to be published again whenever it was sent.

    `word` reports its end, with the number of the first state that has shown it; what is published again carries the
    time of the end.
    """

    location: str
    since: float
    word: Word
    shortest: float
    moment: float
    under_way: bool
    sends: int = 0
    sent: float = 0.0
    at_once: bool = False


def _rest(automaton: Automaton) -> float:
    """How long the agent rests, in time units, before it begins anything; infinite for one that only takes part."""
    begins = (edge for edge in automaton.edges if is_under_way(edge.target) and not is_under_way(edge.source))
    rests = (-bound.bound for edge in begins for bound in edge.when if bound.right and not bound.left)
    return min((rest for rest in rests if rest > 0), default=math.inf)


def end_window(model: Model, automaton: Automaton, location: str) -> Optional[EndWindow]:
    """Return when the movement or action of this location ends; None for other locations.

    Whoever takes part in what another agent does has the same window, by its own clock.
    """
    for edge in automaton.edges_from(location):
        if not edge.is_end:
            continue
        if edge.sync == "receive":
            return _shared_window(model, edge)
        lows = {bound.right: -bound.bound for bound in edge.when if bound.right and not bound.left}
        for bound in automaton.invariants[location]:
            if bound.left in lows or location in TO_BE_SAID:
                return EndWindow(edge.word, bound.left, lows.get(bound.left, 0.0), bound.bound)
    return None


def end_words(automaton: Automaton, location: str) -> List[str]:
    """Return the words with one of which the agent ends what it does at this location, if it ends that itself."""
    own = (edge for edge in automaton.edges_from(location) if edge.sync != "receive")
    return list(dict.fromkeys(edge.word for edge in own if edge.is_end and not edge.ends_part))


def _shared_window(model: Model, ending: Edge) -> Optional[EndWindow]:
    """Return when an agent that takes part in what another one does, until this edge, should report its end."""
    for other in model.acting:
        if any(edge.word == ending.word and edge.sync == "send" for edge in other.edges_from(ending.source)):
            window = end_window(model, other, ending.source)
            return window._replace(clock=ending.resets[0]) if window is not None and ending.resets else None
    return None


def report_word(model: Model, agent: str, event: str) -> str:
    """Return the text of the word that reports an event, as `report_of`."""
    return format_word(report_of(model, agent, event))


def report_of(model: Model, agent: str, event: str, as_of: Optional[int] = None) -> Word:
    """Return the word that reports an event, with the agent's name only if another agent has the same event; `as_of`
    as in Word."""
    able = {a.name for a in model.automata for edge in a.edges if edge.word == event and reports(a, edge)}
    return Word(agent if able - {agent} else "", event, as_of=as_of)


def reports(automaton: Automaton, edge: Edge) -> bool:
    """Return True if the agent reports this edge: an event of its own or, as a robot, the end of what it does together
    with others."""
    return edge.sync != "receive" or (automaton.is_robot and edge.is_end)


def _begins(order: str, location: str) -> bool:
    """Return True if this order, as `Simulator.on_order` takes it, begins what is done at this location."""
    return location.startswith(action(order, "")) if order else is_movement(location)


class Durations(Protocol):
    """Draws how long activities take."""

    def draw(self, window: EndWindow, agent: str, number: int) -> float:
        """Return time units from the start of the agent's `number`-th activity to its end, which is in the window."""

    def pick(self, words: Sequence[str], agent: str, number: int) -> str:
        """Return with which of these words it ends."""


def picked(words: Sequence[str], seed: str) -> str:
    """Return one of these words, the same for the same seed."""
    return words[0] if len(words) == 1 else random.Random(f"{seed}/word").choice(words)


class Delays:
    """Where in its window each end falls: `early`, `middle`, `late`, or at random, the same for the same seed."""

    def __init__(self, choice: str = "random", seed: int = 0) -> None:
        if choice not in DELAYS:
            raise ValueError(f"~delays is {choice!r}; expected one of {', '.join(DELAYS)}")
        self._choice = choice
        self._seed = seed

    def draw(self, window: EndWindow, agent: str, number: int) -> float:
        """Time units from the start of the agent's `number`-th activity to its end."""
        shares = {"early": 0.0, "middle": 0.5, "late": 1.0}
        # One generator for each activity: the order in which messages arrive must not change what is drawn.
        share = shares.get(self._choice, random.Random(f"{self._seed}/{agent}/{number}").random())
        width = min(1.0, window.high - window.low)
        first, last = window.low + INSIDE[0] * width, window.high - INSIDE[1] * width
        return first + share * (last - first)

    def pick(self, words: Sequence[str], agent: str, number: int) -> str:
        """With which of these words it ends."""
        return picked(words, f"{self._seed}/{agent}/{number}")


class Simulator:
    """The activities of simulated agents, from the states of the mission and the orders to robots."""

    def __init__(self, model: Model, reports: Collection[str], delays: Durations) -> None:
        """`reports`: the agents whose ends come from here."""
        self._agents = [automaton for automaton in model.acting if automaton.name in reports]
        unknown = set(reports) - {automaton.name for automaton in model.acting}
        if unknown:
            known = ", ".join(automaton.name for automaton in model.acting)
            raise ValueError(f"~reports names {', '.join(sorted(unknown))}; the agents are {known}")
        self._same = {automaton.name: min(SAME, _rest(automaton) / 2) for automaton in self._agents}
        self._model = model
        self._delays = delays
        self._state: Optional[SystemState] = None
        self._state_received = 0.0
        self._orders: Dict[str, Dict[str, float]] = {robot.name: {} for robot in self._agents}
        self._taken: Dict[str, int] = {}  # the number of the last order of each robot
        self._counts: Dict[str, int] = {}
        self._activities: Dict[str, Activity] = {}

    def on_state(self, state: SystemState, real: float) -> None:
        """Take a state, received at the time `real` of the monotonic clock."""
        before = self._state
        if before is not None and (older(state, before) or rewinds(state, before)):
            return
        self._state = state
        if before is None or before.seq != state.seq:
            self._state_received = real
            for activity in self._activities.values():
                activity.sends = min(activity.sends, 1)
        if state.status not in LIVE:
            self._activities.clear()
            self._taken.clear()
            return
        for automaton in self._agents:
            # At the first state, agents may be under way already: their goals were sent before this node started.
            self._update_activity(automaton, state, newborn=before is None)

    def on_order(self, robot: str, now: float, order: str = "", seq: int = 0) -> None:
        """Take that a robot got an order at the time `now`: the event of an action, or a goal ("").

        `seq` is the number of the order (0: it has none): one that comes again changes nothing.
        """
        if seq and seq <= self._taken.get(robot, 0):
            return
        self._taken[robot] = seq or self._taken.get(robot, 0)
        activity = self._activities.get(robot)
        if activity is not None and not activity.under_way and _begins(order, activity.location):
            self._start(activity, now)
        elif robot in self._orders:  # the state that it is for comes later
            self._orders[robot][order] = now

    def say_again(self) -> None:
        """Have all reports that no state has shown published again at once: an observer has appeared."""
        for activity in self._activities.values():
            activity.at_once = True

    def due(self, now: float, real: float) -> List[str]:
        """Return the words to publish at this ROS time and time of the monotonic clock."""
        words = []
        for name, activity in self._activities.items():
            if self._is_confirmed(name):
                continue
            ended = activity.under_way and now >= activity.moment - 1e-6
            if ended and (activity.sends == 0 or self._is_unanswered(activity, real)):
                word = activity.word._replace(at=activity.moment) if activity.sends else activity.word
                activity.sends += 1
                activity.sent, activity.at_once = real, False
                words.append(format_word(word))
        return words

    def next_moments(self) -> Tuple[Optional[float], Optional[float]]:
        """Return when to call `due` again, in ROS time and on the real clock; None: not before the next message."""
        activities = [activity for name, activity in self._activities.items() if not self._is_confirmed(name)]
        ends = [activity.moment for activity in activities if activity.under_way and activity.sends == 0]
        receipts = [self._resend_at(activity) for activity in activities if activity.sends]
        return min(ends, default=None), min(receipts, default=None)

    def _is_confirmed(self, name: str) -> bool:
        """Return True if the state shows that the agent has finished what others have not."""
        return self._state is not None and name in self._state.finished

    def _update_activity(self, automaton: Automaton, state: SystemState, newborn: bool) -> None:
        name = automaton.name
        location = state.locations.get(name, "")
        window = end_window(self._model, automaton, location)
        reported = any(e.is_end and reports(automaton, e) for e in automaton.edges_from(location))
        if window is None or not reported or window.clock not in state.clocks:
            self._activities.pop(name, None)
            return
        since = state.stamp - state.clocks[window.clock] * state.unit
        known = self._activities.get(name)
        same = self._same[name] * state.unit
        if known is not None and known.location == location and abs(known.since - since) < same:
            return
        number = self._counts[name] = self._counts.get(name, 0) + 1
        event = self._delays.pick(end_words(automaton, location) or [window.event], name, number)
        activity = Activity(
            location, since, report_of(self._model, name, event, state.seq), window.low * state.unit,
            since + self._delays.draw(window, name, number) * state.unit,
            under_way=not automaton.is_robot or newborn,
        )
        self._activities[name] = activity
        orders = self._orders[name]
        moments = [orders.pop(order) for order in list(orders) if _begins(order, location)]  # each starts one activity
        if not activity.under_way and moments and max(moments) >= since - EARLY * state.unit:
            self._start(activity, max(moments))

    @staticmethod
    def _start(activity: Activity, now: float) -> None:
        """The robot got its order: one that was long under way makes it late, as it would a real one."""
        activity.under_way = True
        activity.moment = max(activity.moment, now + activity.shortest)

    def _resend_at(self, activity: Activity) -> float:
        if activity.at_once:
            return 0.0
        unit = self._state.unit if self._state is not None else 1.0
        return max(activity.sent, self._state_received) + resend_timeout(activity.sends, self._model.reaction * unit)

    def _is_unanswered(self, activity: Activity, real: float) -> bool:
        return real >= self._resend_at(activity)
