"""The HTTP server of communication_manager: /health, and /mission for orders with their bundles.

    GET /health      200 the status of pursue_reader, with "reader": true; 503 with "reader": false
    POST /mission    header Pursue-Order: what to do, signed; body: the bundle that the order is about, or nothing

It is safe on untrusted networks. An order is checked by its header, before a byte of the body is read;
orders are taken one at a time; a connection brings one request, and ends after a time whatever it does.
"""

from __future__ import annotations

import asyncio
import json
import re
import ssl
import sys
from dataclasses import dataclass
from typing import Any, Callable, List, Mapping, Optional, Tuple

from tornado.web import Application, HTTPError, RequestHandler, stream_request_body

from pursue_runtime.bundle import Order
from pursue_runtime.http_server import LimitedServer, ServerError, Service, drop_chunks
from pursue_runtime.manager.manager import (
    HTTP,
    LONGEST_HEADER,
    HttpAnswer,
    Manager,
    RequestLog,
    RequestRefused,
    check_bundle,
    mission_message,
    parse_length,
)
from pursue_runtime.manifest import mission_id

HEALTH, MISSION = "/health", "/mission"
MAX_DISCARDED = 1 << 20  # bytes of a refused body that are read and thrown away, so that the client receives the answer
DISCARD_TIME = 2.0  # seconds that this may take
_HOST = re.compile(r"[A-Za-z0-9_.:%\[\]-]{1,255}", re.ASCII)


@dataclass(frozen=True)
class Limits:
    """How long clients may take, in seconds, and how many there may be.

    `patience` is for the reader's answer, `header` for a request's head, `upload` for a whole body; a body comes with
    `rate` bytes a second at least, counted over `window` seconds.
    """

    connections: int = 64
    patience: float = 10.0
    header: float = 5.0
    upload: float = 300.0
    rate: float = 4096.0
    window: float = 5.0

    @property
    def longest(self) -> float:
        """Seconds after which a connection ends in any case."""
        return self.header + self.upload + self.patience + DISCARD_TIME + 1.0


def tls(certificate: str, private_key: str) -> Optional[ssl.SSLContext]:
    """TLS 1.2 or newer with this certificate and its key (PEM files); None without. Raises ServerError."""
    if not certificate:
        if private_key:
            raise ServerError("--private_key needs --certificate: give both, or none for HTTP without TLS")
        return None
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    try:
        # With a password for the key, the library would ask for it on the terminal.
        context.load_cert_chain(certificate, private_key or None, password=lambda: b"")
    except (OSError, ValueError) as problem:
        files = ", ".join(filter(None, (certificate, private_key)))
        hint = "--certificate and --private_key are PEM files that belong together, the key without a password"
        raise ServerError(f"cannot use {files}: {problem}; {hint}") from problem
    return context


