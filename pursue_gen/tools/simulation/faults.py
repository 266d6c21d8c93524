"""What may go wrong in a simulated mission, by name, and what goes wrong in one mission, drawn from its seed.

Times are in seconds where they belong to messages and nodes, in time units where they belong to the model; a simulated
time unit lasts one second.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import PursueError, error
from pursue_runtime.event_words import parse_word
from pursue_runtime.observer.assumptions import without
from pursue_runtime.observer.mission import Mission

FAULTS: Mapping[str, str] = {
    "delay": "one message in 10 is late by up to 5 s, and those behind it on the same connection wait",
    "loss": "one message in 20 is lost",
    "duplicates": "one message in 10 comes twice, the second up to 2 s later",
    "reorder": "one message in 10 is overtaken by those sent up to 2 s after it",
    "orders": "one order in 20 finds its robot disconnected, which gets it 0.5 to 2 s later",
    "clocks": "the clock of each controller is wrong by up to 0.5 s, either way",
    "deaths": "up to three times a controller or the observer dies, and is started again after 0.3 to 3 s",
    "restart": "once a controller or the observer dies, and is back within the margin of the strategy, and 3 s",
    "cut": "the machine of a controller and its robot is cut off for 1 to 60 s; what was sent comes later",
    "early": "one movement or action in 5 ends before the model's window, by up to half of its least duration",
    "late": "one movement or action in 5 ends 0.2 to 15 time units after the model's window",
    "failed": "a robot reports during a movement or action that it cannot finish it; half finish it 1 to 40 later",
    "silent": "a robot reports nothing more, from some time during a movement or action on",
    "junk": "up to ten words on pursue/events that mean nothing, are impossible, or are commands for earlier states",
}
"""Every kind of fault, and its parameters."""

RATES: Mapping[str, float] = {"delay": 0.1, "loss": 0.05, "duplicates": 0.1, "reorder": 0.1, "orders": 0.05}
"""How often these happen; `loss=0.2` in the place of `loss` sets another probability."""

LATE = 15.0
"""Time units by which who is late is so at most; `late=60` in the place of `late` sets another number. Not
measured."""

_LEAST = 0.2
"""Time units by which who is late is so at least. Not measured."""

HARMLESS = ("duplicates", "junk")
"""Faults that delay no agent: missions in which nothing else goes wrong are won as if nothing did."""


def read_faults(text: str) -> Tuple[str, ...]:
    """The kinds of faults of `--faults`: names with commas between them, `all`, `none`. A name in RATES may have a
    probability, as in `loss=0.2`, and `late` time units, as in `late=60`. Raises PursueError."""
    names = [name.strip() for name in text.split(",") if name.strip()]
    if names == ["none"] or not names:
        return ()
    if names == ["all"]:
        return tuple(FAULTS)
    wrong = [name for name in names if "=" in name and _rate(name) is None]
    if wrong:
        hint = f"a probability from 0 to 1 for {', '.join(RATES)}, such as loss=0.2; time units for late: late=60"
        raise PursueError([error("SIM002", f"{', '.join(wrong)} is no fault with such a number", hint=hint)])
    kinds = {name.partition("=")[0]: name for name in names}
    unknown = [name for name in kinds if name not in FAULTS]
    if unknown:
        hint = f"names with commas between them: {', '.join(FAULTS)}; or all, or none"
        raise PursueError([error("SIM002", f"there are no faults called {', '.join(unknown)}", hint=hint)])
    return tuple(kinds[name] for name in FAULTS if name in kinds)


def _rate(text: str) -> Optional[float]:
    """The probability in `loss=0.2`, the time units in `late=60`; None if there are none."""
    name, _, number = text.partition("=")
    try:
        rate = float(number)
    except ValueError:
        return None
    if name == "late":
        return rate if _LEAST <= rate < math.inf else None
    return rate if name in RATES and 0.0 <= rate <= 1.0 else None


@dataclass(frozen=True)
class Crash:
    """A node dies at the moment and is started again after so many seconds."""

    moment: float
    node: str
    seconds: float
    kind: str = "deaths"


@dataclass(frozen=True)
class Breakdown:
    """The robot's `number`-th activity goes wrong after `share` of its least duration; `back`: it ends so much later
    than that (time units), None: never. `reported`: it reports the failure."""

    robot: str
    number: int
    share: float
    reported: bool
    back: Optional[float] = None


class FaultPlan:
    """The faults of one mission: which kinds there are in it, and each case, drawn one after the other."""

    def __init__(self, kinds: Sequence[str], seed: str, start: float, span: float, controllers: Sequence[str],
                 robots: Sequence[str], absence: float = 0.0) -> None:
        """`start`: when the mission starts; `span`: the seconds after that in which faults begin that have a moment;
        `absence`: the seconds for which a node may be absent within the margin of the strategy.

        With one kind, the mission has it; of several, each with probability 1/2, but one at least.
        """
        self._draw = draw = random.Random(f"{seed}/faults")
        given = {text.partition("=")[0]: _rate(text) or 0.0 for text in kinds if "=" in text}
        self._rates = {**RATES, "late": LATE, **given}
        kinds = [text.partition("=")[0] for text in kinds]
        self._absence = absence
        chosen = [kind for kind in kinds if len(kinds) == 1 or draw.random() < 0.5]
        self.kinds: FrozenSet[str] = frozenset(chosen or ([draw.choice(list(kinds))] if kinds else []))
        self.happened: Dict[str, int] = {}
        self.offsets = dict.fromkeys(controllers, 0.0)
        if "clocks" in self.kinds:
            self.offsets = {name: self._count("clocks", draw.uniform(-0.5, 0.5)) for name in controllers}
        self.crashes = self._draw_crashes(start, span, controllers) + self._draw_restart(start, span, controllers)
        self.cut: Optional[Tuple[str, float, float]] = None
        if "cut" in self.kinds and controllers:
            begin = start + draw.uniform(0.0, span)
            self.cut = draw.choice(list(controllers)), begin, begin + draw.uniform(1.0, 60.0)
        self.breakdown = self._breakdown(robots)
        junk = draw.randint(1, 10) if "junk" in self.kinds else 0
        self.junk: List[float] = sorted(start + draw.uniform(0.0, span) for _ in range(junk))

    @property
    def voids_guarantees(self) -> bool:
        """True once something has gone wrong that breaks what the strategy was promised."""
        return any(kind not in HARMLESS for kind in self.happened)

    @property
    def offset(self) -> float:
        """By how much a clock may be wrong, in seconds."""
        return 0.5 if "clocks" in self.kinds else 0.0

    def is_lost(self) -> bool:
        """Is this message lost?"""
        return self._chance("loss", self._rates["loss"])

    def delay(self) -> float:
        """Seconds by which this message is late, and holds up those behind it."""
        return self._draw.uniform(0.0, 5.0) if self._chance("delay", self._rates["delay"]) else 0.0

    def reorder_delay(self) -> float:
        """Seconds by which this message, and no other, is late."""
        return self._draw.uniform(0.0, 2.0) if self._chance("reorder", self._rates["reorder"]) else 0.0

    def disconnection(self, least: float, most: float) -> float:
        """Seconds after which this order reaches its robot."""
        return self._draw.uniform(least, most) if self._chance("orders", self._rates["orders"]) else 0.0

    def duplicate_delay(self) -> Optional[float]:
        """Seconds after which this message comes again."""
        return self._draw.uniform(0.0, 2.0) if self._chance("duplicates", self._rates["duplicates"]) else None

    def duration(self, low: float, high: float, usual: float) -> float:
        """How long an activity with this window takes, in time units, where it would have taken the usual time."""
        if self._chance("late", 0.2):
            return high + self._draw.uniform(_LEAST, self._rates["late"])
        if self._chance("early", 0.2):
            return low * self._draw.uniform(0.5, 1.0)
        return usual

    def count(self, kind: str) -> None:
        """A fault has happened that was drawn at the start."""
        self.happened[kind] = self.happened.get(kind, 0) + 1

    def _count(self, kind: str, value: float) -> float:
        self.count(kind)
        return value

    def _chance(self, kind: str, probability: float) -> bool:
        if kind not in self.kinds or self._draw.random() >= probability:
            return False
        self.count(kind)
        return True

    def _draw_crashes(self, start: float, span: float, controllers: Sequence[str]) -> List[Crash]:
        if "deaths" not in self.kinds:
            return []
        nodes = ["observer", *controllers]
        draw = self._draw
        moments = [start + draw.uniform(0.0, span) for _ in range(draw.randint(1, 3))]
        return [Crash(moment, draw.choice(nodes), draw.uniform(0.3, 3.0)) for moment in moments]

    def _draw_restart(self, start: float, span: float, controllers: Sequence[str]) -> List[Crash]:
        longest = min(self._absence, 3.0)
        if "restart" not in self.kinds or longest <= 0:
            return []
        draw = self._draw
        moment = start + draw.uniform(0.0, span)
        return [Crash(moment, draw.choice(["observer", *controllers]), draw.uniform(0.2, 1.0) * longest, "restart")]

    def _breakdown(self, robots: Sequence[str]) -> Optional[Breakdown]:
        kinds = sorted(self.kinds & {"failed", "silent"})
        if not kinds or not robots:
            return None
        draw = self._draw
        reported = draw.choice(kinds) == "failed"
        back = draw.uniform(1.0, 40.0) if reported and draw.random() < 0.5 else None
        return Breakdown(draw.choice(list(robots)), draw.randint(1, 3), draw.random(), reported, back)


JUNK = ("", "\u2603", "bot1 goes", "_start_", "_ping_", "unknown:nothing@3", "_plan_@1", "@@", ":_failed_", "x" * 3000)
"""Words that mean nothing in any state of a mission that is under way."""


def junk_word(
    draw: random.Random, mission: Mission, published: Sequence[str], now: float, is_returning: bool
) -> Optional[str]:
    """One of JUNK, a command for another state (of those that were `published`), or what cannot happen now; None where
    the one that is drawn may be meant. While the observer `is_returning`, nobody knows what can happen."""
    words = [*JUNK, *(text for text in published if not text.endswith(f"@{mission.seq}"))]
    if not is_returning:
        model, here = mission.model, mission.position(now)
        possible = {*model.possible(here, timed=False), *model.possible(without(here, model.assumptions), timed=False)}
        words += [e.word for a in model.automata for e in a.edges if e.word not in possible]
    text = draw.choice(words)
    word = parse_word(text)
    return None if word is not None and word.seq == mission.seq else text
