"""What a restarted observer hears before the time of the mission goes on: reports of what happened while it was away.

Words are kept until all nodes that may have something to report have said so, and are then taken in the order of the
times that they carry: as if the observer had been there. Times are seconds of ROS time, `real` of the monotonic clock.
"""

from __future__ import annotations

from typing import Collection, List, NamedTuple, Set

from pursue_runtime.observer.journal import Journal
from pursue_runtime.observer.mission import Mission
from pursue_runtime.state import SystemState
from pursue_runtime.words import said_at

PATIENCE = 5.0
"""Seconds of real time for which it waits for these nodes."""

MOST = 10_000
"""So many deadlines are handled between two words at most."""


class Heard(NamedTuple):
    """A word, and when what it says counts."""

    moment: float
    text: str


class Returning:
    """The words that were heard since the observer is back.

    `floor`: the time of the newest state that any node has seen. Nothing counts before it: that state says how things
    were then.
    """

    def __init__(self, floor: float, awaited: Collection[str], real: float) -> None:
        """`awaited`: the nodes that may have something to report."""
        self.floor = floor
        self.deadline = real + PATIENCE
        self._awaited: Set[str] = set(awaited)
        self._heard: List[Heard] = []

    def is_over(self, real: float) -> bool:
        """Return True if nobody is waited for any more."""
        return not self._awaited or real >= self.deadline

    def missing(self) -> List[str]:
        """Return the nodes that have not said that they have reported all."""
        return sorted(self._awaited)

    def hear(self, text: str, now: float) -> None:
        """Keep a word. It counts at the time that it carries, but not before `floor` nor after `now`, at which it was
        received: the clocks of two machines may differ."""
        at = said_at(text)
        self._heard.append(Heard(now if at is None else max(self.floor, min(at, now)), text))

    def on_reported(self, node: str) -> None:
        """Take that a node has reported all that it had to."""
        self._awaited.discard(node)

    def settle(self, mission: Mission, journal: Journal) -> List[SystemState]:
        """Pass what was heard to the mission, through its journal, each word at its moment and after the deadlines
        that were before it; return the states to publish."""
        states: List[SystemState] = []
        for moment, text in sorted(self._heard, key=lambda heard: heard.moment):
            states += _let_time_pass(mission, journal, max(self.floor, journal.last), moment)
            states += journal.call("hear", text, now=max(moment, journal.last))
        self._heard = []
        return states


def _let_time_pass(mission: Mission, journal: Journal, start: float, end: float) -> List[SystemState]:
    """Handle what is due until `end`, each at its moment."""
    states: List[SystemState] = []
    now, known = start, mission.revision()
    for _ in range(MOST):
        moment = mission.next_moment(now)
        if moment is None or moment > end:
            break
        states += journal.call("tick", now=max(moment, now))
        if moment <= now and mission.revision() == known:
            break  # it waits for something else than time
        now, known = max(moment, now), mission.revision()
    return states
