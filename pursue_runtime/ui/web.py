"""Serves the page: its files, and a WebSocket for views and requests.

Accepted are pages that this server has served (`Host` and `Origin` are checked, against other sites and rebound
names), and for any address but loopback only those who know the token. It comes once in the address, then in a cookie.
"""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import html
import ipaddress
import json
import re
import secrets
import socket
from pathlib import Path
from types import MappingProxyType
from typing import Any, Callable, List, Mapping, Optional, Tuple
from urllib.parse import urlsplit

from tornado.iostream import StreamBufferFullError
from tornado.netutil import bind_sockets
from tornado.web import Application, HTTPError, RequestHandler
from tornado.websocket import WebSocketClosedError, WebSocketHandler

from pursue_runtime.http_server import Background, LimitedServer, Service, drop_chunks
from pursue_runtime.slots import Slots, is_loopback

SCRIPTS = ("agents", "confirm", "connection", "missions", "objectives", "orders", "page", "plan", "press", "timeline")
FILES = {
    "/": ("index.html", "text/html"),
    **{f"/{name}.js": (f"{name}.js", "text/javascript") for name in SCRIPTS},
    **{f"/{name}.css": (f"{name}.css", "text/css") for name in ("layout", "missions", "page")},
}
TICK = 0.5  # real seconds between two words on what time it is
LAST_WORDS = 3.0  # real seconds for which one who closes the server waits for what was sent before
REQUEST_TIMEOUT = 30.0  # real seconds that a request may take to arrive
MAX_CONNECTION_TIME = 120.0  # real seconds that a connection may last that does not become a page that listens
MAX_CONNECTIONS = 64  # of those at a time
MAX_MESSAGE = 4096  # bytes that a page may send in a message or a request
MAX_BACKLOG = 1 << 20  # bytes that a page may be behind
MAX_PAGES = 50  # pages at a time
ALIVE = "alive?"  # the message of a page to which nothing has come for a while: it is answered at once
MAX_INVALID = 20  # messages of a page that cannot be understood until it is closed

ERROR_TEXTS = {
    400: "This request cannot be understood.",
    411: "This request is refused: nothing is taken here in chunks.",
    401: "This page needs its token: open the whole link that the UI has printed.",
    403: "This is not allowed: the token is wrong, or the request comes from another site.",
    404: "There is nothing here.",
    405: "There is nothing here.",
}


class WebError(Exception):
    """The page cannot be served; the message says why, and what to do."""


def is_address(host: str) -> bool:
    """True for an IP address."""
    try:
        return bool(ipaddress.ip_address(host))
    except ValueError:
        return False


