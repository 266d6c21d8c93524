"""Bags of ROS 1 (format 2.0), read from front to back without ROS and without their index.

So a bag that was never closed, or that is cut off, is read as far as it goes.

Format: wiki.ros.org/Bags/Format/2.0. Records are `header length, header, data length, data`; a header is a list of
`length, name=value`. Chunks hold the records of connections and messages, and may be compressed.
"""

from __future__ import annotations

import bz2
import struct
from dataclasses import dataclass
from typing import Dict, Iterator, List, Tuple

MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _BAG, _CHUNK, _CHUNK_INFO, _CONNECTION = 2, 3, 5, 6, 7
_LARGEST_HEADER = 1 << 20


@dataclass(frozen=True)
class Message:
    """A message as it was sent: `at` in seconds, `node` its publisher ("": not recorded)."""

    topic: str
    kind: str
    node: str
    at: float
    data: bytes


class Damage(Exception):
    """The bytes are not those of a bag; the message says which."""


def read_bag(content: bytes) -> Tuple[List[Message], List[str]]:
    """The messages in the order in which they stand, and what could not be read, in sentences."""
    if not content.startswith(MAGIC):
        raise Damage(f"it does not begin with {MAGIC.decode().strip()}")
    reader = _Reader()
    reader.run(content, len(MAGIC), "")
    if not 0 < reader.index <= len(content) and not reader.problems:
        reader.problems.append("the bag was not closed: its last messages may be missing")
    elif reader.listed < reader.chunks and not reader.problems:
        reader.problems.append(f"the bag ends within its index: it lists {reader.listed} of {reader.chunks} chunks")
    if reader.strangers:
        reader.problems.append(f"{reader.strangers} messages of connections that it does not describe were skipped")
    return reader.messages, reader.problems


class _Reader:
    def __init__(self) -> None:
        self.messages: List[Message] = []
        self.problems: List[str] = []
        self.index = 0  # where the index stands, which is written when a bag is closed
        self.chunks = 0  # how many the bag has, which is written with it
        self.listed = 0  # how many of them the index describes; their descriptions are the last records of a bag
        self.strangers = 0
        self._connections: Dict[int, Tuple[str, str, str]] = {}

    def run(self, content: bytes, start: int, where: str) -> None:
        """All records from there on; the first damage ends it, and is a problem."""
        try:
            for header, data in _records(content, start):
                self._record(header, data)
        except Damage as damage:
            self.problems.append(f"{where}{damage}; what follows was not read")

    def _record(self, header: Dict[str, bytes], data: bytes) -> None:
        kind = header.get("op", b"")[:1]
        if kind == bytes((_BAG,)):
            self.index, self.chunks = _integer(header, "index_pos", 8), _integer(header, "chunk_count", 4)
        elif kind == bytes((_CHUNK_INFO,)):
            self.listed += 1
        elif kind == bytes((_CHUNK,)):
            # One that was never closed has no length, and its records follow as if there were no chunk.
            self._chunk(header.get("compression", b"none").decode("ascii", "replace"), data)
        elif kind == bytes((_CONNECTION,)):
            about = dict(_fields(data))
            topic = _decoded(header, "topic") or _decoded(about, "topic")
            node = _decoded(about, "callerid").strip("/")
            self._connections[_integer(header, "conn", 4)] = topic, _decoded(about, "type"), node
        elif kind == bytes((_MESSAGE,)):
            connection = self._connections.get(_integer(header, "conn", 4))
            seconds, nanoseconds = struct.unpack("<LL", _field(header, "time", 8))
            if connection is None:
                self.strangers += 1
            else:
                self.messages.append(Message(*connection, seconds + nanoseconds / 1e9, data))

    def _chunk(self, compression: str, data: bytes) -> None:
        try:
            content = decompressed(compression, data)
        except Damage as damage:
            self.problems.append(f"a chunk cannot be unpacked ({damage}), its messages are missing")
            return
        self.run(content, 0, "in a chunk: ")


def decompressed(compression: str, data: bytes) -> bytes:
    """What is in a chunk, as far as it goes. Raises Damage."""
    if compression == "none" or not data:
        return data
    try:
        if compression == "bz2":
            return bz2.BZ2Decompressor().decompress(data)
        if compression == "lz4":
            return _lz4(data)
    except (OSError, ValueError, RuntimeError, EOFError) as problem:
        raise Damage(str(problem)) from None
    raise Damage(f"its compression is {compression[:20]!r}; expected none, bz2 or lz4")


def _lz4(data: bytes) -> bytes:
    try:
        import lz4.frame
    except ImportError:
        raise Damage("lz4 needs the Python package lz4: pip install 'pursue-gen[bags]'") from None
    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data))


def _records(content: bytes, place: int) -> Iterator[Tuple[Dict[str, bytes], bytes]]:
    """The records in order; the data of the last one may be cut. Raises Damage at what is no record."""
    while place < len(content):
        header, after = _sized(content, place, "the head of a record")
        if len(header) > _LARGEST_HEADER:
            raise Damage(f"the head of a record at byte {place} is too large")
        fields = dict(_fields(header))
        if len(fields.get("op", b"")) != 1:
            raise Damage(f"no record begins at byte {place}")
        if fields["op"] == bytes((_CHUNK,)) and after + 4 <= len(content):
            # What there is of a chunk that is cut off can still be read.
            (length,) = struct.unpack_from("<L", content, after)
            yield fields, content[after + 4 : after + 4 + length]
            if after + 4 + length > len(content):
                raise Damage(f"the file ends in a chunk, at byte {len(content)}")
            place = after + 4 + length
        else:
            data, place = _sized(content, after, "a record")
            yield fields, data


def _sized(content: bytes, place: int, what: str) -> Tuple[bytes, int]:
    """The bytes of a length that stands before them, and the place after them. Raises Damage."""
    end = place + 4
    if end <= len(content):
        end += struct.unpack_from("<L", content, place)[0]
        if end <= len(content):
            return content[place + 4 : end], end
    raise Damage(f"the file ends in {what}, at byte {len(content)}")


def _fields(header: bytes) -> Iterator[Tuple[str, bytes]]:
    place = 0
    while place < len(header):
        field, place = _sized(header, place, "a field")
        name, _, value = field.partition(b"=")
        yield name.decode("ascii", "replace"), value


def _decoded(header: Dict[str, bytes], name: str) -> str:
    return header.get(name, b"").decode("utf-8", "replace")


def _field(header: Dict[str, bytes], name: str, size: int) -> bytes:
    value = header.get(name, b"")
    if len(value) != size:
        raise Damage(f"a record has no {name}")
    return value


def _integer(header: Dict[str, bytes], name: str, size: int) -> int:
    return int.from_bytes(_field(header, name, size), "little")
