"""How many missions have been played, on one line of a terminal that is redrawn in place."""

from __future__ import annotations

import contextlib
import os
import sys
import time
from typing import Callable, Iterator

_REDRAW = 0.2
"""Seconds from one drawing to the next."""


@contextlib.contextmanager
def counting(all_: int, quiet: bool = False) -> Iterator[Callable[[int], None]]:
    """A listener for how many of all missions are done; its line on stderr is erased at the end, however that comes.

    Nothing is drawn if `quiet`, or where stderr is no terminal that can do it.
    """
    out = sys.stderr
    if quiet or os.environ.get("TERM", "dumb") == "dumb" or not out.isatty():
        yield lambda done: None
        return
    start = time.monotonic()
    drawn = [start]

    def update(done: int) -> None:
        now = time.monotonic()
        if now >= drawn[-1] + _REDRAW:
            drawn[:] = [now]
            pace = f", {60 * done / (now - start):,.0f} a minute" if done > 1 else ""
            out.write(f"\rsimulating: {done:,} of {all_:,} missions{pace}, {now - start:.0f} s\033[K")
            out.flush()

    try:
        yield update
    finally:
        if drawn != [start]:
            out.write("\r\033[K")
            out.flush()