class Server(Service):
    """Serves on sockets that are bound; lives in the loop, but for the constructor."""

    def __init__(
        self,
        manager: Manager,
        sockets: List[Any],
        publish: Callable[[str], None],
        record: RequestLog,
        limits: Limits,
        context: Optional[ssl.SSLContext] = None,
    ) -> None:
        """`publish` sends a text to the reader."""
        self.manager, self.record, self.limits = manager, record, limits
        self.port = int(sockets[0].getsockname()[1])
        self.busy = False
        self._sockets, self._publish, self._context = sockets, publish, context
        self._waiting: Optional[Tuple[str, "asyncio.Future[HttpAnswer]"]] = None
        self._server: Optional[LimitedServer] = None

    def open(self) -> None:
        """Serves from now on."""
        application = Application([(r".*", _Request, {"server": self})], log_function=self._log)
        self._server = LimitedServer(
            application, ssl_options=self._context, no_keep_alive=True, chunk_size=1 << 16,
            max_header_size=LONGEST_HEADER, max_body_size=sys.maxsize, max_buffer_size=1 << 18,
            idle_connection_timeout=self.limits.header,
        )
        self._server.limit(self.limits.connections, self.limits.longest, self._on_refused)
        self._server.add_sockets(self._sockets)

    async def end(self) -> None:
        """Ends all connections."""
        if self._server is not None:
            self._server.stop()
            self._server.close_all()
            await asyncio.sleep(0)

    def on_status(self, text: str) -> None:
        """A status of the reader."""
        self.manager.on_status(text)
        if self._waiting is not None:
            ticket, future = self._waiting
            answer = self.manager.answer_to(ticket)
            if answer is not None and not future.done():
                future.set_result(answer)

    async def deliver(self, text: str, order: Order, body: bytes) -> HttpAnswer:
        """Publish the order for the reader, and wait for its answer. Raises RequestRefused."""
        check_bundle(order, body)
        self.manager.check_ticket(order)  # once more: the body may have taken its time
        future: "asyncio.Future[HttpAnswer]" = asyncio.get_running_loop().create_future()
        self._waiting = (order.ticket, future)
        try:
            self._publish(mission_message(text, body))
            return await asyncio.wait_for(future, self.limits.patience)
        except asyncio.TimeoutError:
            message = f"pursue_reader has not answered within {self.limits.patience:g} s"
            raise RequestRefused("no_answer", message) from None
        finally:
            self._waiting = None

    def trust(self, request: Any) -> None:
        """Keep the connection of an order that was checked, as long as others can go instead."""
        if self._server is not None:
            self._server.trust(request)

    def _on_refused(self) -> None:
        self.record.count("turned away", "too many connections: one was closed")

    def _log(self, handler: RequestHandler) -> None:
        """Every request that was answered."""
        ip, http = handler.request.remote_ip, str(handler.get_status())
        answer, done = (handler.sent, handler.done) if isinstance(handler, _Request) else (None, "")
        if answer is None:
            self.record.count(http)
        elif done:
            self.record.log(http, f"{ip}: {done}: {answer.message}")
        else:
            # Only words of our own, and what is quoted: texts of clients are not logged as they are.
            self.record.count(http, f"{ip}: refused: {answer.code}, {answer.message}")


