"""Bags of ROS 1 (format 2.0), read from front to back without ROS and without their index.

So a bag that was never closed, or that is cut off, is read as far as it goes. What is not of the wanted topics is
skipped, so a bag takes the memory of what is wanted of it, and of one compressed chunk.

Format: wiki.ros.org/Bags/Format/2.0. Records are `header length, header, data length, data`; a header is a list of
`length, name=value`. Chunks hold the records of connections and messages, and may be compressed.
"""

from __future__ import annotations

import bz2
import io
import struct
from dataclasses import dataclass
from typing import BinaryIO, Callable, Dict, Iterator, List, Optional, Tuple

MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _BAG, _CHUNK, _CHUNK_INFO, _CONNECTION = 2, 3, 5, 6, 7
_LARGEST_HEADER = 1 << 20

LARGEST_RECORD = 64 << 20
"""Bytes of a record that is kept, and of what one compressed chunk unpacks to."""

MOST_KEPT = 256 << 20
"""Bytes of all that is kept of a bag."""

MOST_TIMES = 100
"""So many times the size of the bag, and MOST_KEPT, may all its compressed chunks unpack to."""

_MESSAGE_COSTS = 300  # bytes, beside its data
_MOST_PROBLEMS = 20
_HEAD = "the head of a record"


@dataclass(frozen=True)
class Message:
    """A message as it was sent: `at` in seconds, `node` its publisher ("": not recorded)."""

    topic: str
    kind: str
    node: str
    at: float
    data: bytes


@dataclass(frozen=True)
class Bag:
    """The wanted messages in the order in which they stand, the topics of all, and what could not be read, in
    sentences.
    """

    messages: Tuple[Message, ...]
    topics: Tuple[str, ...]
    problems: Tuple[str, ...]


class Damage(Exception):
    """The bytes are not those of a bag; the message says which."""


class _Full(Exception):
    """The bag holds more than is read; the message says of what."""


def read_bag(stream: BinaryIO, wanted: Callable[[str], bool]) -> Bag:
    """What is in a bag, with the messages on the wanted topics. Raises Damage where it is none, OSError."""
    size = stream.seek(0, io.SEEK_END)
    stream.seek(0)
    if stream.read(len(MAGIC)) != MAGIC:
        raise Damage(f"it does not begin with {MAGIC.decode().strip()}")
    reader = _BagReader(wanted, MOST_TIMES * size + MOST_KEPT)
    try:
        reader.run(_Source(stream, size, is_chunk=False), "")
    except _Full as full:
        reader.problems.append(f"{full}; what follows was not read")
    if not 0 < reader.index <= size and not reader.problems:
        reader.problems.append("the bag was not closed: its last messages may be missing")
    elif reader.listed < reader.chunks and not reader.problems:
        reader.problems.append(f"the bag ends within its index: it lists {reader.listed} of {reader.chunks} chunks")
    if reader.strangers:
        reader.problems.append(f"{reader.strangers} messages of connections that it does not describe were skipped")
    return Bag(tuple(reader.messages), tuple(sorted(reader.topics)), tuple(reader.problems))


class _Source:
    """A stream of records from its place on, up to `end`: a whole bag, or one chunk."""

    def __init__(self, stream: BinaryIO, end: int, is_chunk: bool = True) -> None:
        self.stream, self.at, self.end, self.is_chunk = stream, stream.tell(), end, is_chunk

    def length(self, what: str) -> int:
        """The length that stands here, of bytes that are there. Raises Damage."""
        if self.at + 4 <= self.end:
            length = self._announced()
            if self.at + length <= self.end:
                return length
        raise Damage(f"the file ends in {what}, at byte {self.end}")

    def chunk_length(self) -> Optional[int]:
        """The length of a chunk, which may go beyond the end; None where it is not there."""
        return self._announced() if self.at + 4 <= self.end else None

    def take(self, length: int, most: int, what: str) -> bytes:
        """So many bytes. Raises Damage where they are more than `most`."""
        if length > most:
            raise Damage(f"{what} at byte {self.at} is too large")
        data = self.stream.read(length)
        self.at += len(data)
        if len(data) < length:  # it was cut off while it was read
            raise Damage(f"the file ends in {what}, at byte {self.at}")
        return data

    def go_to(self, place: int) -> None:
        """Leave out what stands before that place."""
        self.at = self.stream.seek(place)

    def _announced(self) -> int:
        return int.from_bytes(self.take(4, 4, "a length"), "little")


