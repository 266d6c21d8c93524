"""What a recording holds, whatever kind of file it was: states, words, orders to robots, plans."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Iterator, Mapping, Optional, Tuple

from pursue_runtime.drives.report import Drive
from pursue_runtime.event_words import FINISH, Word, parse_report, parse_word
from pursue_runtime.state import SystemState


@dataclass(frozen=True)
class RecordedWord:
    """A word on pursue/events: when it was received (seconds), and the node that published it ("": not known).

    `seq`, `as_of` and `since` (there: `at`) are as in Word.
    """

    at: float
    text: str
    node: str = ""
    agent: str = ""
    event: str = ""
    seq: Optional[int] = None
    as_of: Optional[int] = None
    since: Optional[float] = None

    @property
    def moment(self) -> float:
        """Since when what the word says is true, as far as that is known (seconds)."""
        return self.at if self.since is None else min(self.since, self.at)


@dataclass(frozen=True)
class RobotOrder:
    """An order to a robot: a goal (x, y, z; None where it was not read) or an action, with the number of the state by
    which it was given (None: it has none).

    `location`: where the robot is meanwhile, `again`: its controller has been restarted since its last order, as far as
    that is known.
    """

    at: float
    robot: str
    node: str
    goal: Optional[Tuple[float, float, float]] = None
    action: str = ""
    seq: Optional[int] = None
    location: str = ""
    again: bool = False

    @property
    def is_goal(self) -> bool:
        """True for a goal, false for an action."""
        return not self.action


@dataclass(frozen=True)
class MissionRecord:
    """A recording: `states` by number (those of one number as they came), words and orders as they came.

    `plans` holds what was on pursue/plan by number, `game` the scenario and rules where the recording has them.
    `problems`: what could not be read of it, in sentences. `by_words`: a journal, which holds no states of its own and
    does not name the nodes that published its words. `drives`: those that were measured without a mission.
    `whole_from`: the moment (seconds) from which on it has everything, of a recorder that was started late.
    `received`: when the first state of each number was received: long after its stamp, where an observer that was away
    has shown later what had happened meanwhile. `exact_until`: of a simulation, which
    has everything, dated by one clock, the moment (seconds) at which it ended.
    """

    states: Tuple[SystemState, ...]
    words: Tuple[RecordedWord, ...] = ()
    orders: Tuple[RobotOrder, ...] = ()
    plans: Mapping[int, Mapping[str, Any]] = field(default_factory=dict)
    game: Optional[Mapping[str, Any]] = None
    problems: Tuple[str, ...] = ()
    by_words: bool = False
    drives: Tuple[Drive, ...] = ()
    whole_from: float = -math.inf
    received: Mapping[int, float] = field(default_factory=dict)
    exact_until: Optional[float] = None

    def known_from(self, state: SystemState) -> float:
        """Since when nodes may know of a state (seconds)."""
        return max(state.stamp, self.received.get(state.seq, state.stamp))

    @property
    def is_exact(self) -> bool:
        """True where it has everything, dated by one clock."""
        return self.exact_until is not None

    @property
    def is_late(self) -> bool:
        """True where the recorder was started, or started again, during the mission."""
        return self.states[0].seq > 1


def read_word(at: float, text: str, node: str = "") -> RecordedWord:
    """The word in a text; one without an event where it is none."""
    bare = text.strip()
    report = parse_report(bare)
    if report is not None:
        return RecordedWord(at, bare, node, report.agent, report.event, None, report.as_of, report.at)
    word = Word("", FINISH) if bare == FINISH else parse_word(bare) or Word("", "")
    return RecordedWord(at, bare, node, *word)


def ordered(states: Iterator[SystemState]) -> Tuple[SystemState, ...]:
    """The states by number: a bag has them in the order of their receipt."""
    return tuple(sorted(states, key=lambda state: state.seq))
