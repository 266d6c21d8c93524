"""A report of a robot to the observer: published again until the state shows it. Times are of the monotonic clock."""

from __future__ import annotations

from typing import Optional

from pursue_runtime.resend import resend_timeout


class Report:
    """A word that is published until it is confirmed."""

    def __init__(self, word: str, reaction: float = 0.0) -> None:
        """`reaction`: the seconds that the strategy allows a command, by which the word is sent again; 0: not known."""
        self.word = word
        self._reaction = reaction
        self.confirmed = False
        self._count, self._published = 0, 0.0

    def due(self, real: float) -> Optional[str]:
        """Return the word if it is to be published now."""
        if self.confirmed or (self._count and real < self._again()):
            return None
        self._count, self._published = self._count + 1, real
        return self.word

    def next_moment(self) -> Optional[float]:
        """Return when to call `due` again; None: not for this report."""
        return self._again() if self._count and not self.confirmed else None

    def _again(self) -> float:
        return self._published + resend_timeout(self._count, self._reaction)
