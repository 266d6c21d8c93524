"""The door of an HTTP server that strangers may reach: so many at a time, each for so long, no chunks. No ROS."""

from __future__ import annotations

import asyncio
from typing import Any, Callable, Dict

from tornado.httpserver import HTTPServer


class LimitedServer(HTTPServer):
    """Lets in so many connections, each for so long. WebSockets leave by this door: they are counted elsewhere."""

    def limit(self, connections: int, longest: float, on_refused: Callable[[], object]) -> None:
        """To be called before it opens: the base class does not have its subclasses take arguments.

        `longest` in seconds; `turned_away` is called for each that finds no room.
        """
        self._room, self._life, self._on_refused = connections, longest, on_refused
        self._inside: Dict[Any, asyncio.TimerHandle] = {}

    def handle_stream(self, stream: Any, address: Any) -> None:
        """One that comes."""
        if len(self._inside) >= self._room:
            self._on_refused()
            stream.close()
            return
        loop = asyncio.get_running_loop()
        self._inside[stream] = loop.call_later(self._life, stream.close)
        super().handle_stream(stream, address)

    def on_close(self, server_conn: Any) -> None:
        """One that has gone."""
        timer = self._inside.pop(server_conn.stream, None)
        if timer is not None:
            timer.cancel()
        super().on_close(server_conn)

    def close_all(self) -> None:
        """Closes all."""
        for stream in list(self._inside):
            stream.close()


def drop_chunks(headers: Any) -> bool:
    """Has tornado read no chunks of a request whose head has just come; True where some were announced.

    A negative size of a chunk keeps it (6.2) in a loop for ever.
    """
    return headers.pop("Transfer-Encoding", None) is not None
