"""What a state means to a node that plays a mission."""

from __future__ import annotations

import time
from typing import Callable, Optional

from pursue_runtime.state import ENDED, LATE, SystemState, older

OURS, OLD, OTHER, OVER = "ours", "old", "other", "over"


class StateFilter:
    """What a state is to a node that has the data of `mission`; `own` is the workspace's, which states need not name.

    OURS: of its mission. OLD: published before one that was heard. OTHER: of another mission, which it must not take
    for its own. OVER: the end of a mission that it was no part of, where it waits for the next one (`again`): whoever
    begins anew after the end may still hear the observer of then.

    Who says for a minute (LATE, on the real `clock`) nothing but what seems to be OLD is an observer whose clock was
    set back: then `anew` is True, and what was known before has nothing to do with what comes.
    """

    def __init__(
        self, mission: str, own: str, again: bool = False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.mission = mission
        self.newest: Optional[SystemState] = None  # the newest state, of whatever mission
        self.joined = False  # a state has been OURS
        self.clock_set_back = False  # the last state was the first one of an observer whose clock was set back
        self._own, self._again, self._clock = own, again, clock
        self._received = clock()  # when the known state was said, or said again

    def classify(self, state: SystemState) -> str:
        """OURS, OLD, OTHER or OVER."""
        known, now = self.newest, self._clock()
        old = known is not None and older(state, known)
        same = known is not None and (state.mission, state.seq) == (known.mission, known.seq)
        self.clock_set_back = old and not same and now >= self._received + LATE
        if same or not old or self.clock_set_back:
            self._received = now
        if old and not self.clock_set_back:
            return OLD
        self.newest = state
        if (state.mission or self._own) != self.mission:
            return OTHER
        if state.status in ENDED and self._again and not self.joined:
            return OVER
        self.joined = True
        return OURS
