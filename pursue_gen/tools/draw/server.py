"""Carries the page's files and requests over HTTP, on this machine alone.

A request has to name this address in `Host`, and the random word of this run as the first part of its path; requests
that change something come from the page itself (`Origin`). So neither other sites in the same browser nor other users
of the machine can read or change the scenario.
"""

from __future__ import annotations

import contextlib
import hmac
import io
import json
import secrets
import socket
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Dict, Mapping, Optional, Tuple

from pursue_gen.diagnostics import usage_error
from pursue_gen.files import reason_of
from pursue_gen.tools.draw.page import DrawPage
from pursue_runtime.bounded import json_object
from pursue_runtime.slots import Slots

HOST = "127.0.0.1"
MOST_BYTES = 8 << 20
"""Bytes of a request: a text of a million letters, each as long as JSON writes it."""
MOST_CONNECTIONS = 32
REQUEST_TIMEOUT = 30.0  # seconds that a browser may take for a whole request, and for the answer
_STATIC = Path(__file__).parent / "static"
_KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self'; "
    "frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_REPORT_POLICY = "sandbox allow-scripts; frame-ancestors 'self'"
"""The report has rules of its own; in a sandbox it cannot reach this page."""


class DrawServer(ThreadingHTTPServer):
    """The server of one page, bound to its address; `serve_forever` serves."""

    daemon_threads = True
    request_queue_size = 128

    def __init__(self, page: DrawPage, port: int = 0) -> None:
        """`port`: 0 for any that is free. Raises PursueError (exit status 2) where it cannot be had."""
        self.page = page
        self.token = secrets.token_urlsafe(16)
        self._slots: Slots[Any] = Slots(MOST_CONNECTIONS)
        self._lock = threading.Lock()
        self._free = threading.BoundedSemaphore(MOST_CONNECTIONS)
        try:
            super().__init__((HOST, port), _Handler)
        except (OSError, OverflowError) as problem:
            message = f"the page cannot be served on port {port}: {reason_of(problem)}"
            raise usage_error(message, "choose another --port, 0 for any that is free") from None
        files = sorted(_STATIC.iterdir())
        self.files = {file.name: (file.read_bytes(), _KINDS[file.suffix]) for file in files if file.suffix in _KINDS}

    @property
    def hosts(self) -> Tuple[str, ...]:
        """What `Host` may be."""
        return tuple(f"{name}:{self.server_address[1]}" for name in (HOST, "localhost"))

    @property
    def url(self) -> str:
        """Where the page is."""
        return f"http://{self.hosts[0]}/{self.token}/"

    def process_request(self, request: Any, client_address: Any) -> None:
        """Serves a connection in a thread of its own; where there are too many, another one is closed for it."""
        with self._lock:
            victim = self._slots.take(request, client_address[0])
        if victim is not None:
            with contextlib.suppress(OSError):  # it has just ended
                victim.shutdown(socket.SHUT_RDWR)
        self._free.acquire()  # where there are too many, the thread of the other one ends first
        try:
            super().process_request(request, client_address)
        except Exception:  # the system has no thread left
            self._forget(request)
            raise

    def trust(self, request: Any) -> None:
        """Keep a connection that knows the random word, as long as others can go instead."""
        with self._lock:
            self._slots.trust(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """As of the base class."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._forget(request)

    def _forget(self, request: Any) -> None:
        with self._lock:
            self._slots.free(request)
        self._free.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A browser that goes away is no error, and clients must not write to the terminal."""


class _Arriving(io.RawIOBase):
    """What a client sends, until a deadline that no drip puts off."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection, self.deadline = connection, 0.0

    def readable(self) -> bool:
        """As of the base class."""
        return True

    def readinto(self, buffer: Any) -> int:
        """As of the base class. Raises socket.timeout."""
        self._connection.settimeout(max(self.deadline - time.monotonic(), 0.001))
        return self._connection.recv_into(buffer)


class _Handler(BaseHTTPRequestHandler):
    """One connection."""

    server: DrawServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "pursue-gen", ""

    def setup(self) -> None:
        """As of the base class; reads with a deadline."""
        super().setup()
        self._arriving = _Arriving(self.connection)
        self.rfile = io.BufferedReader(self._arriving)

    def handle_one_request(self) -> None:
        """As of the base class, which closes the connection at a socket.timeout."""
        self._arriving.deadline = time.monotonic() + REQUEST_TIMEOUT
        super().handle_one_request()

    def do_GET(self) -> None:
        """A file of the page, the floor plan, or the report."""
        path = self._path()
        if path is None:
            return
        picture = self.server.page.picture if path == "floor.png" else None
        if path == "report.html":
            self._send(200, self.server.page.jobs.report.encode("utf-8"), "text/html; charset=utf-8", _REPORT_POLICY)
        elif picture is not None:
            self._send(200, picture, "image/png")
        elif (path or "index.html") in self.server.files:
            content, kind = self.server.files[path or "index.html"]
            self._send(200, content, f"{kind}; charset=utf-8")
        else:
            self._refuse(404, "There is nothing here.")

    def do_POST(self) -> None:
        """A request of the page: JSON in, JSON out."""
        path = self._path()
        if path is None:
            return
        if self.headers.get("Origin", "") not in {f"http://{host}" for host in self.server.hosts}:
            self._refuse(403, "This request does not come from the page.")
            return
        body = self._body()
        if body is None:
            return
        try:
            answer = self.server.page.answer(path, body)
        except Exception as problem:  # the person's text is in the page: it has to go on
            what = f"internal error of pursue-gen: {type(problem).__name__}: {problem}"
            answer = {"refused": what, "hint": "please report it, with the text; Undo takes a change back"}
        self._send(200, json.dumps(answer, allow_nan=False).encode("utf-8"), "application/json")

    def _path(self) -> Optional[str]:
        """What is asked for, behind the word of this run; None where it is refused."""
        if self.headers.get("Host", "").lower() not in self.server.hosts:
            self._refuse(403, "This page is on this machine only.")
            return None
        _, _, rest = self.path.partition("?")[0].partition("/")
        token, slash, path = rest.partition("/")
        if not hmac.compare_digest(token.encode("latin-1", "replace"), self.server.token.encode()) or not slash:
            self._refuse(403, "Open the whole address that pursue-gen draw has printed.")
            return None
        self.server.trust(self.connection)
        return path

    def _body(self) -> Optional[Mapping[str, Any]]:
        """The JSON object that was sent; None where it is refused."""
        length = self.headers.get("Content-Length", "")
        if "Transfer-Encoding" in self.headers or not (length.isascii() and length.isdigit() and len(length) < 10):
            self._refuse(411, "A request has to say how long it is.")
            return None
        if int(length) > MOST_BYTES:
            self._refuse(413, f"A request has at most {MOST_BYTES} bytes.")
            return None
        if self.headers.get_content_type() != "application/json":
            self._refuse(415, "A request is JSON.")
            return None
        body = json_object(self.rfile.read(int(length)))
        if body is None:
            self._refuse(400, "This request cannot be understood.")
        return body

    def _refuse(self, status: int, why: str) -> None:
        """An answer that says why not; what else was sent is not read."""
        self.close_connection = True
        self._send(status, f"{why}\n".encode(), "text/plain; charset=utf-8")

    def _send(self, status: int, content: bytes, kind: str, policy: str = _POLICY) -> None:
        headers: Dict[str, str] = {
            "Content-Type": kind,
            "Content-Length": str(len(content)),
            "Content-Security-Policy": policy,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Cache-Control": "no-store",
        }
        self.connection.settimeout(REQUEST_TIMEOUT)
        self.send_response(status)
        for name, value in headers.items():
            self.send_header(name, value)
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, format: str, *args: Any) -> None:
        """Nothing: what is served is no news, and clients must not write to the terminal."""
