"""Limits on time and memory that end any work, also work that does not check them itself."""

from __future__ import annotations

import signal
import threading
from contextlib import contextmanager
from typing import Iterator

from pursue_gen.synthesis.limits import SOLVING, Limits, Progress, limit_reached, memory_in_use

_INTERVAL = 0.1
"""Seconds of the clock between two looks. (With a timer, processor time comes in large ticks.) Not measured."""

_LATE, _LARGE = 0.3, 1.05
"""Seconds after the limit, and the part of the memory, where who checks the limits has not done so: it knows more.
Measured on a corridor with 20 robots."""


@contextmanager
def enforced(limits: Limits, phase: str = SOLVING) -> Iterator[None]:
    """Within this context LimitHit is raised at the limits, wherever the work is, and again as long as it goes on.

    Only in the main thread, as signals are handled there, and for seconds of processor time; else nothing happens. An
    inner context takes the place of an outer one.
    """
    none = limits.wall or not (limits.seconds or limits.memory)
    if none or threading.current_thread() is not threading.main_thread():
        yield
        return
    start, over = limits.now(), False

    def look(*_: object) -> None:
        seconds, memory = limits.now() - start, memory_in_use()
        late = bool(limits.seconds) and seconds > limits.left + _LATE
        if not over and (late or 0 < limits.memory * _LARGE < memory):
            which = "seconds" if late else "memory"
            raise limit_reached(which, limits, Progress(0, 0, seconds, memory, phase))

    before = signal.signal(signal.SIGALRM, look)
    timer = signal.setitimer(signal.ITIMER_REAL, _INTERVAL, _INTERVAL)
    try:
        try:
            yield
        finally:
            over = True
    finally:
        signal.setitimer(signal.ITIMER_REAL, *timer)
        # A signal that is on its way would end the process.
        signal.signal(signal.SIGALRM, signal.SIG_IGN if before in (None, signal.SIG_DFL) else before)