@stream_request_body
class _Request(RequestHandler):
    """One request, from its head on."""

    def initialize(self, server: Server) -> None:
        """Before anything else."""
        self.server = server
        self.sent: Optional[HttpAnswer] = None
        self.done = ""  # what an order that was taken has done
        self.body = bytearray()
        self.order: Optional[Order] = None  # one that was taken
        self.length = self.discarded = self.seen = 0
        self.timers: List[asyncio.TimerHandle] = []
        self.chunked = drop_chunks(self.request.headers)

    def set_default_headers(self) -> None:
        """JSON, for programs; nothing about what serves here."""
        self.clear_header("Server")
        self.set_header("Content-Type", "application/json")
        self.set_header("Cache-Control", "no-store")
        self.set_header("X-Content-Type-Options", "nosniff")

    def compute_etag(self) -> None:
        """There is nothing to compare: each answer is new."""

    async def prepare(self) -> None:
        """The head is here, the body is not."""
        connection: Any = self.request.connection
        if connection.stream.closed():  # tornado goes on with what came behind the first request
            self.set_status(HTTP["bad_request"])
            self.finish()
            return
        try:
            self._check_head()
        except RequestRefused as refused:
            await self._refuse(refused.answer)

    def _check_head(self) -> None:
        headers, method = self.request.headers, str(self.request.method)
        hosts = headers.get_list("Host")
        if len(hosts) > 1 or (hosts and not _HOST.fullmatch(hosts[0])):
            raise RequestRefused("bad_request", "the header Host is not right")
        length = parse_length(headers.get("Content-Length"))
        self.length = length or 0
        self.server.manager.check_trust()
        wanted = {HEALTH: "GET", MISSION: "POST"}.get(self.request.path)
        if wanted is None:
            raise RequestRefused("not_found", f"there is nothing here but {HEALTH} and {MISSION}")
        if method != wanted:
            raise RequestRefused("bad_method", f"{self.request.path} takes {wanted}")
        if wanted == "GET":
            if self.chunked or self.length:
                raise RequestRefused("bad_request", f"{HEALTH} takes no body")
            return
        order = self.server.manager.check_order(headers.get("Pursue-Order"), length, self.chunked)
        if self.server.busy:
            raise RequestRefused("busy", "another order is under way: try again")
        self.order, self.server.busy = order, True
        self.server.trust(self.request)
        loop, limits = asyncio.get_running_loop(), self.server.limits
        self.timers = [loop.call_later(limits.upload, self._too_slow), loop.call_later(limits.window, self._check_rate)]

    def data_received(self, chunk: bytes) -> None:
        """A part of the body."""
        if self.order is not None:
            self.body += chunk
            return
        self.discarded += len(chunk)
        if self.discarded > MAX_DISCARDED and not self._finished:
            self.finish()

    async def answer(self) -> None:
        """All of it is here."""
        self._stop_timers()
        if self.sent is not None:  # it was refused, and what was left of it has been read
            if not self._finished:
                self.finish()
        elif self.order is not None:
            await self._answer_order(self.order)
        else:
            http, facts = self.server.manager.health()
            self.set_status(http)
            self.finish(json.dumps(facts))

    get = head = post = put = delete = patch = options = answer  # prepare has seen to it that it is one that is taken

    async def _answer_order(self, order: Order) -> None:
        body, self.body = bytes(self.body), bytearray()
        try:
            answer = await self.server.deliver(self.request.headers["Pursue-Order"], order, body)
        except RequestRefused as refused:
            answer = refused.answer
        finally:
            self.server.busy = False
        if answer.ok:
            self.done = f"{order.action}, mission {mission_id(order.mission)}"
        self._send(answer)
        self.finish()

    def on_connection_close(self) -> None:
        """The client has gone before it was answered; an order that the reader has got goes its way."""
        if self.timers:
            self._abort_upload()
            self.server.record.count("broken off")
        super().on_connection_close()

    # How it ends otherwise --------------------------------------------------------------------------------------------

    async def _refuse(self, answer: HttpAnswer) -> None:
        """Refuse and close; a part of the body is read, since the client would not receive the answer otherwise."""
        self.set_header("Connection", "close")
        self._send(answer)
        headers = self.request.headers
        if not self.length or "Expect" in headers or self.chunked or self.request.method == "HEAD":
            self.finish()
            return
        connection: Any = self.request.connection
        connection.set_body_timeout(DISCARD_TIME)
        self.flush()

    def _send(self, answer: HttpAnswer, status: Optional[Mapping[str, Any]] = None) -> None:
        self.sent = answer
        status = self.server.manager.status() if status is None else status
        facts = {"ok": answer.ok, "code": answer.code, "message": answer.message, "status": status}
        text = json.dumps(facts).encode()
        self.set_status(answer.http)
        self.set_header("Content-Length", str(len(text)))
        self.write(text)

    def _check_rate(self) -> None:
        """Is the body coming fast enough?"""
        limits, here = self.server.limits, len(self.body)
        if here - self.seen < limits.rate * limits.window:
            self._too_slow()
            return
        self.seen = here
        self.timers[1] = asyncio.get_running_loop().call_later(limits.window, self._check_rate)

    def _too_slow(self) -> None:
        self._abort_upload()
        self._send(HttpAnswer(HTTP["too_slow"], "too_slow", "the bundle comes too slowly"))
        self.finish()

    def _abort_upload(self) -> None:
        """An upload that did not come to its end: others may try."""
        self._stop_timers()
        self.body, self.order, self.server.busy = bytearray(), None, False

    def _stop_timers(self) -> None:
        for timer in self.timers:
            timer.cancel()
        self.timers = []

    # Mistakes ---------------------------------------------------------------------------------------------------------

    def write_error(self, status_code: int, **_: Any) -> None:
        """What tornado refuses by itself, or our own mistake: no details are returned."""
        words = {405: "bad_method", 500: "internal"}
        message = "something went wrong here" if status_code >= 500 else "the request cannot be understood"
        self._send(HttpAnswer(status_code, words.get(status_code, "bad_request"), message), {})
        self.finish()

    def log_exception(self, kind: Any, problem: Any, trace: Any) -> None:
        """Our own mistakes are worth a line."""
        if isinstance(problem, HTTPError):
            return
        while trace is not None and trace.tb_next is not None:
            trace = trace.tb_next
        where = f"{trace.tb_frame.f_code.co_name}, line {trace.tb_lineno}" if trace is not None else "nowhere"
        self.server.record.count("errors", f"a request failed in {where}: {problem!r}"[:1000])
