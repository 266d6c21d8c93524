"""Bags of any size: what is not wanted is skipped, and no chunk unpacks to more than is taken of one."""

from __future__ import annotations

import bz2
import io
import struct
import tracemalloc
from typing import Callable, Dict

import pytest

from pursue_gen.tools.replay import bag as reader
from pursue_gen.tools.replay.bag import LARGEST_RECORD, MAGIC, Bag, read_bag


def record(data: bytes, **fields: bytes) -> bytes:
    """A record of a bag."""
    parts = (name.encode() + b"=" + value for name, value in fields.items())
    head = b"".join(struct.pack("<L", len(part)) + part for part in parts)
    return struct.pack("<L", len(head)) + head + struct.pack("<L", len(data)) + data


def connection(number: int, topic: str) -> bytes:
    conn = struct.pack("<L", number)
    about = b"".join(struct.pack("<L", len(part)) + part for part in (b"type=std_msgs/String", b"callerid=/node"))
    return record(about, op=b"\x07", conn=conn, topic=topic.encode())


def message(number: int, data: bytes) -> bytes:
    return record(data, op=b"\x02", conn=struct.pack("<L", number), time=struct.pack("<LL", 7, 0))


def chunk(content: bytes, compression: str = "none") -> bytes:
    packed = bz2.compress(content) if compression == "bz2" else content
    return record(packed, op=b"\x05", compression=compression.encode(), size=struct.pack("<L", len(content)))


def bag(*parts: bytes, chunks: int = 0) -> bytes:
    """A bag that was closed, with no descriptions of chunks unless there are chunks."""
    head = record(b" " * 20, op=b"\x03", index_pos=struct.pack("<Q", 20), chunk_count=struct.pack("<L", chunks))
    return MAGIC + head + b"".join(parts)


def read(content: bytes, wanted: Callable[[str], bool] = lambda topic: topic == "/ours") -> Bag:
    return read_bag(io.BytesIO(content), wanted)


def peak(content: bytes) -> int:
    """The most bytes that were allocated while it was read."""
    tracemalloc.start()
    try:
        read(content)
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_what_is_not_wanted_is_skipped() -> None:
    images = [message(2, bytes(1 << 20)) for _ in range(40)]
    content = bag(connection(1, "/ours"), connection(2, "/camera"), *images, message(1, b"a"), chunk(message(1, b"b")))
    found = read(content)
    assert [each.data for each in found.messages] == [b"a", b"b"]
    assert (found.topics, found.problems) == (("/camera", "/ours"), ())
    assert peak(content) < 10 << 20


def test_a_chunk_that_unpacks_to_gigabytes_is_a_problem_and_takes_little_memory() -> None:
    bomb = chunk(connection(1, "/ours") + message(1, bytes(400 << 20)), "bz2")
    content = bag(bomb, connection(1, "/ours"), message(1, b"after"))
    assert len(content) < 10_000
    found = read(content)
    assert [each.data for each in found.messages] == [b"after"]
    assert found.problems == ("a chunk cannot be unpacked (it unpacks to more than 64 MiB), its messages are missing",)
    assert peak(content) < 4 * LARGEST_RECORD


LIMITS: Dict[str, bytes] = {
    "MOST_KEPT": bag(connection(1, "/ours"), *[message(1, bytes(1000)) for _ in range(100)]),
    "MOST_TIMES": bag(*[chunk(connection(1, "/ours") + message(1, bytes(100_000)), "bz2") for _ in range(100)]),
}


@pytest.mark.parametrize("limit", LIMITS)
def test_no_more_is_kept_or_unpacked_than_the_limits_say(monkeypatch: pytest.MonkeyPatch, limit: str) -> None:
    assert len(read(LIMITS[limit]).messages) == 100
    monkeypatch.setattr(reader, "MOST_KEPT", 50_000 if limit == "MOST_KEPT" else 1 << 20)
    monkeypatch.setattr(reader, "MOST_TIMES", 10)
    monkeypatch.setattr(reader, "LARGEST_RECORD", 1 << 20)
    found = read(LIMITS[limit])
    assert len(found.messages) < 60
    (problem,) = found.problems
    assert problem.endswith("what follows was not read")


def test_chunks_do_not_hold_chunks() -> None:
    content = b""
    for _ in range(5000):
        content = record(content, op=b"\x05", compression=b"none", size=struct.pack("<L", len(content)))
    (problem,) = read(bag(content)).problems
    assert problem.startswith("in a chunk: a chunk begins within a chunk")


def test_many_damaged_chunks_are_not_all_told_of() -> None:
    damaged = record(b"junk", op=b"\x05", compression=b"bz2", size=struct.pack("<L", 4))
    assert 1 <= len(read(bag(damaged * 1000)).problems) <= 20