class Web(Service):
    """The server, with an event loop in a thread of its own."""

    def __init__(
        self,
        folder: str,
        host: str,
        port: int,
        token: str,
        first_message: Callable[[], Mapping[str, Any]],
        on_message: Callable[[str], str],
        present: Callable[[], Optional[float]],
        pictures: Mapping[str, Tuple[bytes, str]] = MappingProxyType({}),
    ) -> None:
        """Binds the address (port 0: any that is free) and reads the page from `folder`; serves after `start`.

        `first_message` is for a page that connects, `on_message` takes its messages (ValueError: not a request) and
        returns a remark, `present` is the present time, None while the mission does not run. They are called in
        the thread of the server. `pictures`: what else is served, by path: the bytes, and their type. Raises WebError.
        """
        self.generated = not token and not is_loopback(host)
        self.token = secrets.token_urlsafe(16) if self.generated else token
        self.first_message, self.on_message, self._present = first_message, on_message, present
        self._pages: Slots[PageSocket] = Slots(MAX_PAGES)
        try:
            self._files = {path: (Path(folder, name).read_bytes(), kind) for path, (name, kind) in FILES.items()}
            self._files.update(pictures)
            self._sockets = bind_sockets(port, host)
        except (OSError, UnicodeError) as problem:
            hint = "choose another --port (0: any that is free) or --host"
            raise WebError(f"cannot serve the page on {host}, port {port}: {problem}; {hint}") from problem
        self.host, self.port = host, int(self._sockets[0].getsockname()[1])
        self._why = ""
        self._server: Optional[LimitedServer] = None  # belongs to the loop, and is made there
        self._ticks: Optional["asyncio.Future[None]"] = None  # likewise
        self._background = Background((self,))

    @property
    def url(self) -> str:
        """Where the page is; with the token, if that was made here."""
        everywhere = self.host in ("", "0.0.0.0", "::")
        name = _own_address() if everywhere else self.host
        name = f"[{name}]" if ":" in name else name
        shown = self.token if self.generated else "<your token>"
        return f"http://{name}:{self.port}/" + (f"?token={shown}" if self.token else "")

    @property
    def cookie(self) -> str:
        """The name of the cookie; browsers do not tell ports of one machine apart."""
        return f"pursue_ui_{self.port}"

    def start(self) -> None:
        """Serves, until `close`."""
        self._background.start()

    def send(self, message: Mapping[str, Any]) -> None:
        """Send a message to every page; from any thread."""
        self._background.call(self._send_text, json.dumps(message, allow_nan=False))

    def close(self, why: str = "the mission has ended") -> None:
        """Lets what was sent go out, closes every page with this reason, and ends."""
        self._why = why
        self._background.close(LAST_WORDS)

    # In the thread of the server --------------------------------------------------------------------------------------

    def open(self) -> None:
        """Serve from now on."""
        paths: List[Any] = [(path, File, {"web": self}) for path in self._files]
        application = _Requests(
            [*paths, ("/live", PageSocket, {"web": self})],
            default_handler_class=NotFound, default_handler_args={"web": self}, log_function=lambda _: None,
            websocket_max_message_size=MAX_MESSAGE, websocket_ping_interval=10, websocket_ping_timeout=30,
        )
        self._server = LimitedServer(
            application, max_header_size=4 * MAX_MESSAGE, max_body_size=MAX_MESSAGE, max_buffer_size=16 * MAX_MESSAGE,
            idle_connection_timeout=REQUEST_TIMEOUT, body_timeout=REQUEST_TIMEOUT,
        )
        self._server.limit(MAX_CONNECTIONS, MAX_CONNECTION_TIME, lambda: None)
        self._server.add_sockets(self._sockets)
        self._ticks = asyncio.ensure_future(self._tick())

    async def _tick(self) -> None:
        """Tell pages what time it is, as long as they do not hear that by a view."""
        while True:
            await asyncio.sleep(TICK)
            now = self._present() if self._pages else None
            if now is not None:
                self._send_text(json.dumps({"type": "tick", "now": now}))

    async def end(self) -> None:
        """Close every page with the reason, and all connections."""
        if self._server is not None and self._ticks is not None:
            self._ticks.cancel()
            self._server.stop()
            for page in list(self._pages):
                page.close(1000, self._why)
            await asyncio.sleep(0.2)
            await self._server.close_all_connections()

    def _send_text(self, text: str) -> None:
        for page in list(self._pages):
            page.send_text(text)

    def file(self, path: str) -> Any:
        """The content of a file, and what it is."""
        return self._files[path]

    def add_page(self, page: "PageSocket") -> bool:
        """Add a page that has connected; return False if there are too many: none goes for it, it would come back."""
        address = str(page.request.remote_ip)
        if self._pages.victim(address) is not None:
            return False
        self._pages.take(page, address)
        return True

    def remove_page(self, page: "PageSocket") -> None:
        """Remove a page that has disconnected."""
        self._pages.free(page)

    def trust(self, request: Any) -> None:
        """Keep the connection of somebody who knows the token, as long as others can go instead."""
        if self._server is not None:
            self._server.trust(request)

    def key(self) -> str:
        """What the cookie holds: not the token itself, and the same after a restart with the same token."""
        return hashlib.sha256(b"pursue ui " + self.token.encode()).hexdigest()

    def serves(self, netloc: str) -> bool:
        """True where `Host` names this machine: its address, or a name that nobody else can point to it."""
        try:
            name = urlsplit(f"//{netloc}").hostname or ""
        except ValueError:
            return False
        own = socket.gethostname().lower()
        return is_address(name) or name in {"localhost", self.host.lower(), own, f"{own}.local"}


