"""Traces: what the agents that nobody controls do, and when. Without ROS.

A trace is a YAML list; `at` counts time units since the start of the mission, `do` is a word for `pursue/events`:

    - {at: 3.5, do: thief_c2b}
    - {at: 30, do: thief_b2a}
"""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass
from typing import Any, Collection, List, Tuple

import yaml

from pursue_runtime.bounded import BadText, Bounds, node_value, yaml_tree

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
