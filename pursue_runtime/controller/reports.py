"""A report of a robot to the observer: published again until the state shows it. `real` is the monotonic clock."""

from __future__ import annotations

from typing import Optional, Union

from pursue_runtime.event_words import RobotReport, Word, format_report, format_word
from pursue_runtime.resend import resend_timeout


class RepeatedReport:
    """A word that is published until it is confirmed. From the second time on it carries the time of the first."""

    def __init__(self, word: Union[Word, RobotReport], reaction: float = 0.0) -> None:
        """`reaction`: the seconds that the strategy allows a command, by which the word is sent again; 0: not known."""
        self.word = _text(word)
        self.confirmed = False
        self._word, self._reaction = word, reaction
        self._count, self._again = 0, 0.0

    def due(self, now: float, real: float) -> Optional[str]:
        """Return the word if it is to be published now (`now`: ROS time, in seconds)."""
        if self.confirmed or (self._count and real < self._again):
            return None
        text = _text(self._word)
        if not self._count:
            self._word = self._word._replace(at=now)
        self._count += 1
        self._again = real + resend_timeout(self._count, self._reaction)
        return text

    def next_moment(self) -> Optional[float]:
        """Return when to call `due` again, on the monotonic clock; None: not for this report."""
        return self._again if self._count and not self.confirmed else None

    def say_again(self) -> None:
        """Have the word published again at once: an observer has appeared."""
        self._again = 0.0


def _text(word: Union[Word, RobotReport]) -> str:
    return format_word(word) if isinstance(word, Word) else format_report(word)
