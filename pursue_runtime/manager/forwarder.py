"""The socket on which communication_manager forwards topics to tools that are no ROS nodes.

Each subscriber gets a line for each message: `{"topic": "pursue/events", "data": "bot1_a2b"}`. (The thesis sends the
text "actions …" with no end to it: lines of JSON are what tools can take apart.) Of a latched topic a newcomer gets the
last message at once. Nothing that subscribers send is looked at, and who does not read is given up. There is no TLS
here: what is forwarded can be read by whoever reaches the port.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import socket
from typing import Any, Dict, List, Set

from tornado.iostream import IOStream, StreamBufferFullError, StreamClosedError
from tornado.tcpserver import TCPServer

from pursue_runtime.http_server import Service
from pursue_runtime.manager.manager import RequestLog

MAX_SUBSCRIBERS = 32  # at a time
MAX_BACKLOG = 4 << 20  # bytes that a subscriber may be behind
MAX_LINE = 1 << 20  # bytes of the longest line that is forwarded
MAX_INPUT = 1 << 16  # bytes that a subscriber may send until it is given up


class Forwarder(Service):
    """Sends every message to every subscriber; all but the constructor runs in the event loop."""

    def __init__(
        self, sockets: List[Any], record: RequestLog, subscribers: int = MAX_SUBSCRIBERS, backlog: int = MAX_BACKLOG
    ) -> None:
        """Of sockets that are bound. `behind` is for tests, like `subscribers`."""
        self.port = int(sockets[0].getsockname()[1])
        self._sockets, self._record = sockets, record
        self._most, self._backlog = subscribers, backlog
        self._streams: Set[IOStream] = set()
        self._last: Dict[str, bytes] = {}
        self._listener = _Listener(self)

    def open(self) -> None:
        """Serves from now on."""
        self._listener.add_sockets(self._sockets)

    async def end(self) -> None:
        """Ends all connections."""
        self._listener.stop()
        for stream in list(self._streams):
            stream.close()
        await asyncio.sleep(0)

    @property
    def subscribers(self) -> int:
        """Return the number of subscribers."""
        return len(self._streams)

    def send(self, topic: str, data: str, latched: bool = False) -> None:
        """Send a message of a topic to every subscriber."""
        line = json.dumps({"topic": topic, "data": data}).encode() + b"\n"
        if len(line) > MAX_LINE:
            self._record.count("not forwarded", f"a message of {topic} is too long to be forwarded: {len(line)} bytes")
            return
        if latched:
            self._last[topic] = line
        for stream in list(self._streams):
            self._write(stream, line)

    async def serve(self, stream: IOStream) -> None:
        """One subscriber, until it goes."""
        if len(self._streams) >= self._most:
            self._record.count("turned away", "too many subscribers: one was closed")
            stream.close()
            return
        stream.max_write_buffer_size = self._backlog
        stream.set_nodelay(True)
        if stream.socket is not None:  # a machine that has vanished is found out in time
            stream.socket.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
        self._streams.add(stream)
        try:
            for line in self._last.values():
                self._write(stream, line)
            received = 0
            while received < MAX_INPUT:  # reading is how one learns that the other side has gone
                received += len(await stream.read_bytes(4096, partial=True))
            self._record.count("given up", "a subscriber that talks was given up")
        except StreamClosedError:
            pass
        finally:
            self._streams.discard(stream)
            stream.close()

    def _write(self, stream: IOStream, line: bytes) -> None:
        with contextlib.suppress(StreamClosedError):
            try:
                sent = stream.write(line)
            except StreamBufferFullError:
                self._record.count("given up", "a subscriber that does not read was given up")
                stream.close()
            else:
                asyncio.ensure_future(sent).add_done_callback(lambda done: done.cancelled() or done.exception())


class _Listener(TCPServer):
    def __init__(self, forwarder: Forwarder) -> None:
        super().__init__(max_buffer_size=1 << 16, read_chunk_size=4096)
        self._forwarder = forwarder

    async def handle_stream(self, stream: IOStream, address: Any) -> None:
        """One that comes."""
        await self._forwarder.serve(stream)
