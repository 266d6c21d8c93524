"""Limits on the time, memory and work of a search, its progress, and the error at a limit."""

from __future__ import annotations

import resource
import sys
import time
from dataclasses import dataclass, replace
from typing import Callable, Iterator, Optional

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import LimitHit
from pursue_gen.zones.dbm import look_after

CAREFUL = 1024
"""MiB that the commands allow themselves by default, if the machine has them. Not measured."""

DEFAULT_SECONDS = 60.0
"""Seconds of processor time that the commands allow themselves by default. Not measured."""

_FRESH = 128
"""MiB that a process of ours has at most before it works on anything. Not measured."""

_SHARE = 0.8
"""The part of the available memory that may be taken; the machine has to go on. Not measured."""

_CHECK_INTERVAL, _REPORT_INTERVAL = 0.05, 0.2
"""Seconds from one check of the memory to the next, and from one report to the next. Not measured."""


@dataclass(frozen=True)
class Limits:
    """Seconds, MiB of the whole process, discrete states of an engine, its work; 0: no limit.

    The seconds are of processor time, which does not pass while others have the processor; `wall`: of the clock, where
    somebody waits who acts on what is found. `spent`: so many of them are used up already. `by_default`: nobody has set
    them; they only see to it that a command ends, so what has a budget of work keeps to that alone (see `chosen`).
    `work` counts the steps of an engine and the pairs of zones that it combines, so it is the same on every machine.
    The checker counts symbolic states, with a limit of its own.
    """

    seconds: float = 0.0
    memory: int = 0
    spent: float = 0.0
    states: int = 0
    work: int = 0
    by_default: bool = False
    wall: bool = False

    @property
    def chosen(self) -> Limits:
        """Without seconds that nobody has set."""
        return replace(self, seconds=0.0, spent=0.0, by_default=False) if self.by_default else self

    @property
    def left(self) -> float:
        """The seconds that are left, more than 0 even if none are; 0: no limit."""
        return max(self.seconds - self.spent, 1e-9) if self.seconds else 0.0

    def now(self) -> float:
        """Now, in seconds on the clock that theirs are of."""
        return time.monotonic() if self.wall else processor_time()

    def since(self, start: float) -> Limits:
        """What is left of them after work that began at `start` (of `now`)."""
        return replace(self, spent=self.spent + self.now() - start)


@dataclass(frozen=True)
class Progress:
    """States reached (the checker's: symbolic ones), those that wait to be explored, seconds, MiB of the process."""

    states: int
    waiting: int
    seconds: float
    memory: int
    phase: str = "solving"


Listener = Callable[[Progress], None]
"""Called with the progress a few times a second."""

SOLVING, PROVING, EXPLAINING = "solving", "proving", "explaining"
UNDECIDED = "SYN010"
"""The code of the error at a limit."""

NOTHING_YET = Progress(0, 0, 0.0, 0)
NO_LIMITS = Limits()


class LimitMonitor:
    """Checks the limits between the steps of a search, and reports its progress to the listener.

    As a context it also does so within the work on zones of this thread.
    """

    def __init__(self, limits: Limits = NO_LIMITS, listener: Optional[Listener] = None, phase: str = SOLVING) -> None:
        self._limits, self._listener, self._phase = limits, listener, phase
        self._start = limits.now()
        self._next_check = self._next_report = 0.0
        self._states = self._waiting = 0
        self._reached = NOTHING_YET
        self._outer: Optional[Callable[[], None]] = None
        self.work = 0

    def __enter__(self) -> LimitMonitor:
        self._outer = look_after(self.look)
        return self

    def __exit__(self, *_: object) -> None:
        look_after(self._outer)

    def check(self, states: int, waiting: int, work: int = 1) -> None:
        """Raises PursueError (exit status 5) at a limit; `work` is what was done since the last check."""
        self.work += work
        self._states, self._waiting = states, waiting
        if 0 < self._limits.work < self.work:
            raise self._stopped_now("work")
        self.look()

    def look(self) -> None:
        """The same for seconds and memory alone, from within a step."""
        seconds = self._limits.now() - self._start
        late = 0 < self._limits.left < seconds
        if seconds < self._next_check and not late:
            return
        self._next_check = seconds + _CHECK_INTERVAL
        self._reached = Progress(self._states, self._waiting, seconds, memory_in_use(), self._phase)
        if late:
            raise self.stopped("seconds")
        if 0 < self._limits.memory < self._reached.memory:
            raise self.stopped("memory")
        if self._listener is not None and seconds >= self._next_report:
            self._next_report = seconds + _REPORT_INTERVAL
            self._listener(self._reached)

    def _stopped_now(self, which: str) -> LimitHit:
        seconds = self._limits.now() - self._start
        self._reached = Progress(self._states, self._waiting, seconds, memory_in_use(), self._phase)
        return self.stopped(which)

    def stopped(self, which: str) -> LimitHit:
        """What to raise where this limit ended the search, see `limit_reached`."""
        return limit_reached(which, self._limits, self._reached)


