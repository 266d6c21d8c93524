"""An HTTP server for untrusted networks: limited connections, limited time, no chunked requests."""

from __future__ import annotations

import asyncio
from typing import Any, Callable, Dict

from tornado.httpserver import HTTPServer

from pursue_runtime.needs import TORNADO, require
from pursue_runtime.slots import Slots

require(TORNADO)


class LimitedServer(HTTPServer):
    """An HTTP server with limits on connections (see Slots) and their duration; WebSockets are counted elsewhere."""

    def limit(self, connections: int, longest: float, on_refused: Callable[[], object]) -> None:
        """Set the limits, before the server opens: the base class does not let subclasses take arguments.

        `longest` in seconds; `on_refused` is called for each connection that is closed for another one.
        """
        self._slots: Slots[Any] = Slots(connections)
        self._life, self._on_refused = longest, on_refused
        self._timers: Dict[Any, asyncio.TimerHandle] = {}

    def handle_stream(self, stream: Any, address: Any) -> None:
        """Accept a connection; where there are too many, close another one for it."""
        victim = self._slots.take(stream, address[0])
        if victim is not None:
            self._on_refused()
            self._forget(victim)
            victim.close()
        self._timers[stream] = asyncio.get_running_loop().call_later(self._life, stream.close)
        super().handle_stream(stream, address)

    def trust(self, request: Any) -> None:
        """Keep the connection of a request that has shown that it may be here, as long as others can go instead."""
        self._slots.trust(request.connection.stream)

    def on_close(self, server_conn: Any) -> None:
        """Forget a connection that was closed."""
        self._forget(server_conn.stream)
        super().on_close(server_conn)

    def _forget(self, stream: Any) -> None:
        self._slots.free(stream)
        timer = self._timers.pop(stream, None)
        if timer is not None:
            timer.cancel()

    def close_all(self) -> None:
        """Close all connections."""
        for stream in list(self._timers):
            stream.close()


def drop_chunks(headers: Any) -> bool:
    """Keep tornado from reading a chunked body of a request whose head has arrived; return True if one was announced.

    A negative size of a chunk keeps it (6.2) in a loop for ever.
    """
    return headers.pop("Transfer-Encoding", None) is not None
