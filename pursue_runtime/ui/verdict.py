"""How a mission ended, in a file for the program that launched it: a line with the outcome, a line that says why."""

from __future__ import annotations

import contextlib
import os
import signal
from typing import NamedTuple, Optional

from pursue_runtime.state import LOST, STOPPED, WON

NOT_STARTED, INTERRUPTED = "not started", "interrupted"
OUTCOMES = (WON, LOST, STOPPED, NOT_STARTED, INTERRUPTED)

ALONE = 128 + signal.SIGINT
"""The exit status of a UI that a signal has ended before the mission: if roslaunch does not end it, the signal was for
the UI alone, and again.sh starts it again."""


class Verdict(NamedTuple):
    """One of OUTCOMES, and a sentence."""

    outcome: str
    sentence: str


def write_verdict(path: str, verdict: Verdict) -> None:
    """Write the file completely or not at all; do nothing where the path is "". Raises OSError."""
    if not path:
        return
    new = f"{path}.{os.getpid()}.new"
    try:
        with open(new, "w", encoding="utf-8") as file:
            file.write(f"{verdict.outcome}\n{' '.join(verdict.sentence.split())}\n")
        os.replace(new, path)
    except OSError:
        with contextlib.suppress(OSError):
            os.unlink(new)
        raise


def read_verdict(path: str) -> Optional[Verdict]:
    """Return what the file holds; None where there is no such file, or it is none of ours."""
    try:
        with open(path, encoding="utf-8") as file:
            outcome, _, sentence = file.read().partition("\n")
    except (OSError, UnicodeDecodeError):
        return None
    return Verdict(outcome, sentence.strip()) if outcome in OUTCOMES else None


def drop_interrupted(path: str) -> None:
    """Remove a verdict that the mission was interrupted: it was the UI alone, which has been started again."""
    verdict = read_verdict(path)
    if verdict is not None and verdict.outcome == INTERRUPTED:
        with contextlib.suppress(OSError):
            os.unlink(path)
