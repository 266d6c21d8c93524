"""Plays the uncontrollable agents: not at all, at random, or from a trace. Without ROS.

A trace is a YAML list; `at` counts time units since the start of the mission, `do` is a word for `pursue/events`:

    - {at: 3.5, do: thief_c2b}
    - {at: 30, do: thief_b2a}"""

from __future__ import annotations

import difflib
import math
import os
import random
from dataclasses import dataclass
from typing import Any, Collection, List, Optional, Sequence, Tuple

import yaml

from pursue_runtime.bounded import BadText, Bounds, node_value, yaml_tree
from pursue_runtime.locations import TO_BE_SAID
from pursue_runtime.model import Model
from pursue_runtime.named_files import read_text
from pursue_runtime.state import SystemState
from pursue_runtime.ui.mission_view import MARGIN, Environment, possible_words
from pursue_runtime.ui.options import Options

EXPECTED = "expected `- {at: <time units since the start>, do: <word>}`"
_BOUNDS = Bounds(size=2**24, depth=4, values=1_000_000)
"""Some 200,000 steps."""
CONTROL_WORDS = ("_ping_", "_stop_", "Finish!")


class TraceError(ValueError):
    """A trace that cannot be played; the message names the file, the line and what was expected."""


@dataclass(frozen=True)
class TraceStep:
    """At `at` time units since the start, publish `word`."""

    at: float
    word: str


def read_trace(text: str, file: str, words: Collection[str]) -> Tuple[TraceStep, ...]:
    """The steps of a trace, in order of time. `words` are those that the model knows.

    Raises TraceError, with every fault of the file in it.
    """
    try:
        root = yaml_tree(text, _BOUNDS)
    except BadText as error:
        raise TraceError(f"{file}:{error.line or 1}: {error.reason}; {EXPECTED}") from error
    if not isinstance(root, yaml.SequenceNode):
        raise TraceError(f"{file}:1: a trace is a list of steps: {EXPECTED}")
    steps: List[TraceStep] = []
    faults: List[str] = []
    for number, node in enumerate(root.value, start=1):
        try:
            step = _step(node_value(node), words)
            if steps and step.at < steps[-1].at:
                raise TraceError(f"at {step.at:g} comes after at {steps[-1].at:g}; expected the steps in order of time")
            steps.append(step)
        except ValueError as error:
            faults.append(f"{file}:{node.start_mark.line + 1}: step {number}: {error}")
    if faults:
        raise TraceError("\n".join(faults))
    return tuple(steps)


def _step(entry: Any, words: Collection[str]) -> TraceStep:
    if not isinstance(entry, dict) or set(entry) != {"at", "do"}:
        raise TraceError(f"{entry!r} is no step; {EXPECTED}")
    moment, word = entry["at"], entry["do"]
    if isinstance(moment, bool) or not isinstance(moment, (int, float)) or not math.isfinite(moment) or moment < 0:
        raise TraceError(f"at {moment!r} is no time; expected a number of time units, 0 or more")
    if not isinstance(word, str):
        raise TraceError(f"do {word!r} is no word; expected an event such as {min(words, default='_stop_')}")
    event = word.partition("@")[0].rpartition(":")[2]
    if event not in words and event not in CONTROL_WORDS:
        near = difflib.get_close_matches(event, sorted(words), n=1)
        hint = f"; did you mean {near[0]}?" if near else f"; expected one of {', '.join(sorted(words))}"
        raise TraceError(f"nobody in this scenario knows the event {word}{hint}")
    return TraceStep(float(moment), word)


MIN_PAUSE = 1.0  # time units after a word without effect until the next one
LATE = 1.0  # time units after which a step of a trace that a restart has missed is skipped


class RandomEnvironment:
    """Starts something possible at random moments, `pace` time units apart on average; the same for the same seed
    and the same states."""

    def __init__(self, model: Model, seed: int = 0, pace: float = 5.0) -> None:
        if not 0 < pace < float("inf"):
            raise ValueError(f"~pace is {pace:g}; expected a number of time units greater than 0")
        self._model = model
        self._random = random.Random(seed)
        self._pace = pace
        self._state: Optional[SystemState] = None
        self._plan: Optional[Tuple[float, str]] = None

    def on_state(self, state: SystemState, start: float, now: float) -> None:
        """Chooses anew: what was planned may not be possible any more. Waiting times have no memory, so nothing is
        delayed by that."""
        self._state = state
        self._choose(now, pause=0.0)

    def due(self, now: float) -> List[str]:
        """The planned word, when its moment has come."""
        if self._plan is None or now < self._plan[0] - 1e-6:
            return []
        word = self._plan[1]
        self._choose(now, pause=MIN_PAUSE)
        return [word]

    def next_moment(self) -> Optional[float]:
        """The planned moment."""
        return self._plan[0] if self._plan else None

    def _choose(self, now: float, pause: float) -> None:
        self._plan = None
        if self._state is None:
            return
        delay = pause + self._random.expovariate(1.0 / self._pace)
        able = possible_words(self._model, self._state, self._state.clocks_at(now))
        # What states are found to be, and where agents start, is said by the simulator.
        locations = self._state.locations
        offers = [offer for offer in able if locations[offer.agent] not in TO_BE_SAID]
        then = [offer for offer in offers if offer.opens <= delay and delay <= offer.closes - MARGIN]
        if then:
            self._plan = (now + delay * self._state.unit, self._random.choice(then).word)
            return
        later = [offer for offer in offers if offer.opens > delay]
        if later:
            first = min(later, key=lambda offer: offer.opens)
            self._plan = (now + first.opens * self._state.unit, first.word)


class TraceEnvironment:
    """Says the words of a trace at their moments, possible or not; without steps it does nothing."""

    def __init__(self, steps: Sequence[TraceStep]) -> None:
        self._steps = tuple(steps)
        self._unit = 1.0
        self._next = 0
        self._start: Optional[float] = None

    def on_state(self, state: SystemState, start: float, now: float) -> None:
        """The first state tells when the mission started; what a restart has missed is skipped."""
        if self._start is None:
            self._start, self._unit = start, state.unit
            while self._next < len(self._steps) and self._moment() < now - LATE * self._unit:
                self._next += 1

    def due(self, now: float) -> List[str]:
        """The words whose moments have come."""
        words = []
        while self._start is not None and self._next < len(self._steps) and self._moment() <= now + 1e-6:
            words.append(self._steps[self._next].word)
            self._next += 1
        return words

    def next_moment(self) -> Optional[float]:
        """The moment of the next step."""
        return self._moment() if self._start is not None and self._next < len(self._steps) else None

    def _moment(self) -> float:
        return (self._start or 0.0) + self._steps[self._next].at * self._unit


def make_player(options: Options, model: Model) -> Environment:
    """Return the player of the uncontrollable agents. Raises TraceError."""
    if options.mode == "random":
        return RandomEnvironment(model, options.seed, options.pace)
    if options.mode == "trace":
        words = {edge.word for automaton in model.automata for edge in automaton.edges if edge.sync != "receive"}
        try:
            text = read_text(options.trace)
            return TraceEnvironment(read_trace(text, options.trace, words))
        except (OSError, UnicodeDecodeError) as problem:
            raise TraceError(f"cannot read the trace {os.path.abspath(options.trace)}: {problem}") from problem
    return TraceEnvironment(())
