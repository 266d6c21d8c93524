"""How tests wait for what comes in its own time, and what they hear of servers that may close at any moment.

Deadlines are for what never comes: where all is well nobody waits for them. So they are long, since a machine may be
slow, busy, or stand still for seconds.
"""

from __future__ import annotations

import contextlib
import errno
import socket
import threading
import time
from typing import Any, Callable, Iterator

PATIENCE = 120.0
"""Seconds after which nothing more is waited for."""

_CLOSED = (errno.ECONNRESET, errno.EPIPE, errno.ENOTCONN, errno.ECONNABORTED, errno.ESHUTDOWN)


def until(done: Callable[[], Any], what: str) -> Any:
    """Waits until it is so, and returns what it is then; the test fails where that never comes."""
    deadline = time.monotonic() + PATIENCE
    while True:
        found = done()
        if found:
            return found
        assert time.monotonic() < deadline, f"not within {PATIENCE:g} s: {what}"
        time.sleep(0.01)


def connected(port: int, address: str = "127.0.0.1") -> socket.socket:
    """A connection with a server on this machine, from this address."""
    return socket.create_connection(("127.0.0.1", port), PATIENCE, (address, 0))


@contextlib.contextmanager
def flooded(port: int, address: str) -> Iterator[None]:
    """Meanwhile 100 connections from this address are there, of which each has begun a request."""
    with contextlib.ExitStack() as held:
        for _ in range(100):
            there = held.enter_context(connected(port, address))
            with may_close():
                there.sendall(b"GET / HTTP/1.1\r\n")
        yield


@contextlib.contextmanager
def dripping(there: socket.socket, drop: bytes) -> Iterator[None]:
    """Sends these bytes again and again meanwhile, in a thread, as long as the other side takes them."""
    over = threading.Event()

    def drip() -> None:
        with may_close():
            while not over.wait(0.02):
                there.sendall(drop)

    thread = threading.Thread(target=drip)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@contextlib.contextmanager
def may_close() -> Iterator[None]:
    """The other side may close meanwhile, in any way that the system has for saying so; all else is an error."""
    try:
        yield
    except OSError as problem:
        if problem.errno not in _CLOSED:
            raise


def rest(there: socket.socket) -> bytes:
    """What comes until the other side closes; a server that does so on bytes it has not read is heard all the same."""
    said = b""
    with may_close():
        for part in iter(lambda: there.recv(65536), b""):
            said += part
    return said
