"""The connections between nodes: each brings its messages in order, within what the strategy was promised."""

from __future__ import annotations

import random
from typing import Dict

from pursue_gen.simulation.clockwork import Act, Clockwork
from pursue_gen.simulation.faults import Trouble

DECIMALS = 2e-6
"""Seconds by which messages come before the last moment that was promised: stamps travel with six decimals."""


def share(draw: random.Random, extremes: float = 0.5) -> float:
    """A number from 0 to 1; with the probability `extremes`, it is 0 or 1."""
    if draw.random() < extremes:
        return float(draw.random() < 0.5)
    return draw.random()


class Wires:
    """All connections of one mission. A connection has the name of what it carries, such as `word:controller_bot1`."""

    def __init__(self, clockwork: Clockwork, trouble: Trouble, seed: str) -> None:
        self._clockwork, self._trouble = clockwork, trouble
        self._draw = random.Random(f"{seed}/wires")
        self._last: Dict[str, float] = {}

    def send(self, connection: str, latest: float, deliver: Act, machine: str = "") -> None:
        """Delivers a message after at most `latest` seconds, if no fault is in its way; `machine` may be cut off."""
        trouble, now = self._trouble, self._clockwork.now
        moment = now + max(0.0, latest - DECIMALS) * share(self._draw)
        if not trouble.kinds:
            self._deliver(connection, moment, deliver)
            return
        if trouble.lost():
            return
        moment = self._after_cut(machine, moment + trouble.late())
        again = trouble.again()
        alone = trouble.overtaken()
        if alone:
            self._clockwork.at(moment + alone, deliver)
        else:
            moment = self._deliver(connection, moment, deliver)
        if again is not None:
            self._clockwork.at(moment + again, deliver)

    def is_cut(self, machine: str) -> bool:
        """True while the machine is cut off."""
        cut = self._trouble.cut
        return cut is not None and cut[0] == machine and cut[1] <= self._clockwork.now < cut[2]

    def _deliver(self, connection: str, moment: float, deliver: Act) -> float:
        moment = self._last[connection] = max(moment, self._last.get(connection, 0.0))
        self._clockwork.at(moment, deliver)
        return moment

    def _after_cut(self, machine: str, moment: float) -> float:
        """When it comes: a connection that was cut is silent for up to 12 s more, then all comes in a burst."""
        cut = self._trouble.cut
        if cut is None or cut[0] != machine or not cut[1] <= self._clockwork.now < cut[2]:
            return moment
        self._trouble.count("cut")
        silence = random.Random(f"{machine}/{cut[2]}").uniform(0.0, 12.0)
        return max(moment, cut[2] + silence)
