"""What a recording holds, whatever kind of file it was: states, words, what robots were told, plans.

The texts are read here once more, apart from the nodes' own reader of them: what checks them shares nothing with them.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, Iterator, Mapping, Optional, Tuple

WAITING, RUNNING, HOLDING, WON, LOST, STOPPED = "waiting", "running", "holding", "won", "lost", "stopped"
ENDED = (WON, LOST, STOPPED)
START, PING, STOP, FINISH = "_start_", "_ping_", "_stop_", "Finish!"
PLANNED, FAILED = "_plan_", "_failed_"


@dataclass(frozen=True)
class RecordedState:
    """One published state: `stamp` in seconds of ROS time, clocks in time units of `unit` seconds."""

    seq: int
    stamp: float
    locations: Mapping[str, str]
    values: Mapping[str, int]
    clocks: Mapping[str, float]
    unit: float = 1.0
    plan: int = 0
    event: str = ""
    agent: str = ""
    lost: Tuple[str, ...] = ()
    status: str = RUNNING
    reason: str = ""

    def same_place(self, other: RecordedState) -> bool:
        """True where everybody is where they are in the other, whatever the clocks."""
        return self.locations == other.locations and self.values == other.values


@dataclass(frozen=True)
class RecordedWord:
    """A word on pursue/events: when it was heard (seconds), by which node it was said ("": not known)."""

    at: float
    text: str
    node: str = ""
    agent: str = ""
    event: str = ""
    seq: Optional[int] = None


@dataclass(frozen=True)
class RobotOrder:
    """What a robot was told: a goal (x, y, z, or None where it was not read) or an action."""

    at: float
    robot: str
    node: str
    goal: Optional[Tuple[float, float, float]] = None
    action: str = ""

    @property
    def is_goal(self) -> bool:
        """True for a goal, false for an action."""
        return not self.action


@dataclass(frozen=True)
class MissionRecord:
    """A recording: `states` by number (those of one number as they came), words and orders as they came.

    `plans` holds what was on pursue/plan by number, `game` the scenario and rules where the recording has them.
    `problems`: what could not be read of it, in sentences. `by_words`: a journal, which holds no states of its own and
    does not say who said what.
    """

    states: Tuple[RecordedState, ...]
    words: Tuple[RecordedWord, ...] = ()
    orders: Tuple[RobotOrder, ...] = ()
    plans: Mapping[int, Mapping[str, Any]] = field(default_factory=dict)
    game: Optional[Mapping[str, Any]] = None
    problems: Tuple[str, ...] = ()
    by_words: bool = False


_WORD = re.compile(r"(?:(\w+):)?([\w!]+?)[!?]?(?:@(\d{1,18}))?", re.ASCII)
_INTEGER = re.compile(r"-?\d{1,18}", re.ASCII)
_DECIMAL = re.compile(r"-?\d{1,18}(\.\d{1,30})?", re.ASCII)


def read_word(at: float, text: str, node: str = "") -> RecordedWord:
    """The word in a text; one without an event where it is none."""
    bare = text.strip()
    if bare == FINISH:
        return RecordedWord(at, bare, node, event=FINISH)
    match = _WORD.fullmatch(bare)
    if match is None:
        return RecordedWord(at, bare, node)
    agent, event, seq = match.groups()
    return RecordedWord(at, bare, node, agent or "", event, None if seq is None else int(seq))


def read_state(text: str) -> Optional[RecordedState]:
    """The state in a text; None where it is none."""
    discrete, _, continuous = text.strip().partition("\n\n")
    head, _, discrete = discrete.partition("\n")
    head, _, reason = head.partition(" reason=")
    facts = dict(part.split("=", 1) for part in head.split() if "=" in part)
    try:
        seq, stamp, unit = int(facts["seq"]), _number(facts["stamp"]), _number(facts.get("unit", "1"))
        plan = int(facts.get("plan", "0"))
    except (KeyError, ValueError):
        return None
    if unit <= 0 or seq < 0:
        return None
    pairs = dict(_pairs(discrete))
    return RecordedState(
        seq=seq,
        stamp=stamp,
        locations={name: value for name, value in pairs.items() if not _INTEGER.fullmatch(value)},
        values={name: int(value) for name, value in pairs.items() if _INTEGER.fullmatch(value)},
        clocks={name: float(value) for name, value in _pairs(continuous) if _DECIMAL.fullmatch(value)},
        unit=unit,
        plan=plan,
        event=facts.get("event", ""),
        agent=facts.get("agent", ""),
        lost=tuple(name for name in facts.get("lost", "").split(",") if name),
        status=facts.get("status", RUNNING),
        reason=reason,
    )


def _number(text: str) -> float:
    """A finite number. Raises ValueError."""
    value = float(text)
    if not abs(value) < 1e15:
        raise ValueError(text)
    return value


def _pairs(text: str) -> Iterator[Tuple[str, str]]:
    for line in text.splitlines():
        name, equals, value = line.strip().partition("=")
        if equals and name and value:
            yield name, value


def ordered(states: Iterator[RecordedState]) -> Tuple[RecordedState, ...]:
    """The states by number: a bag has them in the order of their receipt."""
    return tuple(sorted(states, key=lambda state: state.seq))

