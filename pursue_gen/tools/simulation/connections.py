"""The connections between nodes: each brings its messages in order, within what the strategy was promised."""

from __future__ import annotations

import random
from typing import Dict

from pursue_gen.tools.simulation.event_queue import Action, EventQueue
from pursue_gen.tools.simulation.faults import FaultPlan

SHARE = 0.2
"""Where messages are lost, each takes at most this share of the reaction: the rest is for sending it again. Measured on
the bundled scenarios, with one message in twenty lost."""

RECONNECTION = 0.5, 2.0
"""Seconds, least and most, until a robot connects again and gets the order that it carries out. Not measured."""

DECIMALS = 2e-6
"""Seconds by which messages come before the last moment that was promised: stamps travel with six decimals."""


def drawn_share(draw: random.Random) -> float:
    """A number from 0 to 1; half of the time it is 0 or 1."""
    if draw.random() < 0.5:
        return float(draw.random() < 0.5)
    return draw.random()


class Connections:
    """All connections of one mission. A connection has the name of what it carries, such as `word:controller_bot1`."""

    def __init__(self, events: EventQueue, fault_plan: FaultPlan, seed: str, reaction: float = 0.0) -> None:
        """`reaction`: the seconds within which the strategy expects a command to take effect."""
        self._events, self._fault_plan = events, fault_plan
        self._draw = random.Random(f"{seed}/wires")
        self._last: Dict[str, float] = {}
        self._holds_up = bool(fault_plan.kinds & {"delay", "cut"})
        self._longest = SHARE * reaction if "loss" in fault_plan.kinds else float("inf")

    def send(self, connection: str, latest: float, deliver: Action, machine: str = "") -> None:
        """Delivers a message after at most `latest` seconds, if no fault is in its way; `machine` may be cut off."""
        fault_plan, now = self._fault_plan, self._events.now
        longest = max(0.0, min(latest, self._longest) - DECIMALS)
        moment = now + longest * drawn_share(self._draw)
        if not self._holds_up:  # a message comes in time, even if it has to overtake the one before it
            moment = min(max(moment, self._last.get(connection, 0.0)), now + longest)
        if not fault_plan.kinds:
            self._deliver(connection, moment, deliver)
            return
        if fault_plan.is_lost():
            return
        moment = self._after_cut(machine, moment + fault_plan.delay())
        again = fault_plan.duplicate_delay()
        alone = fault_plan.reorder_delay()
        if alone:
            self._events.schedule(moment + alone, deliver)
        else:
            moment = self._deliver(connection, moment, deliver)
        if again is not None:
            self._events.schedule(moment + again, deliver)

    def send_order(self, deliver: Action) -> None:
        """Delivers an order from a controller to its robot, on the same machine: at once, unless they are disconnected
        (`orders`). Then the robot gets it when it has connected again."""
        delay = self._fault_plan.disconnection(*RECONNECTION)
        self._events.schedule(self._events.now + delay, deliver)

    def is_cut(self, machine: str) -> bool:
        """True while the machine is cut off."""
        cut = self._fault_plan.cut
        return cut is not None and cut[0] == machine and cut[1] <= self._events.now < cut[2]

    def _deliver(self, connection: str, moment: float, deliver: Action) -> float:
        last = max(moment, self._last.get(connection, 0.0))
        if self._holds_up:
            moment = last
        self._last[connection] = last
        self._events.schedule(moment, deliver)
        return moment

    def _after_cut(self, machine: str, moment: float) -> float:
        """When it comes: a connection that was cut is silent for up to 12 s more, then all comes in a burst."""
        cut = self._fault_plan.cut
        if cut is None or cut[0] != machine or not cut[1] <= self._events.now < cut[2]:
            return moment
        self._fault_plan.count("cut")
        silence = random.Random(f"{machine}/{cut[2]}").uniform(0.0, 12.0)
        return max(moment, cut[2] + silence)
