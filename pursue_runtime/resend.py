"""When a word that got no answer, a report that no state shows, or a new state, is published again. Times are seconds
of real time, where they are not said to be those of ROS."""

from __future__ import annotations

from typing import Optional, Union

from pursue_runtime.event_words import RobotReport, Word, format_report, format_word
from pursue_runtime.state import SystemState

FIRST_TIMEOUT, LAST_TIMEOUT = 0.5, 4.0
"""Where no reaction is known: the time after which a word without an answer is published again, at first, at most."""

REPEATS = 3
"""So many messages in a row may be lost on the way of one command, and it still takes effect within the reaction."""

PATIENCE = 20
"""After so many words without an answer, the next ones come with LAST_TIMEOUT between them."""

SHORTEST = 0.01
"""The least interval between two resends: an answer takes some milliseconds."""


def resend_interval(reaction: float) -> float:
    """Return the interval of the first resends if the strategy allows a command `reaction` seconds (0: not known).

    REPEATS intervals take three fifths of the reaction, the rest is for the messages' way.
    """
    return min(max(reaction / (REPEATS + 2), SHORTEST), FIRST_TIMEOUT) if reaction > 0 else FIRST_TIMEOUT


def resend_timeout(sent: int, reaction: float = 0.0) -> float:
    """Return how long to wait for an answer to a word that was published `sent` times (at least 1).

    The first REPEATS resends lie within the reaction; the timeouts then grow to twice the reaction, so that a node that
    was absent gets the word soon after its return. `reaction` as for `resend_interval`.
    """
    if reaction <= 0:
        return min(FIRST_TIMEOUT * 2.0 ** (sent - 1), LAST_TIMEOUT)
    if sent > PATIENCE:
        return LAST_TIMEOUT
    first = resend_interval(reaction)
    return min(first * 2.0 ** max(0, sent - REPEATS), max(first, 2 * reaction), LAST_TIMEOUT)


class StateRepeats:
    """Publishes each new state REPEATS times more, as it was published last, until there is a newer one.

    A node that missed the state gets it within the reaction; for all others it is the state that they have.
    """

    def __init__(self, reaction: float) -> None:
        """`reaction` as for `resend_interval`."""
        self._interval = resend_interval(reaction)
        self._state: Optional[SystemState] = None
        self._left = 0
        self._next = 0.0

    def on_publish(self, state: SystemState, now: float) -> None:
        """Take that a state was published; a heartbeat is no new one."""
        known = self._state
        if known is None or (known.seq, known.status) != (state.seq, state.status):
            self._left, self._next = REPEATS, now + self._interval
        self._state = state  # under its number: orders may be acknowledged meanwhile

    def due(self, now: float) -> Optional[SystemState]:
        """Return the state to publish again now, if any."""
        if not self._left or now < self._next:
            return None
        self._left, self._next = self._left - 1, now + self._interval
        return self._state

    def next_moment(self) -> Optional[float]:
        """Return when to call `due` again; None: not before the next state."""
        return self._next if self._left else None


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
