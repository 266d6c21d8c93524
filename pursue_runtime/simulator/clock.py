"""Simulated time of a mission that runs faster than real time.

Simulated time goes in small steps, never catches up after a delay of the machine, and stands still for a moment after
every message: so what the nodes do in answer to a message takes (nearly) no simulated time, however busy the machine.
A clock that was killed goes on where it was: it keeps its time in a file.
"""

from __future__ import annotations

import contextlib
import os
import socket
from dataclasses import dataclass
from typing import Any, Mapping, Optional

from pursue_runtime.parameters import number

START = 1.0  # seconds; 0 means "no time yet" to rospy
HOLD_PERIOD = 0.05  # real seconds between two messages of a clock that holds
MAX_FILES = 20  # so many files of clocks are kept in a folder


@dataclass(frozen=True)
class Pace:
    """How the clock goes: `speed` simulated seconds per real one, in steps of `step` simulated seconds at most.

    After a message the clock holds for `hold` real seconds.
    """

    speed: float = 5.0
    step: float = 0.02
    hold: float = 0.1


def read_pace(given: Mapping[str, Any]) -> Pace:
    """The pace that these parameters of the node give; a step is 0.02 time units by default. Raises ParameterError."""
    step = 0.02 * number(given, "time_unit", 1.0, above=True)
    speed, hold = number(given, "speed", Pace.speed, above=True), number(given, "hold", Pace.hold)
    return Pace(speed, number(given, "step", step, above=True), hold)


class SimClock:
    """Simulated time, moved on by `tick`.

    Until the first word of the mission it goes no faster than real time: nodes come up, and need the processor.
    `has_begun`: the mission may be under way already.
    """

    def __init__(self, pace: Pace, start: float = START, has_begun: bool = False) -> None:
        self._pace = pace
        self._start = start
        self._has_begun = has_begun
        self._steps = 0
        self._held_until = self._published = float("-inf")

    @property
    def now(self) -> float:
        """Simulated seconds."""
        return self._start + self._steps * self._pace.step

    @property
    def period(self) -> float:
        """Real seconds between two steps."""
        return self._pace.step / (self._pace.speed if self._has_begun else min(1.0, self._pace.speed))

    def on_word(self, real: float) -> None:
        """Begin to go at the full speed, and hold, as for any message: a word was received at the time `real`."""
        self._has_begun = True
        self.on_message(real)

    def on_message(self, real: float) -> None:
        """Hold the clock: a message was received at the time `real` of the monotonic clock."""
        self._held_until = max(self._held_until, real + self._pace.hold)

    def tick(self, real: float) -> float:
        """One step on, unless the clock holds; the simulated time."""
        if real >= self._held_until:
            self._steps += 1
        return self.now

    def message(self, real: float) -> Optional[float]:
        """One step on, unless the clock holds; the simulated time to publish, None where that was published lately.

        A clock that holds is published on, but seldom: a node that comes late, or that missed a message, has the time.
        """
        before = self.now
        if self.tick(real) == before and real < self._published + HOLD_PERIOD:
            return None
        self._published = real
        return self.now


def send_whole(there: socket.socket, data: bytes) -> bool:
    """Sends a short message at once and whole; False, with nothing sent, where the other side does not read.

    Raises OSError where the connection is closed.
    """
    try:
        sent = there.send(data, socket.MSG_DONTWAIT)
    except BlockingIOError:
        return False
    there.sendall(data[sent:])  # the system takes so few bytes at once, or none
    return True


class ClockFile:
    """The last time that was published, in a file that outlives a kill (not a failure of the machine).

    `last`: what the file held, None where there is none yet. Raises OSError where the file cannot be written.
    """

    def __init__(self, path: str) -> None:
        folder = os.path.dirname(path)
        os.makedirs(folder, exist_ok=True)
        self._file = os.open(path, os.O_RDWR | os.O_CREAT, 0o644)
        self.last: Optional[float] = None
        with contextlib.suppress(ValueError):  # empty: it is new
            self.last = float(os.pread(self._file, 64, 0))
        clocks = sorted((entry for entry in os.scandir(folder) if entry.name.startswith("clock-")), key=_changed)
        for entry in clocks[:-MAX_FILES]:
            with contextlib.suppress(OSError):
                os.remove(entry.path)

    def save(self, moment: float) -> None:
        """Writes the time down, in one piece and always as long. Raises OSError."""
        os.pwrite(self._file, b"%030.9f\n" % moment, 0)


def _changed(entry: "os.DirEntry[str]") -> float:
    try:
        return entry.stat().st_mtime
    except OSError:
        return 0.0  # another process has removed it
