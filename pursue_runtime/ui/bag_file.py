"""When a bag was recorded and how its mission ended, from a few parts of the file: bags may be large. Without ROS.

Format: wiki.ros.org/Bags/Format/2.0. The header says where the index is; the index has the times of each chunk. The
recorder does not compress chunks, so the texts on pursue/system_state stand in the file as they were published.
"""

from __future__ import annotations

import os
import re
import struct
from typing import Dict, Iterator, NamedTuple, Optional, Tuple

MAGIC = b"#ROSBAG V2.0\n"
HEAD = 4096 + len(MAGIC)  # bytes in which the first record stands
MOST_INDEX = 4 * 2**20  # bytes of an index that are read; that of a mission of an hour has less than one million
ENDS = 2**18  # bytes that are read of the first and of the last messages

_INDEX_POSITION, _CHUNK = b"index_pos", 6
_STATE = re.compile(
    rb"seq=(\d{1,9}) stamp=(\d{1,12}\.\d{6}) unit=([\d.e+-]{1,25})(?: \w+=[^ \n]{1,200})* status=(\w{3,10})"
)


class BadBag(ValueError):
    """The file is no bag, or not a whole one."""


class BagSummary(NamedTuple):
    """What is known of a recording: ROS times (seconds) of its first and last chunk; status of the last state, "" where
    none was found; when the mission began (ROS time), and its time units until then, None where no start was found.
    """

    first: float
    last: float
    status: str = ""
    began: Optional[float] = None
    units: Optional[float] = None


def read_summary(descriptor: int, size: int) -> BagSummary:
    """Return what is known of the bag in an open file of so many bytes. Raises BadBag, and OSError."""
    start = os.pread(descriptor, HEAD, 0)
    if not start.startswith(MAGIC):
        raise BadBag("it is no bag of format 2.0")
    fields, _ = next(_records(start[len(MAGIC):]), ({}, b""))
    position = _number("<Q", fields.get(_INDEX_POSITION, b""))
    if position == 0:
        raise BadBag("its recorder did not close it")
    if not HEAD <= position < size:
        raise BadBag("its index is not where its first record says")
    times = []
    for fields, _ in _records(os.pread(descriptor, MOST_INDEX, position)):
        if fields.get(b"op") == bytes([_CHUNK]):
            times += [_time(fields.get(name, b"")) for name in (b"start_time", b"end_time")]
    if not times:
        raise BadBag("its index is empty or damaged")
    states = list(_states(os.pread(descriptor, ENDS, max(0, position - ENDS))))
    starts = (stamp for seq, stamp, _, _ in _states(os.pread(descriptor, min(ENDS, position), 0)) if seq == 1)
    began = next(starts, None)
    _, stamp, unit, status = states[-1] if states else (0, 0.0, 1.0, "")
    units = (stamp - began) / unit if began is not None and states else None
    return BagSummary(min(times), max(times), status, began, units)


def _records(content: bytes) -> Iterator[Tuple[Dict[bytes, bytes], bytes]]:
    """The records in these bytes: the fields of their headers, and their data. Ends at the first that is not whole."""
    at = 0
    while at + 4 <= len(content):
        length = _number("<L", content[at:at + 4])
        head = content[at + 4:at + 4 + length]
        at += 4 + length
        size = _number("<L", content[at:at + 4]) if at + 4 <= len(content) else 0
        if len(head) < length or at + 4 > len(content):
            return
        yield _fields(head), content[at + 4:at + 4 + size]
        at += 4 + size


def _fields(head: bytes) -> Dict[bytes, bytes]:
    fields: Dict[bytes, bytes] = {}
    at = 0
    while at + 4 <= len(head):
        length = _number("<L", head[at:at + 4])
        name, equals, value = head[at + 4:at + 4 + length].partition(b"=")
        if not equals:
            return fields
        fields[name] = value
        at += 4 + length
    return fields


def _number(form: str, content: bytes) -> int:
    """The number in these bytes. Raises BadBag where there are more or fewer."""
    try:
        return int(struct.unpack(form, content)[0])
    except struct.error as problem:
        raise BadBag("a number in it is damaged") from problem


def _time(content: bytes) -> float:
    try:
        seconds, nanoseconds = struct.unpack("<LL", content)
    except struct.error as problem:
        raise BadBag("a time in its index is damaged") from problem
    return float(seconds) + float(nanoseconds) / 1e9


def _states(content: bytes) -> Iterator[Tuple[int, float, float, str]]:
    """Number, stamp (seconds), seconds per time unit and status of the states whose texts stand in these bytes."""
    for seq, stamp, unit, status in _STATE.findall(content):
        try:
            seconds = float(unit)
        except ValueError:
            continue
        if 1e-9 < seconds < 1e9:
            yield int(seq), float(stamp), seconds, status.decode()
