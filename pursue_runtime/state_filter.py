"""Which received states count for a node: those of its mission, in order of publication."""

from __future__ import annotations

import time
from typing import Callable, Optional

from pursue_runtime.state import ENDED, LATE, SystemState, older

OURS, OLD, OTHER, OVER = "ours", "old", "other", "over"


class StateFilter:
    """Classifies received states for a node that has the data of `mission`.

    `own` is the id of the workspace's mission, which states need not name. Classes: OURS, a state of the node's
    mission; OLD, published before the newest one received; OTHER, of another mission; OVER, the end of a mission in
    which the node took no part, while it waits for the next one (`again`): a node that restarts after the end may
    still receive the latched state of that mission.

    Where only OLD states arrive for a minute (LATE, on the real `clock`), the observer's clock was set back: then
    `clock_set_back` is True, the state counts, and earlier states do not.
    """

    def __init__(
        self, mission: str, own: str, again: bool = False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.mission = mission
        self.newest: Optional[SystemState] = None  # the newest state, of any mission
        self.joined = False  # a state has been OURS
        self.clock_set_back = False  # the last state was the first one of an observer whose clock was set back
        self._own, self._again, self._clock = own, again, clock
        self._received = clock()  # when the newest state was published, or published again

    def classify(self, state: SystemState) -> str:
        """Return OURS, OLD, OTHER or OVER, and keep the state if it is the newest."""
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
