"""The simulated world: robots, people and other agents end what they do, early and late in the model's window alike.

The run time's simulator tells the ends, one for each agent; here is drawn when, and what breaks.
"""

from __future__ import annotations

import random
from typing import Callable

from pursue_gen.simulation.clockwork import Alarm, Clockwork
from pursue_gen.simulation.faults import Breakdown, Trouble
from pursue_gen.simulation.stage import Stage
from pursue_gen.simulation.wires import share
from pursue_gen.tga.names import is_under_way
from pursue_runtime.simulator.simulator import EndWindow, Simulator, end_window, report_word
from pursue_runtime.state import SystemState

INSIDE = 1e-3
"""Time units by which the earliest end is inside its window, which opens with a strict bound."""


class Durations:
    """How long each activity of an agent takes; in the place of the simulator's `Delays`."""

    def __init__(self, trouble: Trouble, seed: str) -> None:
        self._trouble, self._seed = trouble, seed

    def draw(self, window: EndWindow, agent: str, number: int) -> float:
        """Time units from the start of the agent's `number`-th activity to its end: each end of the window with
        probability 1/4."""
        part = share(random.Random(f"{self._seed}/{agent}/{number}"))
        inside = min(INSIDE, (window.high - window.low) / 2)
        usual = window.low + inside + part * (window.high - window.low - inside)
        return self._trouble.duration(window.low, window.high, usual)


class Mover:
    """An agent that moves and acts. Its ends are words, brought by `say`."""

    def __init__(self, stage: Stage, agent: str, clockwork: Clockwork, trouble: Trouble, seed: str,
                 say: Callable[[str, str], None], promised: float) -> None:
        """`promised`: the strategy has it that an order comes so many seconds after its state at the latest."""
        self.agent = agent
        self._stage = stage
        self._clockwork, self._trouble, self._say, self._promised = clockwork, trouble, say, promised
        self._simulator = Simulator(stage.model, [agent], Durations(trouble, seed))
        self._alarm = Alarm(clockwork, self._act)
        self._breakdown = trouble.breakdown if trouble.breakdown and trouble.breakdown.robot == agent else None
        self._place = ""
        self._activities = 0
        self._broken = False
        self._stamp = 0.0

    def see(self, state: SystemState) -> None:
        """A state of the mission: it is what the world is like, for robots move by orders only."""
        place = state.locations.get(self.agent, "")
        if place != self._place:
            self._place = place
            if is_under_way(place):
                self._activities += 1
                self._stamp = state.stamp
                self._may_break()
        self._simulator.on_state(state, self._clockwork.now)
        self._set()

    def order(self) -> None:
        """A goal or an action for a robot. One that comes as promised lets it end anywhere in the model's window."""
        now = self._clockwork.now
        in_time = now <= self._stamp + self._promised + 1e-6
        self._simulator.on_goal(self.agent, self._stamp if in_time else now)
        self._set()

    def _act(self) -> None:
        now = self._clockwork.now
        for word in self._simulator.due(now, now):
            if not self._broken:
                self._say(self.agent, word)
        self._set()

    def _set(self) -> None:
        self._alarm.set(*self._simulator.next_moments())

    def _may_break(self) -> None:
        breakdown = self._breakdown
        if breakdown is not None and breakdown.number == self._activities:
            self._breakdown = None
            self._clockwork.at(self._clockwork.now + 5.0 * breakdown.share, lambda: self._break(breakdown, self._place))

    def _break(self, breakdown: Breakdown, place: str) -> None:
        if self._place != place:
            return  # it was done sooner
        self._broken = True
        self._trouble.count("failed" if breakdown.says else "silent")
        if breakdown.says:
            self._say(self.agent, f"{self.agent}:_failed_")
        if breakdown.back is not None:
            self._clockwork.at(self._clockwork.now + breakdown.back, self._mend)

    def _mend(self) -> None:
        """It can go on: what it was at ends now, if that is still to end."""
        self._broken = False
        model = self._stage.model
        window = end_window(model.automaton(self.agent), self._place)
        if window is not None:
            self._say(self.agent, report_word(model, self.agent, window.event))
