"""Servers in an event loop that has a thread of its own, and what they need on untrusted networks: limited connections,
limited time, no chunked requests."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from typing import Any, Callable, ContextManager, Dict, List, Optional, Tuple

from tornado.httpserver import HTTPServer
from tornado.netutil import bind_sockets

from pursue_runtime.needs import TORNADO, require
from pursue_runtime.slots import Slots

require(TORNADO)

CAPTURED_LOGGERS = ("tornado", "asyncio")  # loggers that write a line for each malformed request


class ServerError(Exception):
    """The node cannot serve; the message says why, and what to do."""


def bind(host: str, port: int, argument: str) -> List[Any]:
    """Listening sockets; port 0: any that is free. Raises ServerError, which names the node's argument."""
    try:
        if not 0 <= port < 1 << 16:
            raise OSError("there is no such port")
        return list(bind_sockets(port, host))
    except (OSError, UnicodeError) as problem:
        hint = f"choose another {argument} (0: any that is free) or --host"
        raise ServerError(f"cannot listen on {host}, port {port}: {problem}; {hint}") from problem


class Service:
    """Something that runs in the loop; both are called there."""

    def open(self) -> None:
        """Begins."""

    async def end(self) -> None:
        """Ends, and leaves nothing behind."""


class Background:
    """The loop, in a thread, with services. What libraries log there goes to `trouble(word, text)`, which counts it;
    without that it goes where all goes that they log."""

    def __init__(self, services: Tuple[Service, ...], trouble: Optional[Callable[[str, str], None]] = None) -> None:
        self._services = services
        self._loop = asyncio.new_event_loop()
        self._stop = self._loop.create_future()
        self._log: ContextManager[None] = contextlib.nullcontext() if trouble is None else _Log(trouble)
        self._thread = threading.Thread(target=self._run, name="server", daemon=True)

    def start(self) -> None:
        """Runs until `close`."""
        self._thread.start()

    def call(self, function: Callable[..., object], *arguments: Any) -> None:
        """Calls a function in the loop; from any thread, and in order."""
        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(function, *arguments)

    def close(self, patience: float = 5.0) -> None:
        """Ends all services and the thread, for whose end it waits so many seconds."""
        self.call(self._stop.cancel)
        if self._thread.is_alive():
            self._thread.join(patience)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        with self._log:
            try:
                self._loop.run_until_complete(self._serve())
            finally:
                self._loop.close()

    async def _serve(self) -> None:
        for service in self._services:
            service.open()
        await asyncio.wait([self._stop])
        for service in self._services:
            await service.end()
        rest = [task for task in asyncio.all_tasks() if task is not asyncio.current_task()]
        for task in rest:
            task.cancel()
        await asyncio.gather(*rest, return_exceptions=True)


class _Log(logging.Handler):
    """While it is entered, what the libraries log comes here and goes nowhere else."""

    def __init__(self, trouble: Callable[[str, str], None]) -> None:
        super().__init__(logging.INFO)
        self._trouble = trouble

    def __enter__(self) -> None:
        for logger in map(logging.getLogger, CAPTURED_LOGGERS):
            logger.addHandler(self)
            logger.propagate = False

    def __exit__(self, *_: object) -> None:
        for logger in map(logging.getLogger, CAPTURED_LOGGERS):
            logger.removeHandler(self)
            logger.propagate = True

    def emit(self, record: logging.LogRecord) -> None:
        """Pass on errors, which are faults of this program, with their text; the rest is malformed requests."""
        if record.levelno < logging.ERROR:
            self._trouble("malformed", "")
            return
        problem = record.exc_info[1] if record.exc_info else None
        self._trouble("errors", f"{record.name}: {record.getMessage()[:500]} {problem!r}"[:1000])


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
