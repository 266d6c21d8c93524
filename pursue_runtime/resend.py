"""When a word that got no answer is published again."""

from __future__ import annotations

FIRST_TIMEOUT, LAST_TIMEOUT = 0.5, 4.0
"""Seconds of real time without an answer after which a word is published again: at first, and at most."""


def resend_timeout(sent: int) -> float:
    """Return the seconds of real time to wait for an answer to a word that was published `sent` times (at least 1)."""
    return min(FIRST_TIMEOUT * 2.0 ** (sent - 1), LAST_TIMEOUT)
