"""What is simulated in one mission, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Mapping, Optional, Tuple

from pursue_gen.tools.simulation.duties import Duty
from pursue_runtime.sentences import in_words
from pursue_runtime.state import SystemState

GOAL, SAFE, HELD, FAILED = "goal", "safe", "held", "failed"
"""How missions end: goal reached; safe to the end; still holding at the end; and what must never be. Beside these
STOPPED, a safe stop, and LOST, because a fault broke what the strategy was promised."""


@dataclass(frozen=True)
class Settings:
    """What is simulated. `until`: the time units after which a mission is over; `span`: faults begin within so many;
    `bound`: how long it may take without faults (None: not known); `margin`: the delay of commands with which the
    strategy is known to win, in time units."""

    opponent: str = "mixed"
    faults: Tuple[str, ...] = ()
    until: float = 1000.0
    span: float = 50.0
    bound: Optional[float] = None
    margin: float = 0.0


@dataclass(frozen=True)
class Outcome:
    """How a mission ended, after so many time units.

    `lateness`: the longest time, in time units, for which a command was due; `cause`: which fault was too long for the
    strategy, if the mission was not won; `problems`: what must never be; `happened`: how often which fault did;
    `play`: what happened, a line for each event, where it was asked for; `duties`: as `Promises` has them;
    `driven`: how far each robot drove, in units of distance.
    """

    seed: int
    opponent: str
    end: str
    time: float
    reason: str
    steps: int
    plan: int
    off_model: int
    lateness: float = 0.0
    cause: str = ""
    problems: Tuple[str, ...] = ()
    happened: Mapping[str, int] = field(default_factory=dict)
    play: Tuple[str, ...] = ()
    duties: Tuple[Duty, ...] = ()
    driven: Mapping[str, float] = field(default_factory=dict)


def described(state: SystemState) -> str:
    """A state as a line of a play."""
    what = f"{state.event} by {state.agent}" if state.event else state.status
    more = f" ({state.status})" if state.event and state.status != "running" else ""
    return f"state {state.seq}: {what}{more}" + (f": {in_words(state.reason)}" if state.reason else "")
