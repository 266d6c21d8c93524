"""Whether the observer answers, as the UI sees it: within half a second where its process has ended."""

from __future__ import annotations

LOOK = 0.5
"""Seconds of real time between two looks at the connections with the observer."""

LOOKS = 8
"""Looks in a row without a new message after which the observer counts as silent: it publishes two messages a second,
and a busy machine delays some."""


class Presence:
    """Decides from looks at the connections with the observer whether it answers.

    The connections to a process that has ended are closed. Those to one that stands still, or to a machine that is off
    or cut off, stay open: then no message comes. Looks are counted, not seconds: a process that did not run itself for
    a while has looked once.
    """

    def __init__(self) -> None:
        self.answers = True
        self._count = -1
        self._still = 0

    def look(self, is_open: bool, count: int) -> bool:
        """Take whether a connection is open, and how many messages the connections have brought; return True if
        `answers` has changed. It answers again with the first message: rospy opens connections to find nobody there.
        """
        is_new = 0 < count != self._count
        self._still = 0 if is_new else self._still + 1
        self._count = count
        answers = is_open and (self._still < LOOKS if self.answers else is_new)
        changed = answers != self.answers
        self.answers = answers
        return changed
