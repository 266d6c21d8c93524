"""Events at moments: the earliest is next, and those of one moment come in the order in which they were set."""

from __future__ import annotations

import heapq
from typing import Callable, List, Optional, Tuple

Action = Callable[[], object]


class EventQueue:
    """The time of one simulated mission, in seconds; it leaps from event to event."""

    def __init__(self, now: float) -> None:
        self.now = now
        self._heap: List[Tuple[float, int, Action]] = []
        self._set = 0

    def schedule(self, moment: float, act: Action) -> None:
        """Does it at this moment; at once (after what is set for now) where the moment is past."""
        self._set += 1
        heapq.heappush(self._heap, (max(moment, self.now), self._set, act))

    def step(self) -> bool:
        """Does what comes next; False where nothing will ever happen again."""
        if not self._heap:
            return False
        self.now, _, act = heapq.heappop(self._heap)
        act()
        return True

    def next_time(self) -> Optional[float]:
        """The moment of what comes next."""
        return self._heap[0][0] if self._heap else None


class Timer:
    """Does one thing at a moment that may be set anew; the last setting counts."""

    def __init__(self, events: EventQueue, act: Action) -> None:
        self._events, self._act = events, act
        self._version = 0
        self._moment: Optional[float] = None

    def set(self, *moments: Optional[float]) -> None:
        """Rings at the first of these moments; with none of them, never."""
        moment = min((moment for moment in moments if moment is not None), default=None)
        if moment == self._moment and moment is not None:
            return
        self._version += 1
        self._moment = moment
        if moment is not None:
            version = self._version
            self._events.schedule(moment, lambda: self._ring(version))

    def _ring(self, version: int) -> None:
        if version == self._version:
            self._moment = None
            self._act()
