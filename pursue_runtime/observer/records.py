"""A file of records that only grows, and its high-water mark: the journal of a mission, and how far it has come.

A record is one line, `<checksum> <number> <length> <JSON object>`. The number counts the records of the file from 0;
the length is that of the JSON text in bytes; the checksum (CRC-32, eight hexadecimal digits) is that of everything
behind it in the line. So a record that is damaged, missing or in the wrong place is found, and never taken for another
one.

A journal that was cut at the end of a record looks whole; the mark, in a small file beside it, shows that it is not. It
is written after the record and before the state is published: it may be behind the journal, and what was published is
in both.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import zlib
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from pursue_runtime.bounded import DATA, Bounds, read_json
from pursue_runtime.folders import sync_folder
from pursue_runtime.numbers import whole

FORMAT = 2
"""The format of journals that have such records. Format 1 had the JSON objects alone."""

MAX_RECORD = 64 * 1024 * 1024
"""The most bytes of a line. A new plan is the largest record."""

BOUNDS = Bounds(MAX_RECORD, DATA.depth + 2, DATA.values + 10)
"""What a record may hold: a call whose argument is data that was read within bounds."""

Record = Dict[str, Any]


class RecordsRead(NamedTuple):
    """What is in a file: the records up to the first one that is damaged, and the bytes that they take.

    `damage`: why these are not all that was written; "" where at most a last record is incomplete, as a kill or a
    power cut leaves it.
    """

    records: List[Record]
    size: int
    damage: str = ""


def format_record(number: int, record: Mapping[str, Any]) -> bytes:
    """Return the line of a record. Raises OSError if it is longer than MAX_RECORD."""
    text = json.dumps(record).encode()
    covered = b"%d %d %s" % (number, len(text), text)
    line = b"%08x %s\n" % (zlib.crc32(covered), covered)
    if len(line) > MAX_RECORD:
        raise OSError(errno.EFBIG, f"a record of {len(line)} bytes is longer than {MAX_RECORD}")
    return line


def parse_record(line: bytes) -> Optional[Tuple[int, Record]]:
    """Return number and content of a line (with its line feed); None for a line that format_record has not written."""
    checksum, _, covered = line[:-1].partition(b" ")
    if not line.endswith(b"\n") or checksum != b"%08x" % zlib.crc32(covered):
        return None
    number, _, text = covered.partition(b" ")
    length, _, text = text.partition(b" ")
    try:
        complete, record = whole(length.decode()) == len(text), read_json(text, BOUNDS)
        return (whole(number.decode()), record) if complete and isinstance(record, dict) else None
    except ValueError:
        return None


def read_records(path: str) -> RecordsRead:
    """Read a file of records, line by line. Raises OSError."""
    records: List[Record] = []
    size, bad = 0, False
    with open(path, "rb") as file:
        for line in iter(lambda: file.readline(MAX_RECORD), b""):
            found = parse_record(line)
            if found is None:
                bad = True
            elif bad or found[0] != len(records):
                what = "is damaged" if bad else "is missing"
                return RecordsRead(records, size, f"record {len(records)} {what}, and later ones are there")
            else:
                records.append(found[1])
                size += len(line)
    if not records:
        return RecordsRead([], 0, "its first line cannot be read" if bad else "it is empty")
    return RecordsRead(records, size)


class RecordFile:
    """Appends records to a file. Each is one write: it outlives the process at once, and a power cut once it is synced.

    `count`: the records in it.
    """

    def __init__(self, descriptor: int, count: int, size: int) -> None:
        """Use `create` or `resume`."""
        self.count = count
        self._descriptor, self._size = descriptor, size

    @classmethod
    def create(
        cls, path: str, records: Sequence[Mapping[str, Any]], make_room: Callable[[], object] = lambda: None
    ) -> RecordFile:
        """Create the file with these records, completely or not at all, and synced. Raises OSError.

        `make_room` is called when it is certain that the records can be written: for what has the name until then.
        """
        new = path + ".new"
        content = b"".join(format_record(number, record) for number, record in enumerate(records))
        descriptor = os.open(new, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_TRUNC, 0o644)
        try:
            write_all(descriptor, content)
            os.fsync(descriptor)
            make_room()
            os.rename(new, path)
            sync_folder(os.path.dirname(path))
        except OSError:
            os.close(descriptor)
            raise
        return cls(descriptor, len(records), len(content))

    @classmethod
    def resume(cls, path: str, found: RecordsRead) -> RecordFile:
        """Open the file to append to the records that were found; an incomplete one is cut off. Raises OSError."""
        descriptor = os.open(path, os.O_WRONLY | os.O_APPEND)
        try:
            os.ftruncate(descriptor, found.size)
            os.fsync(descriptor)
        except OSError:
            os.close(descriptor)
            raise
        return cls(descriptor, len(found.records), found.size)

    def append(self, record: Mapping[str, Any]) -> None:
        """Write a record. Raises OSError, also where only a part of it was written."""
        line = format_record(self.count, record)
        write_all(self._descriptor, line)
        self.count += 1
        self._size += len(line)

    def sync(self) -> None:
        """Return when everything that was written is on the disk. Raises OSError."""
        os.fdatasync(self._descriptor)

    def cut(self) -> None:
        """Cut off what was written of a record that could not be written completely. Raises OSError."""
        os.ftruncate(self._descriptor, self._size)


def write_all(descriptor: int, content: bytes) -> None:
    """Write in one call. Raises OSError, also where only a part was written."""
    written = os.write(descriptor, content)
    if written != len(content):
        raise OSError(errno.ENOSPC, f"only {written} of {len(content)} bytes could be written")


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