def _own_address() -> str:
    """The address that others reach this machine at, as far as it knows."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))  # an address for documentation: nothing is sent
            return str(probe.getsockname()[0])
        except OSError:
            return socket.gethostname()


class _Requests(Application):
    def find_handler(self, request: Any, **more: Any) -> Any:
        """Called with the head of a request, before anything of its body is read."""
        if drop_chunks(request.headers):
            request.headers.pop("Content-Length", None)
            return self.get_handler_delegate(request, Chunked, self.settings["default_handler_args"])
        return super().find_handler(request, **more)


# What is served -------------------------------------------------------------------------------------------------------


class Guarded(RequestHandler):
    """What all requests have in common: who may, the headers, and pages that say why not."""

    web: Web

    def initialize(self, web: Web) -> None:
        self.web = web

    def set_default_headers(self) -> None:
        """Nothing but our own files and our own WebSocket; nothing is kept; nobody frames us."""
        live = " ".join(f"{scheme}://{self.request.host}" for scheme in ("ws", "wss"))
        connect = f"'self' {live}" if re.fullmatch(r"[\w.:\[\]-]+", self.request.host, re.ASCII) else "'self'"
        self.set_header(
            "Content-Security-Policy",
            f"default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src {connect}; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
        )
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("X-Frame-Options", "DENY")
        self.set_header("Referrer-Policy", "no-referrer")
        self.set_header("Cross-Origin-Resource-Policy", "same-origin")
        self.set_header("Cache-Control", "no-store")
        self.clear_header("Server")

    def prepare(self) -> None:
        """Who may."""
        if not self.web.serves(self.request.host):
            raise HTTPError(403)
        if not self.web.token:  # nobody has shown anything: the oldest goes first, so that whoever comes gets in
            return
        given = self.get_query_argument("token", None)
        if given is not None:
            if not _same(given, self.web.token):
                raise HTTPError(403)
        elif not _same(self.get_cookie(self.web.cookie) or "", self.web.key()):
            raise HTTPError(401)
        self.web.trust(self.request)

    def write_error(self, status_code: int, **_: Any) -> None:
        """A page that says why."""
        why = html.escape(ERROR_TEXTS.get(status_code, "Something went wrong."))
        self.finish(f"<!DOCTYPE html><html lang=en><title>{status_code}</title><h1>{why}</h1>")

    def log_exception(self, *_: Any) -> None:
        """Log nothing: refused requests are normal, and clients must not write to the terminal."""


class Chunked(Guarded):
    """Whatever came with chunks: they are not read, and the connection ends with the answer."""

    def set_default_headers(self) -> None:
        """As of all."""
        super().set_default_headers()
        self.set_header("Connection", "close")

    def prepare(self) -> None:
        """Nobody may."""
        raise HTTPError(411)

    def on_finish(self) -> None:
        """What follows is a body that was not read, and no request."""
        connection: Any = self.request.connection
        connection.stream.close()


class File(Guarded):
    """A file of the page."""

    def get(self) -> None:
        """The file; a token in the address becomes a cookie, and leaves the address."""
        if self.web.token and self.get_query_argument("token", None) is not None:
            # Lax: with Strict the cookie would not come along where a link in another page led here.
            self.set_cookie(self.web.cookie, self.web.key(), httponly=True, samesite="Lax")
            self.redirect(self.request.path, status=303)
            return
        content, kind = self.web.file(self.request.path)
        self.set_header("Content-Type", f"{kind}; charset=utf-8")
        self.finish(content)


class NotFound(Guarded):
    """Everything else."""

    def prepare(self) -> None:
        """Those who may are told that there is nothing."""
        super().prepare()
        raise HTTPError(404)


class PageSocket(Guarded, WebSocketHandler):
    """The WebSocket of one page."""

    def prepare(self) -> None:
        """Browsers tell which page opens a WebSocket; only our own may."""
        super().prepare()
        origin = urlsplit(self.request.headers.get("Origin", ""))
        if origin.scheme not in ("http", "https") or origin.netloc.lower() != self.request.host.lower():
            raise HTTPError(403)
        self.junk = 0

    def check_origin(self, origin: str) -> bool:
        """Checked above, also where there is none."""
        return True

    def open(self, *_: str, **__: str) -> None:
        """Send the first message to a page that has connected."""
        if not self.web.add_page(self):
            self.close(1013, "too many pages")
            return
        assert self.ws_connection is not None and self.ws_connection.stream is not None
        self.ws_connection.stream.max_write_buffer_size = MAX_BACKLOG
        self.send_text(json.dumps(self.web.first_message(), allow_nan=False))

    def on_message(self, message: Any) -> None:
        """Pass a page's message to the node, and answer with its remark."""
        if message == ALIVE:
            self.send_text(json.dumps({"type": "alive"}))
            return
        try:
            remark = self.web.on_message(message)
        except ValueError as problem:
            self.junk += 1
            remark = str(problem)
        if self.junk >= MAX_INVALID:
            self.close(1008, "too much that cannot be understood")
        elif remark:
            self.send_text(json.dumps({"type": "remark", "text": remark}))

    def on_close(self) -> None:
        """Remove a page that has disconnected."""
        self.web.remove_page(self)

    def send_text(self, text: str) -> None:
        """Send a text; a page that is too far behind is closed, and connects again by itself."""
        try:
            sent = self.write_message(text)
        except WebSocketClosedError:
            self.web.remove_page(self)
        except StreamBufferFullError:
            self.web.remove_page(self)
            self.close(1013, "too far behind")
        else:
            sent.add_done_callback(lambda done: done.cancelled() or done.exception())  # it has gone: on_close says so


def _same(given: str, expected: str) -> bool:
    return hmac.compare_digest(given.encode(), expected.encode())
