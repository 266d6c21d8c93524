"""A log for events that clients can cause: counted all, logged now and then."""

from __future__ import annotations

import time
from typing import Callable, Dict, Optional


class RateLimitedLog:
    """Counts events by kind, and logs at most one line per `period` seconds: no client can fill the log.

    `log(text)` writes a line, `clock()` returns seconds.
    """

    def __init__(
        self, log: Callable[[str], None], clock: Callable[[], float] = time.monotonic, period: float = 10.0
    ) -> None:
        self._log, self._clock, self._period = log, clock, period
        self._next = float("-inf")
        self._suppressed = 0
        self.counts: Dict[str, int] = {}

    def count(self, kind: str, text: str = "", now: Optional[float] = None) -> None:
        """Count an event of this kind, `now` or at the time of the clock; `text`, if given, is logged unless a line was
        logged just before."""
        self.counts[kind] = self.counts.get(kind, 0) + 1
        if not text:
            return
        now = self._clock() if now is None else now
        if now < self._next:
            self._suppressed += 1
            return
        more = f" (and {self._suppressed} more that were not logged)" if self._suppressed else ""
        self._next, self._suppressed = now + self._period, 0
        self._log(text + more)
