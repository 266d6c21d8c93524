"""How many missions have been played: on one line of a terminal that is redrawn in place; elsewhere a line every ten
seconds. It goes on while one mission takes long, as where a new plan is looked for."""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
import time
from typing import Callable, Iterator

from pursue_gen.cli.progress import TerminalLine

_REDRAW, _INTERVAL = 0.5, 10.0
"""Seconds from one drawing to the next, and from one line to the next where nothing can be redrawn."""


@contextlib.contextmanager
def counting(all_: int, quiet: bool = False) -> Iterator[Callable[[int], None]]:
    """A listener for how many of all missions are done; its line on stderr is erased at the end, however that comes.

    Nothing is drawn if `quiet`.
    """
    if quiet:
        yield lambda done: None
        return
    line, start, known, over = TerminalLine(sys.stderr), time.monotonic(), [0], threading.Event()

    def draw() -> None:
        while not over.wait(_REDRAW if line.redrawn else _INTERVAL):
            line.show(_in_words(known[0], all_, time.monotonic() - start))

    drawer = threading.Thread(target=draw, daemon=True)
    # Else a Ctrl-C that the main thread has blocked, as where it starts processes, would come by way of this one.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        drawer.start()
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    try:
        yield lambda done: known.__setitem__(0, done)
    finally:
        over.set()
        drawer.join()
        line.erase()


def _in_words(done: int, all_: int, seconds: float) -> str:
    from pursue_gen.tools.simulation.planner import SEARCHES

    pace = f", {60 * done / seconds:,.0f} a minute" if done > 1 else ""
    what = ", a new plan is looked for" if SEARCHES.is_set() else ""
    return f"simulating: {done:,} of {all_:,} missions{pace}, {seconds:.0f} s{what}"
