"""What guards the way of missions to a robot: whose orders count, and a log that strangers cannot fill. No ROS."""

from __future__ import annotations

import os
from typing import Callable, Dict, List, Optional, Tuple

from pursue_runtime.bundle import Keys, read_keys

Stamp = Tuple[Tuple[str, int, int, int], ...]


class KeyFolder:
    """The trusted keys in a folder, read again when its files change."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.problems: List[str] = []
        self._keys: Keys = {}
        self._stamp: Optional[Stamp] = None

    def keys(self) -> Keys:
        """Those of now, by fingerprint; `problems` says which files hold none."""
        stamp = self._scan()
        if stamp != self._stamp:
            try:
                self._keys, self.problems = read_keys(self.folder)
            except OSError as problem:
                self._keys, self.problems = {}, [f"cannot read {self.folder}: {problem.strerror}"]
            self._stamp = stamp  # last: another thread may ask meanwhile
        return self._keys

    def _scan(self) -> Stamp:
        try:
            with os.scandir(self.folder) as entries:
                found = [(entry.name, entry.stat()) for entry in entries if entry.name.endswith(".pub")]
        except OSError:
            return ()
        return tuple(sorted((name, facts.st_mtime_ns, facts.st_size, facts.st_ino) for name, facts in found))


class RateLimitedLog:
    """Counts what happens by word, and writes a line about it now and then: strangers cannot fill the log.

    `log(text)` writes; `period` is the least time in seconds between two lines.
    """

    def __init__(self, log: Callable[[str], None], period: float = 10.0) -> None:
        self._log = log
        self._period = period
        self._next = float("-inf")
        self._suppressed = 0
        self.counts: Dict[str, int] = {}

    def count(self, word: str, text: str, now: float) -> None:
        """One more of this, at this moment (seconds); `text` is logged unless something was just now."""
        self.counts[word] = self.counts.get(word, 0) + 1
        if now < self._next:
            self._suppressed += 1
            return
        more = f" (and {self._suppressed} more that are not in the log)" if self._suppressed else ""
        self._next, self._suppressed = now + self._period, 0
        self._log(text + more)
