"""What strangers may do to the page's server, who need no token for it: it goes on serving.

The server runs in a process of its own: one that hangs is killed, and takes nothing else with it.
"""

from __future__ import annotations

import contextlib
import os
import resource
import select
import socket
import subprocess
import sys
from typing import Any, Iterator, List, Tuple

import pytest

from pursue_runtime.ui.page_server import STATIC
from pursue_runtime.ui.web import MAX_PAGES
from tests.waiting import PATIENCE, connected, dripping, flooded, may_close, rest, until

pytest.importorskip("tornado", reason="tornado is not installed")

PROGRAM = """
import resource, sys
from pursue_runtime.ui import web as page

soft, longest = int(sys.argv[2]), float(sys.argv[3])
resource.setrlimit(resource.RLIMIT_NOFILE, (soft, soft))
page.REQUEST_TIMEOUT = page.MAX_CONNECTION_TIME = longest
web = page.Web(sys.argv[1], "127.0.0.1", 0, "a token", dict, str, lambda: None)
web.start()
print(web.port, flush=True)
sys.stdin.read()
web.close()
"""
CHUNKED = b"Host: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n"


@contextlib.contextmanager
def serving(files: int = 256, longest: float = 60.0) -> Iterator[Tuple[int, "subprocess.Popen[bytes]"]]:
    """A server with a token, of which we know nothing; `files`: so many may be open in its process."""
    words = [sys.executable, "-c", PROGRAM, str(STATIC), str(files), str(longest)]
    pipe = subprocess.PIPE
    with subprocess.Popen(words, stdin=pipe, stdout=pipe, stderr=pipe) as process:
        assert process.stdout is not None and process.stdin is not None
        try:
            said = select.poll()  # which takes any file number: this process may have many files open
            said.register(process.stdout, select.POLLIN)
            assert said.poll(PATIENCE * 1000), "the server has not begun"
            yield int(process.stdout.readline()), process
            process.stdin.close()
            assert process.wait(PATIENCE) == 0
        finally:
            process.kill()


def ask(port: int, request: bytes) -> bytes:
    """What is answered until the other side closes."""
    with connected(port) as there:
        with may_close():
            there.sendall(request)
        return rest(there)


def serves(port: int) -> bool:
    """True where a request is answered: with a no, for it has no token."""
    return b" 401 " in ask(port, b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")


@pytest.mark.parametrize("line", ["GET / HTTP/1.1", "POST /live HTTP/1.1", "PUT /x HTTP/1.0"])
def test_chunks_are_refused_and_none_is_read(line: str) -> None:
    with serving() as (port, _):
        for size in (b"-1", b"-ffff", b"0", b"5", b"zz", b"ffffffffffffffff", b""):
            for more in (b"", b"Content-Length: 9\r\n"):
                request = line.encode() + b"\r\n" + CHUNKED + more + b"\r\n" + size
                answer = ask(port, request + b"\r\nabcde\r\n0\r\n\r\n")
                assert not answer or (answer.startswith(b"HTTP/1.1 411 ") and b"Connection: close" in answer), answer
                assert serves(port), size


def test_chunks_behind_other_requests_are_not_read_either() -> None:
    first = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 20
    with serving() as (port, process):
        ask(port, first + b"POST / HTTP/1.1\r\n" + CHUNKED + b"\r\n-1\r\n")
        assert serves(port)
        assert process.stdin is not None and process.stderr is not None
        process.stdin.close()
        assert process.stderr.read() == b"", "strangers do not write on our terminal"


def test_a_body_that_never_comes_or_a_head_that_drips_is_given_up() -> None:
    starts = [b"", b"GET / HT", b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 4000\r\n\r\nx"]
    with serving(longest=1.0) as (port, _):
        slow = [connected(port) for _ in starts]
        for there, start in zip(slow, starts):
            with may_close():
                there.sendall(start)
        until(lambda: serves(port), "others are answered, where they are fast enough")
        for there in slow:
            assert rest(there) == b""
            there.close()


@pytest.mark.parametrize("start", [b"GET / HTTP/1.1\r\nA: ", b"POST / HTTP/1.1\r\nContent-Length: 4000\r\n\r\n"])
def test_a_request_that_drips_gets_no_more_time_than_one_that_stands_still(start: bytes) -> None:
    with serving(longest=1.0) as (port, _), connected(port) as there:
        there.sendall(start)
        with dripping(there, b"x"):
            assert rest(there) == b""


def test_who_does_not_read_an_answer_is_given_up() -> None:
    many = b"GET /page.js HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 20000
    with serving(longest=1.0) as (port, process):
        with connected(port) as there:
            there.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            with may_close():
                there.sendall(many)
            until(lambda: not connections(process.pid), "it is given up")
        until(lambda: serves(port), "others are answered, where they are fast enough")


def test_many_connections_take_neither_files_nor_the_server_away() -> None:
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    assert most > 600
    with serving(files=200, longest=3.0) as (port, process), contextlib.ExitStack() as held:
        for _ in range(400):
            there = held.enter_context(connected(port))
            with may_close():
                there.sendall(b"GET / HTTP/1.1\r\n")
        assert connections(process.pid) < 150, "the node has files left for itself"
        until(lambda: serves(port), "who does nothing makes room in time")


@pytest.mark.parametrize("address", ["127.0.0.1", "127.0.0.2"])
def test_a_flood_keeps_nobody_off_the_stop_button(address: str) -> None:
    with serving(longest=PATIENCE) as (port, process), flooded(port, address):
        cookie = enter(port)
        assert b" 200 " in ask(port, PAGE % cookie)
        stop(port, cookie)
        assert connections(process.pid) < 80


def test_pages_of_one_address_leave_room_for_others() -> None:
    with serving(longest=PATIENCE) as (port, _), contextlib.ExitStack() as held:
        cookie = enter(port)
        for _ in range(MAX_PAGES):
            page = held.enter_context(connected(port, "127.0.0.2"))
            page.sendall(LIVE % (port, cookie, port))
            hear(page, b" 101 ")
        stop(port, cookie)


def enter(port: int) -> bytes:
    """The cookie of somebody who opens the page with its token."""
    answer = ask(port, b"GET /?token=a%20token HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n")
    return answer.partition(b"Set-Cookie: ")[2].partition(b";")[0]


def stop(port: int, cookie: bytes) -> None:
    """Opens a page, whose Stop button is pressed and answered."""
    with connected(port) as page:
        page.sendall(LIVE % (port, cookie, port))
        hear(page, b" 101 ", b"{}")
        page.sendall(STOP)
        hear(page, b'"stop"')


def hear(there: socket.socket, *words: bytes) -> None:
    """Reads until all of the words have come."""
    said = b""
    while not all(word in said for word in words):
        part = there.recv(4096)
        assert part, said
        said += part


PAGE = b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nCookie: %s\r\nConnection: close\r\n\r\n"
LIVE = (
    b"GET /live HTTP/1.1\r\nHost: 127.0.0.1:%d\r\nCookie: %s\r\nOrigin: http://127.0.0.1:%d\r\nUpgrade: websocket\r\n"
    b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
)
STOP = bytes([0x81, 0x84, 0, 0, 0, 0]) + b"stop"
"""A frame with a text, masked with zeros; the server of these tests remarks what it gets."""


def connections(pid: int) -> int:
    """So many sockets the process has, but for the one that listens and those of its event loop."""
    folder = f"/proc/{pid}/fd"
    found: List[Any] = []
    for name in os.listdir(folder):
        with contextlib.suppress(OSError):
            found.append(os.readlink(os.path.join(folder, name)))
    return sum(each.startswith("socket:") for each in found) - 3
