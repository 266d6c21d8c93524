"""The goal that a robot has: which answers are about it, whether it was taken, and when it is sent again.

Stamps are seconds of ROS time, `real` of the monotonic clock.
"""

from __future__ import annotations

import math
from collections import deque
from typing import Deque, FrozenSet, Iterable, List, NamedTuple, Optional, Tuple

from pursue_runtime.controller.settings import Settings
from pursue_runtime.controller.whereabouts import Place

PREEMPTED, SUCCEEDED, ABORTED, RECALLED = 2, 3, 4, 8
ACTIVE = (0, 1, 6, 7)
FAILURES = {ABORTED: "aborted", 5: "rejected", 9: "lost"}
CANCELLED = {PREEMPTED: "preempted", RECALLED: "recalled"}
OVER = (SUCCEEDED, *FAILURES, *CANCELLED)
"""Statuses of a goal, as actionlib_msgs/GoalStatus numbers them: in progress, failed, cancelled, over."""

FIRST_WAIT, LAST_WAIT = 1.0, 8.0
"""Seconds of real time without the goal in the robot's status after which it is sent again: at first, and at most."""


class Halt(NamedTuple):
    """Where a robot waits on its way until doors are open; `place` None: where it is. `aboard`: in the cabin of a lift,
    which goes on when it is told that the robot is there; `out`: where that is on the map of the floor where it gets
    out, if it is another one."""

    doors: FrozenSet[str]
    place: Optional[Place] = None
    aboard: bool = False
    out: Optional[Place] = None


class Movement(NamedTuple):
    """Where a robot is sent, and the location of the agent meanwhile; `spare`: where it may go at that place, too;
    `halts`: where it waits before that."""

    location: str
    place: Place
    spare: Optional[Place] = None
    halts: Tuple[Halt, ...] = ()


class Goal(NamedTuple):
    """A goal for a robot, with an id of our own, which only action goals carry."""

    name: str
    movement: Movement


class Answer(NamedTuple):
    """What move_base publishes about a goal, in a result or in its status: `text` is its own explanation, `outcome`
    the name of the code that a move_base_flex gives."""

    goal: str
    stamp: float
    status: int
    text: str = ""
    outcome: str = ""


class GoalTracker:
    """The present goal of one robot.

    An action goal has our id. A simple goal gets id and stamp from the robot, whose clock may be behind: the goal is
    recognized by its stamp, and by its id as soon as that is known.
    """

    def __init__(self, settings: Settings) -> None:
        self.current: Optional[Goal] = None
        self.is_lost = False  # the robot's status shows that it does not have the goal
        self.is_active = False  # the robot's status shows that the goal is in progress
        self._settings = settings
        self._sent = self._earliest = -math.inf  # when a goal was sent last; the earliest stamp that it may have
        self._sent_real = 0.0
        self._sends = self._repeats = 0  # how often the goal may still be answered; how often it was sent again
        self._id = ""  # the robot's id of a simple goal
        self._listed: FrozenSet[str] = frozenset()  # the ids in the newest status
        self._before: FrozenSet[str] = frozenset()  # those from before the goal
        self._missing: Optional[float] = None  # since when (real) the status is without the goal
        self._ours: Deque[str] = deque(maxlen=32)

    def send(self, goal: Goal, now: float, real: float) -> None:
        """Note that this goal is sent now."""
        self._note(now, real)
        self.current, self._sends, self._repeats = goal, 1, 0
        self._id, self._before = "", self._listed
        if self._settings.goals == "action":
            self._ours.append(goal.name)

    def send_again(self, now: float, real: float) -> Optional[Goal]:
        """Note that the present goal is sent once more, and return it; None where there is none."""
        self._note(now, real)
        self._id = ""
        self._sends, self._repeats = self._sends + 1, self._repeats + 1
        return self.current

    def drop(self) -> None:
        """Note that the goal does not matter any more."""
        self.current, self.is_lost, self.is_active, self._missing = None, False, False, None

    def ends(self, answer: Answer) -> bool:
        """Return True if the answer ends the present goal, which is then dropped."""
        if answer.status not in OVER or not self.concerns(answer):
            return False
        self._ours.append(answer.goal)
        if answer.status in CANCELLED and self._sends > 1 and self._settings.goals == "simple":
            self._sends, self._id = self._sends - 1, ""  # the same goal, sent again, has taken its place
            return False
        self.drop()
        return True

    def concerns(self, answer: Answer) -> bool:
        """Return True if the answer is about the present goal."""
        if self.current is None:
            return False
        if self._settings.goals == "action":
            return answer.goal == self.current.name
        if answer.goal and self._id:
            return answer.goal == self._id
        if answer.goal and (answer.goal in self._ours or answer.goal in self._before):
            return False
        return not answer.stamp or answer.stamp >= self._earliest  # who gives no stamp (a person) means now

    def on_status(self, answers: Iterable[Answer], real: float) -> List[Answer]:
        """Take the robot's status, and return what it says about the present goal."""
        entries = list(answers)
        self._listed = frozenset(answer.goal for answer in entries)
        if self.current is None:
            return []
        own = [answer for answer in entries if self.concerns(answer)]
        in_progress = [answer for answer in own if answer.status in ACTIVE]
        self.is_active = bool(in_progress)
        if in_progress and not self._id:
            self._id = max(in_progress, key=lambda answer: answer.stamp).goal
            self._ours.append(self._id)
        if in_progress and real >= self._sent_real + FIRST_WAIT:
            self._sends = 1  # whatever was sent before it has been answered
        is_unknown = self._settings.goals == "simple" and not self._id  # a clock may be off by more than `clock_skew`
        taken = own or (is_unknown and any(a.status in ACTIVE and a.goal not in self._before for a in entries))
        if taken:
            self._missing, self.is_lost = None, False
        elif self._missing is None:
            self._missing = max(real, self._sent_real)
        elif real >= max(self._missing, self._sent_real) + min(FIRST_WAIT * 2.0**self._repeats, LAST_WAIT):
            self.is_lost = True
        return own

    def others(self, answers: Iterable[Answer]) -> bool:
        """Return True if the status has a goal in progress that is not ours."""
        return any(answer.status in ACTIVE and answer.goal not in self._ours for answer in answers)

    def _note(self, now: float, real: float) -> None:
        # The goal before may still be answered (it is preempted by this one): an answer whose stamp is nearer to that
        # one is not taken for the answer to this.
        self._earliest = now - min(self._settings.clock_skew, (now - self._sent) / 2)
        self._sent, self._sent_real = now, real
        self.is_lost, self.is_active, self._missing = False, False, None