class _BagReader:
    def __init__(self, wanted: Callable[[str], bool], most_unpacked: int) -> None:
        self.messages: List[Message] = []
        self.problems: List[str] = []
        self.topics: Dict[str, None] = {}
        self.index = 0  # where the index stands, which is written when a bag is closed
        self.chunks = 0  # how many the bag has, which is written with it
        self.listed = 0  # how many of them the index describes; their descriptions are the last records of a bag
        self.strangers = 0
        self._wanted = wanted
        self._left, self._most_unpacked = MOST_KEPT, most_unpacked
        self._connections: Dict[int, Optional[Tuple[str, str, str]]] = {}  # None: not wanted

    def run(self, source: _Source, where: str) -> None:
        """All records from here to the end; the first damage ends it, and is a problem. Raises _Full."""
        try:
            while source.at < source.end:
                self._record(source)
        except Damage as damage:
            self._problem(f"{where}{damage}; what follows was not read")

    def _record(self, source: _Source) -> None:
        place = source.at
        head = source.take(source.length(_HEAD), _LARGEST_HEADER, _HEAD)
        header = dict(_fields(head))
        if len(header.get("op", b"")) != 1:
            raise Damage(f"no record begins at byte {place}")
        kind = header["op"][0]
        length = source.chunk_length() if kind == _CHUNK else None
        if length is not None:
            if source.is_chunk:
                raise Damage(f"a chunk begins within a chunk, at byte {place}")
            # One that was never closed has no length, and its records follow as if there were no chunk.
            self._chunk(header.get("compression", b"none").decode("ascii", "replace"), source, source.at + length)
            return
        length = source.length("a record")
        end = source.at + length
        if kind == _BAG:
            self.index, self.chunks = _integer(header, "index_pos", 8), _integer(header, "chunk_count", 4)
        elif kind == _CHUNK_INFO:
            self.listed += 1
        elif kind == _CONNECTION:
            self._connection(header, dict(_fields(source.take(length, LARGEST_RECORD, "a record"))))
        elif kind == _MESSAGE:
            number = _integer(header, "conn", 4)
            seconds, nanoseconds = struct.unpack("<LL", _field(header, "time", 8))
            connection = self._connections.get(number)
            if connection is not None:
                self._keep(length + _MESSAGE_COSTS)
                data = source.take(length, LARGEST_RECORD, "a record")
                self.messages.append(Message(*connection, seconds + nanoseconds / 1e9, data))
            elif number not in self._connections:
                self.strangers += 1
        source.go_to(end)

    def _connection(self, header: Dict[str, bytes], about: Dict[str, bytes]) -> None:
        topic = _decoded(header, "topic") or _decoded(about, "topic")
        kind, node = _decoded(about, "type"), _decoded(about, "callerid").strip("/")
        number = _integer(header, "conn", 4)
        if number not in self._connections or topic not in self.topics:
            self._keep(len(topic) + len(kind) + len(node) + _MESSAGE_COSTS)
        self.topics[topic] = None
        self._connections[number] = (topic, kind, node) if self._wanted(topic) else None

    def _chunk(self, compression: str, source: _Source, end: int) -> None:
        """A chunk up to `end`. What there is of one that is cut off can still be read."""
        there = min(end, source.end)
        if compression == "none":
            inner = _Source(source.stream, there)
            self.run(inner, "in a chunk: ")
        elif there > source.at:
            try:
                content = decompressed(compression, source.take(there - source.at, LARGEST_RECORD, "a chunk"))
            except Damage as damage:
                self._problem(f"a chunk cannot be unpacked ({damage}), its messages are missing")
            else:
                self._most_unpacked -= len(content)
                if self._most_unpacked < 0:
                    raise _Full(f"its chunks unpack to more than {MOST_TIMES} times its size")
                self.run(_Source(io.BytesIO(content), len(content)), "in a chunk: ")
        source.go_to(there)
        if end > there:
            raise Damage(f"the file ends in a chunk, at byte {there}")

    def _keep(self, size: int) -> None:
        """Raises _Full where so many bytes more would be kept than may be."""
        self._left -= size
        if self._left < 0:
            raise _Full(f"it holds more than {MOST_KEPT >> 20} MiB of a mission's messages")

    def _problem(self, sentence: str) -> None:
        if len(self.problems) < _MOST_PROBLEMS:
            self.problems.append(sentence)


def decompressed(compression: str, data: bytes) -> bytes:
    """What is in a chunk, as far as it goes. Raises Damage, also where that is more than LARGEST_RECORD."""
    if compression == "none" or not data:
        return data
    try:
        if compression == "bz2":
            content = bz2.BZ2Decompressor().decompress(data, LARGEST_RECORD + 1)
        elif compression == "lz4":
            content = _lz4(data)
        else:
            raise Damage(f"its compression is {compression[:20]!r}; expected none, bz2 or lz4")
    except (OSError, ValueError, RuntimeError, EOFError) as problem:
        raise Damage(str(problem)) from None
    if len(content) > LARGEST_RECORD:
        raise Damage(f"it unpacks to more than {LARGEST_RECORD >> 20} MiB")
    return content


def _lz4(data: bytes) -> bytes:
    try:
        import lz4.frame
    except ImportError:
        raise Damage("lz4 needs the Python package lz4: pip install 'pursue-gen[bags]'") from None
    return bytes(lz4.frame.LZ4FrameDecompressor().decompress(data, LARGEST_RECORD + 1))


def _fields(header: bytes) -> Iterator[Tuple[str, bytes]]:
    place = 0
    while place < len(header):
        end = place + 4
        if end <= len(header):
            end += struct.unpack_from("<L", header, place)[0]
        if end > len(header):
            raise Damage("the head of a record ends in a field")
        name, _, value = header[place + 4 : end].partition(b"=")
        place = end
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
