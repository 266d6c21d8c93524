"""The life of a mission: which status may follow which, and on what condition, as a `transitions` machine.

One machine serves all missions of a process; a mission has its status and reason.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Callable, Dict, List

from transitions import Machine

from pursue_runtime.state import ENDED, HOLDING, LIVE, LOST, RUNNING, STATUSES, STOPPED, WAITING, WON

START, HOLD, GO_ON, WIN, LOSE, STOP, ADOPT = "start", "hold", "go_on", "win", "lose", "stop", "adopt"
"""The triggers. `adopt`: other nodes have seen that the mission has another status."""


def _is_seen(status: str, _: str, seen: str) -> bool:
    return seen == status


TRANSITIONS: List[Dict[str, Any]] = [
    {"trigger": START, "source": WAITING, "dest": RUNNING},
    {"trigger": HOLD, "source": list(LIVE), "dest": HOLDING, "conditions": "has_reason"},
    {"trigger": GO_ON, "source": list(LIVE), "dest": RUNNING},
    {"trigger": WIN, "source": list(LIVE), "dest": WON, "conditions": "is_goal_reached"},
    {"trigger": LOSE, "source": list(LIVE), "dest": LOST, "conditions": ["has_reason", "is_broken"]},
    {"trigger": STOP, "source": [WAITING, *LIVE], "dest": STOPPED, "conditions": "has_reason"},
    *(
        {"trigger": ADOPT, "source": list(STATUSES), "dest": status, "conditions": partial(_is_seen, status)}
        for status in (*LIVE, *ENDED)
    ),
]

_MACHINE = Machine(model=None, states=list(STATUSES), transitions=TRANSITIONS, initial=WAITING, auto_transitions=False)


class Life:
    """The status of a mission (`state`: the name that `transitions` has for it) and its reason."""

    def __init__(self, may_win: Callable[[], bool], is_broken: Callable[[], bool]) -> None:
        """Begin with a mission that waits. `may_win`: whether the goal is reached, or there is none to reach;
        `is_broken`: whether an objective is."""
        self.state, self.reason = WAITING, ""
        self._may_win, self._is_broken = may_win, is_broken

    def may(self, trigger: str) -> bool:
        """Return whether the trigger leads anywhere from the present status."""
        return self.state in _MACHINE.events[trigger].transitions

    def take(self, trigger: str, reason: str = "", seen: str = "") -> None:
        """Take a transition; `seen`: the status that is adopted.

        Raises transitions.MachineError where none of this trigger leaves the present status, and AssertionError where
        its condition does not hold.
        """
        event: Any = _MACHINE.events[trigger]  # its types are wrong
        if not event.trigger(self, reason, seen):
            raise AssertionError(f"a mission that is {self.state} cannot {trigger}: {reason or 'no reason'}")
        self.reason = reason

    def has_reason(self, reason: str, _: str) -> bool:
        """Return whether people will read why."""
        return bool(reason)

    def is_goal_reached(self, _: str, __: str) -> bool:
        """Return whether it may be called won."""
        return self._may_win()

    def is_broken(self, _: str, __: str) -> bool:
        """Return whether it may be called lost."""
        return self._is_broken()
