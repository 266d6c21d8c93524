"""An event loop in a thread of its own, in which the servers of communication_manager run."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import threading
from typing import Any, Callable, List, Tuple

from tornado.netutil import bind_sockets

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

    async def close(self) -> None:
        """Ends, and leaves nothing behind."""


class Background:
    """The loop, in a thread, with services. What libraries log there goes to `trouble(word, text)`: it is counted."""

    def __init__(self, services: Tuple[Service, ...], trouble: Callable[[str, str], None]) -> None:
        self._services = services
        self._loop = asyncio.new_event_loop()
        self._stop = self._loop.create_future()
        self._log = _Log(trouble)
        self._thread = threading.Thread(target=self._run, name="servers", daemon=True)

    def start(self) -> None:
        """Runs until `close`."""
        self._thread.start()

    def call(self, function: Callable[..., object], *arguments: Any) -> None:
        """Calls a function in the loop; from any thread, and in order."""
        with contextlib.suppress(RuntimeError):  # the loop has ended
            self._loop.call_soon_threadsafe(function, *arguments)

    def close(self) -> None:
        """Ends all services and the thread."""
        self.call(self._stop.cancel)
        if self._thread.is_alive():
            self._thread.join(5.0)

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
            await service.close()
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
