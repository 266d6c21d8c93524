"""A robot's communication_manager and pursue_reader in a thread, without ROS, with faults where a test wants them."""

from __future__ import annotations

import contextlib
import datetime
import hashlib
import ipaddress
import json
import ssl
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple

from cryptography import x509
from cryptography.hazmat.backends import default_backend
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat

from pursue_gen.tools.transport.client import Robot
from pursue_runtime.bundle import (
    ABORT,
    COMMIT,
    PREPARE,
    Order,
    Refused,
    fingerprint,
    new_ticket,
    pack,
    read_order,
    unpack,
)
from pursue_runtime.manifest import OWN, make_manifest
from tests.waiting import PATIENCE

KEY = Ed25519PrivateKey.from_private_bytes(bytes(range(32)))
STRANGER = Ed25519PrivateKey.from_private_bytes(bytes(32))
PACKAGES = ("UI", "controller_bot1", "controller_bot2", "observer")

CUT, LOST, GONE, BUSY, LATE, REFUSED, SLOW = "cut", "lost", "gone", "busy", "late", "refused", "slow"
"""Faults: cut off before it is done; done, but the answer is lost; dead from now on; 503; 409; 422; 504, and it is done
after the next request."""

Fault = Callable[[str, int], Optional[str]]
"""What goes wrong with a request: from what it is about (`health`, `prepare` …) and its number among all."""


def bundle(
    scenario: str = "catch", key: Ed25519PrivateKey = KEY, packages: Sequence[str] = PACKAGES
) -> Tuple[str, bytes]:
    """A mission's digest, and its bundle."""
    files = {f"{package}/model.yaml": f"scenario: {scenario}\n".encode() * 2000 for package in packages}
    manifest = make_manifest(scenario, "1.0", ("controller_bot1", "controller_bot2"), files)
    return manifest.digest, pack(manifest, files, key)


class FakeRobot:
    """Follows the contract of transport; `requests` are those that it has read."""

    def __init__(self, name: str, packages: Sequence[str] = (), fault: Optional[Fault] = None) -> None:
        self.name, self.packages, self.fault = name, list(packages), fault or (lambda what, number: None)
        self.ticket = new_ticket()
        self.current = OWN
        self.next: Optional[str] = None
        self.prepared: Optional[str] = None
        self.kept: List[str] = []
        self.history: List[str] = []
        self.runs = False
        self.limit = 10**6
        self.requests: List[str] = []
        self.uploads = 0
        self.dead = False
        self.slow: List[Tuple[str, bytes]] = []
        self.lock = threading.Lock()
        self.on_change: Callable[[], None] = lambda: None
        self.unplug: Callable[[], None] = lambda: None

    def status(self) -> Dict[str, Any]:
        return {
            "format": 1, "robot": self.name, "ticket": self.ticket, "current": self.current, "next": self.next,
            "prepared": self.prepared, "kept": self.kept, "history": self.history, "scenario": "catch",
            "packages": self.packages, "mission_runs": self.runs, "limit": self.limit, "answer": None,
        }  # fmt: skip

    @property
    def standing(self) -> str:
        return self.current if self.next is None else self.next

    def has(self, mission: str) -> bool:
        return mission == OWN or mission in self.kept

    def end_mission(self) -> None:
        """The mission under way is over."""
        self.runs = False
        if self.next is not None:
            self._swap(self.next)

    def post(self, text: str, body: bytes) -> Tuple[int, str]:
        """HTTP's status, and why."""
        try:
            order = read_order(text, {fingerprint(KEY.public_key()): KEY.public_key()})
        except Refused as refused:
            return (401 if refused.code in ("unknown_key", "bad_signature") else 400), str(refused)
        if order.robot != self.name:
            return 403, "not my name"
        if order.ticket != self.ticket:
            return 409, "this ticket is not out"
        if len(body) != order.size or (body and hashlib.sha256(body).hexdigest() != order.bundle):
            return 400, "not the body that was announced"
        self.ticket = new_ticket()
        return self._do(order, body)

    def _do(self, order: Order, body: bytes) -> Tuple[int, str]:
        if order.action == PREPARE:
            if body:
                self.uploads += 1
                try:
                    digest = unpack(body, {fingerprint(KEY.public_key()): KEY.public_key()}, self.limit).digest
                except Refused as refused:
                    return 422, str(refused)
                if digest != order.mission:
                    return 422, "another mission"
                self.kept = sorted({*self.kept, digest})
            elif not self.has(order.mission):
                return 409, "I do not have this mission"
            self.prepared = order.mission
        elif order.action == COMMIT:
            if order.mission not in (self.prepared, self.current):
                return 409, "this mission is not prepared"
            self.prepared = None
            if order.mission == self.current:
                self.next = None
            elif self.runs:
                self.next = order.mission
            else:
                self._swap(order.mission)
        elif order.action == ABORT:
            self.prepared = None if self.prepared == order.mission else self.prepared
            self.next = None if self.next == order.mission else self.next
            if order.mission not in (self.current, self.next, self.prepared, *self.history):
                self.kept = [mission for mission in self.kept if mission != order.mission]
        self.on_change()
        return 200, ""

    def _swap(self, mission: str) -> None:
        self.history = [*self.history, self.current][-5:]
        self.current, self.next = mission, None


