"""What a robot is on its way to, and what has become of its goals. Times are seconds of ROS time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Optional, Tuple

from pursue_runtime.controller.goal import Answer, Halt, Movement
from pursue_runtime.controller.whereabouts import Place
from pursue_runtime.sentences import marked, quoted

STATUS_WAIT = 2.0
"""Seconds after a goal was cancelled for the status that shows whether a goal of another node has replaced it."""


@dataclass
class Trip:
    """A movement, or the way back to where the state has the robot; `attempts` is how many goals it took, `is_sent`:
    this node has sent one. `halts`: those that are left, where the doors are not known to be open yet; `is_aboard`:
    it is in the cabin of a lift, where it has the first of them.

    Its goal may be cancelled by another node. `cancelled` is that answer until it is known whether a goal of the other
    node has replaced ours (`replaced` counts how often), which is at `decided_at` at the latest.
    """

    movement: Movement
    since: float
    is_return: bool = False
    goal_at: Optional[float] = None
    attempts: int = 0
    is_sent: bool = False
    has_arrived: bool = False
    halts: Tuple[Halt, ...] = ()
    is_aboard: bool = False
    is_held: bool = False  # it waits for a person
    cancelled: Optional[Answer] = None
    decided_at: float = 0.0
    replaced: int = 0

    @property
    def waits(self) -> bool:
        """Return True if its goal was cancelled: it waits for a person, or for the status that shows why."""
        return self.is_held or self.cancelled is not None

    def cancel(self, answer: Answer, now: float) -> None:
        """Note that another node has cancelled the goal."""
        self.cancelled, self.decided_at, self.attempts = answer, now + STATUS_WAIT, 0

    def resume(self, now: float) -> None:
        """Note that a person lets the robot resume: a goal is due."""
        self.is_held, self.cancelled, self.replaced, self.goal_at = False, None, 0, now

    def go_on(self, halts: int, now: float) -> None:
        """Note that the doors of so many halts are open: the goal behind them is due."""
        self.halts, self.is_aboard, self.goal_at, self.attempts = self.halts[halts:], False, now, 0

    def passed(self, is_open: Callable[[Halt], bool]) -> int:
        """Return behind how many of its halts it may go on."""
        return next((count for count in range(len(self.halts), 0, -1) if is_open(self.halts[count - 1])), 0)

    @property
    def goal(self) -> Optional[Place]:
        """Return where it is sent now; None: nowhere."""
        return self.halts[0].place if self.halts else self.movement.place

    @property
    def arrives_at(self) -> Optional[Place]:
        """Return where it counts that it is there: its goal, but not in front of a door; None: nowhere."""
        waits = self.halts and (self.is_aboard or not self.halts[0].aboard)
        return None if waits else self.goal

    def describe(self, how: str, text: str = "") -> str:
        """Return what has become of it, as part of a sentence; `text` is move_base's own."""
        way = "on its way back to" if self.is_return else "on its way to"
        return f"{way} {marked(self.movement.place.poi)}: {how}" + (f": {quoted(text)}" if text else "")
