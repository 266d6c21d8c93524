"""The high-water mark of a journal: how far the mission has come, in a small file beside it.

A journal that was cut at the end of a record looks whole; the mark shows that it is not. It is written after the
record and before the state is published: it may be behind the journal, and what was published is in both.
"""

from __future__ import annotations

import contextlib
import os
from typing import NamedTuple, Optional, Tuple

from pursue_runtime.observer.records import format_record, parse_record

MARK = ".mark"
"""What is added to the name of the journal."""

MAX_MARK = 4096
"""The most bytes of a mark: one page, which the system writes as a whole."""

Rank = Tuple[int, bool]
"""The order of the states of a mission: the number, and whether the mission has ended, which may have the number of
the state before."""


class Mark(NamedTuple):
    """`launch`, `mission`: those of the journal; `records`: how many it has, with the header; `seq`, `ended`: the
    newest state."""

    launch: str
    mission: str
    records: int
    seq: int
    ended: bool

    @property
    def rank(self) -> Rank:
        """The newest state."""
        return self.seq, self.ended


def read_mark(path: str) -> Optional[Mark]:
    """Return the mark in a file; None where there is none that can be read."""
    try:
        with open(path, "rb") as file:
            found = parse_record(file.readline(MAX_MARK))
        mark = Mark(**found[1]) if found else None
    except (OSError, TypeError):
        return None
    good = mark and all(isinstance(value, kind) for value, kind in zip(mark, (str, str, int, int, bool)))
    return mark if good else None


class MarkFile:
    """Writes the mark in place. `problem`: why it cannot be written any more; "" while it can."""

    def __init__(self, path: str, launch: str, mission: str) -> None:
        """Write nothing yet."""
        self.problem = ""
        self._path, self._launch, self._mission = path, launch, mission
        self._descriptor: Optional[int] = None
        self._written: Optional[Mark] = None

    def write(self, records: int, seq: int, ended: bool) -> None:
        """Write a mark, which outlives the process at once; a failure is a `problem`, and the mark stays behind."""
        mark = Mark(self._launch, self._mission, records, seq, ended)
        if self.problem or mark == self._written:
            return
        try:
            if self._descriptor is None:
                how = 0 if read_mark(self._path) else os.O_CREAT | os.O_EXCL  # another file of that name stays as it is
                self._descriptor = os.open(self._path, os.O_WRONLY | os.O_NOFOLLOW | how, 0o644)
            os.pwrite(self._descriptor, format_record(0, mark._asdict()), 0)
        except OSError as problem:
            self.problem = str(problem)
        self._written = mark

    def sync(self) -> None:
        """Return when the mark is on the disk, if it can be."""
        descriptor = self._descriptor
        if descriptor is not None:
            with contextlib.suppress(OSError):  # then a power cut leaves it behind
                os.fdatasync(descriptor)

    def remove(self) -> None:
        """Remove the mark: the journal that it is about is set aside."""
        if self._descriptor is not None:
            os.close(self._descriptor)
        self._descriptor = self._written = None
        self.problem = ""
        if read_mark(self._path):
            with contextlib.suppress(OSError):
                os.remove(self._path)