class _Handler(BaseHTTPRequestHandler):
    server: _Server

    def do_GET(self) -> None:
        robot = self.server.robot
        with robot.lock:
            fault = self._fault("health")
            if fault in (CUT, GONE, LOST):
                return
            if fault == BUSY:
                self._say(503, {"reader": False})
            else:
                self._say(200, {**robot.status(), "reader": True})

            self._catch_up()

    def do_POST(self) -> None:
        robot, text = self.server.robot, self.headers["Pursue-Order"]
        body = self.rfile.read(int(self.headers["Content-Length"]))
        with robot.lock:
            fault = self._fault(_action(text))
            if fault in (CUT, GONE):
                return
            if fault == BUSY:
                self._answer(503, "busy")
            elif fault == REFUSED:
                robot.ticket = new_ticket()
                self._answer(422, "the disk is full")
            elif fault == LATE:
                robot.ticket = new_ticket()
                self._answer(409, "this ticket is not out")
            elif fault == SLOW:
                self._answer(504, "the reader has not answered")
                robot.slow.append((text, body))
                return
            else:
                code, why = robot.post(text, body)
                if fault != LOST:
                    self._answer(code, why)
            self._catch_up()

    def _catch_up(self) -> None:
        """Does what was not done in time."""
        robot = self.server.robot
        while robot.slow:
            robot.post(*robot.slow.pop())

    def _fault(self, what: str) -> Optional[str]:
        """The fault of this request; one of a robot that is dead is over before it is read."""
        robot = self.server.robot
        fault = GONE if robot.dead else robot.fault(what, len(robot.requests))
        if not robot.dead:
            robot.requests.append(what)
        robot.dead = fault == GONE
        return fault

    def _answer(self, code: int, why: str) -> None:
        status = self.server.robot.status()
        self._say(code, {"ok": code == 200, "code": "word", "message": why, "status": status})

    def _say(self, code: int, facts: Dict[str, Any]) -> None:
        content = json.dumps(facts).encode()
        with contextlib.suppress(OSError):
            self.send_response(code)
            self.send_header("Content-Length", str(len(content)))
            self.end_headers()
            self.wfile.write(content)

    def log_message(self, *_: Any) -> None:
        pass


class _Server(ThreadingHTTPServer):
    daemon_threads = True
    robot: FakeRobot


def _action(text: str) -> str:
    order = read_order(text, {fingerprint(KEY.public_key()): KEY.public_key(),
                              fingerprint(STRANGER.public_key()): STRANGER.public_key()})  # fmt: skip
    return order.action


@contextlib.contextmanager
def serving(
    robots: Sequence[FakeRobot], timeout: float = PATIENCE, tls: Optional[Path] = None
) -> Iterator[List[Robot]]:
    """The robots on ports of this machine: where they listen."""
    with contextlib.ExitStack() as stack:
        places = []
        for robot in robots:
            server = _Server(("127.0.0.1", 0), _Handler)
            server.robot = robot
            if tls is not None:
                context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
                context.load_cert_chain(str(tls))
                server.socket = context.wrap_socket(server.socket, server_side=True)
            robot.unplug = _serve(stack, server)
            places.append(Robot(robot.name, "127.0.0.1", server.server_address[1], tls is not None, tls, timeout))
        yield places


@contextlib.contextmanager
def saying(answer: bytes, pause: float = 0.0, times: int = 1, wait: float = 0.0) -> Iterator[int]:
    """A port where these bytes are answered, whatever is asked, after a while; so many times, with pauses between; at
    the end it does not wait any longer."""
    over = threading.Event()

    class Junk(BaseHTTPRequestHandler):
        def handle(self) -> None:
            with contextlib.suppress(OSError):
                self.request.recv(65536)
                over.wait(wait)
                for _ in range(times):
                    self.request.sendall(answer)
                    if over.wait(pause):
                        break

    with contextlib.ExitStack() as stack:
        server = ThreadingHTTPServer(("127.0.0.1", 0), Junk)
        server.daemon_threads = True
        _serve(stack, server)
        stack.callback(over.set)
        yield server.server_address[1]


def _serve(stack: contextlib.ExitStack, server: ThreadingHTTPServer) -> Callable[[], None]:
    """Serves until the stack is left, or until what is returned is called."""
    server.block_on_close = False

    def stop() -> None:
        server.shutdown()
        server.server_close()

    threading.Thread(target=server.serve_forever, args=(0.005,), daemon=True).start()
    stack.callback(stop)
    return stop


def certificate(host: str) -> bytes:
    """A certificate for this name or number that signs itself, with its private key behind it (PEM)."""
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "robot")])
    key = ec.generate_private_key(ec.SECP256R1(), default_backend())
    digits = host.replace(".", "").isdigit()
    alternative = x509.IPAddress(ipaddress.ip_address(host)) if digits else x509.DNSName(host)
    start = datetime.datetime(2020, 1, 1)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(1)
        .not_valid_before(start)
        .not_valid_after(start + datetime.timedelta(days=36500))
        .add_extension(x509.SubjectAlternativeName([alternative]), critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256(), default_backend())
    )
    private = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    return bytes(made.public_bytes(Encoding.PEM)) + bytes(private)
