"""Which received states count for a node: those of its mission, in order of publication."""

from __future__ import annotations

import time
from typing import Callable, Optional

from pursue_runtime.state import ENDED, LATE, WAITING, SystemState, older, rewinds

OURS, OLD, OTHER, OVER, REFUSED = "ours", "old", "other", "over", "refused"


class StateFilter:
    """Classifies received states for a node that has the data of `mission`.

    `own` is the id of the workspace's mission, which states need not name. Classes: OURS, a state of the node's
    mission; OLD, published before the newest one received; OTHER, of another mission; OVER, the end of a mission in
    which the node took no part, while it waits for the next one (`again`): a node that restarts after the end may
    still receive the latched state of that mission; REFUSED, one to which the mission cannot have come from the newest
    one, or that is none of this mission (`check` returns why, "" otherwise): nothing is changed, and `refused` says
    why until another state counts.

    Where only OLD states arrive for a minute (LATE, on the real `clock`), the observer's clock was set back: then
    `clock_set_back` is True, the state counts, and earlier states do not. The same holds where the observer waits for
    the start of a mission for a minute, and this node knows of one under way: it was cut off when that one ended. Had
    the observer lost a mission, it would have stopped when it learned what this node has seen.
    """

    def __init__(
        self, mission: str, own: str, again: bool = False, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self.mission = mission
        self.newest: Optional[SystemState] = None  # the newest state, of any mission
        self.joined = False  # a state has been OURS
        self.clock_set_back = False  # the last state was the first one of an observer whose clock was set back
        self.refused = ""
        self.malformed = 0  # messages that were no states
        self.check: Callable[[SystemState], str] = lambda _: ""
        self._own, self._again, self._clock = own, again, clock
        self._received = clock()  # when the newest state was published, or published again

    def count_malformed(self) -> None:
        """Count a message that was no state."""
        self.malformed += 1

    def classify(self, state: SystemState) -> str:
        """Return the class of the state, and keep it if it is the newest."""
        ours = (state.mission or self._own) == self.mission
        problem = self.check(state) if ours else ""
        if problem:
            self.refused = f"a state of another model: {problem}"
            return REFUSED
        known, now = self.newest, self._clock()
        old = known is not None and older(state, known)
        rewound = known is not None and not old and rewinds(state, known)
        same = known is not None and not rewound and (state.mission, state.seq) == (known.mission, known.seq)
        late = now >= self._received + LATE and (old or state.status == WAITING)
        self.clock_set_back = (old or rewound) and not same and late
        if known is not None and rewound and not late:
            self.refused = f"state {state.seq}, after state {known.seq} of the same mission: the observer has lost it"
            return REFUSED
        if same or not old or self.clock_set_back:
            self._received = now
        if old and not self.clock_set_back:
            return OLD
        self.newest, self.refused = state, ""
        if not ours:
            return OTHER
        if state.status in ENDED and self._again and not self.joined:
            return OVER
        self.joined = True
        return OURS