def limit_reached(which: str, limits: Limits, reached: Progress) -> LimitHit:
    """The error at a limit: which one ("seconds", "memory", "states" or "work"), how far the work was, what to do."""
    proving = reached.phase == PROVING
    shown = {
        "seconds": f"{limits.seconds:g} seconds{'' if limits.wall else ' of processor time'}",
        "memory": f"{limits.memory} MiB of memory",
        "states": f"{limits.states} discrete states",
        "work": f"{limits.work} units of work",
    }
    where = f"within the limit of {shown[which]}"
    hint = "make the scenario smaller: fewer agents, POIs or events"
    if which == "memory" and not limits.memory:
        where = "with the memory that there is"
    else:
        options = {"seconds": " (--limit SECONDS, --limit none)", "memory": " (--memory), if the machine has more"}
        hint = f"allow more{options.get(which, '')}, or {hint}"
    far = f"{reached.states} {'symbolic' if proving else 'discrete'} states were reached, {reached.waiting} waiting"
    if proving:
        hint = f"there is a strategy, but only what is proven is used; {hint}"
    message = f"no {'proof' if proving else 'verdict'} {where}; {far}, {reached.memory} MiB in use"
    problem = LimitHit([error(UNDECIDED, message, hint=hint)])
    problem.which = which
    return problem


def memory_in_use() -> int:
    """MiB of this process in memory; where the system does not report it, the most that it was so far."""
    try:
        # As bytes: a signal may ask while Python is loading the codec.
        with open("/proc/self/statm", "rb") as file:
            return int(file.read().split()[1]) * resource.getpagesize() >> 20
    except (OSError, ValueError, IndexError):
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss >> (20 if sys.platform == "darwin" else 10)


def processor_time() -> float:
    """Seconds that this process has worked, with all of its threads and the processes that it has waited for."""
    others = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + others.ru_utime + others.ru_stime


def careful_memory() -> int:
    """The default limit on memory (MiB): a GiB, and never all that the machine has left.

    What this process (an editor's, a notebook's) holds of earlier work does not count.
    """
    earlier = max(0, memory_in_use() - _FRESH)
    return max(1, min([CAREFUL + earlier, *(int(_SHARE * size) for size in _available())]))


def _available() -> Iterator[int]:
    """MiB that this process may come to have: of what the machine has free, and of what a container is given."""
    try:
        with open("/proc/meminfo", encoding="ascii") as file:
            sizes = dict(line.split(":", 1) for line in file if ":" in line)
        yield (int(sizes["MemAvailable"].split()[0]) >> 10) + memory_in_use()
    except (OSError, ValueError, KeyError, IndexError):
        pass
    for name in ("memory.max", "memory/memory.limit_in_bytes"):
        try:
            with open(f"/sys/fs/cgroup/{name}", encoding="ascii") as file:
                yield int(file.read()) >> 20
        except (OSError, ValueError):  # not in a container, or "max"
            pass
