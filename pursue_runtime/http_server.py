"""An HTTP server for untrusted networks: limited connections, limited time, no chunked requests."""

from __future__ import annotations

import asyncio
from typing import Any, Callable, Dict

from tornado.httpserver import HTTPServer

from pursue_runtime.needs import TORNADO, require

require(TORNADO)


class LimitedServer(HTTPServer):
    """An HTTP server with a limit on connections and on their duration; WebSockets are counted elsewhere."""

    def limit(self, connections: int, longest: float, on_refused: Callable[[], object]) -> None:
        """Set the limits, before the server opens: the base class does not let subclasses take arguments.

        `longest` in seconds; `turned_away` is called for each connection beyond the limit.
        """
        self._room, self._life, self._on_refused = connections, longest, on_refused
        self._inside: Dict[Any, asyncio.TimerHandle] = {}

    def handle_stream(self, stream: Any, address: Any) -> None:
        """Accept a connection, or close it where there are too many."""
        if len(self._inside) >= self._room:
            self._on_refused()
            stream.close()
            return
        loop = asyncio.get_running_loop()
        self._inside[stream] = loop.call_later(self._life, stream.close)
        super().handle_stream(stream, address)

    def on_close(self, server_conn: Any) -> None:
        """Forget a connection that was closed."""
        timer = self._inside.pop(server_conn.stream, None)
        if timer is not None:
            timer.cancel()
        super().on_close(server_conn)

    def close_all(self) -> None:
        """Close all connections."""
        for stream in list(self._inside):
            stream.close()


def drop_chunks(headers: Any) -> bool:
    """Keep tornado from reading a chunked body of a request whose head has arrived; return True if one was announced.

    A negative size of a chunk keeps it (6.2) in a loop for ever.
    """
    return headers.pop("Transfer-Encoding", None) is not None
