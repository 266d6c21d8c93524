"""One robot, over HTTP: its health, and an order for it (thesis: MissionSender). Its answers are not trusted.

Nothing is followed elsewhere, an answer has at most ANSWER_LIMIT bytes, and each exchange ends in time, however slow
the other side is.
"""

from __future__ import annotations

import contextlib
import http.client
import socket
import ssl
import threading
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterator, List, Mapping, Optional, Tuple

from pursue_runtime.bounded import json_object
from pursue_runtime.manifest import OWN, is_digest

PORT = 13000
"""Where communication_manager listens (thesis: Rest2Ros)."""
ANSWER_LIMIT = 2**20
"""Bytes of an answer that are read."""

_CHUNK = 16 * 1024
_SLOWEST = 16 * 1024
"""Bytes per second: who takes a bundle more slowly is given up."""
_READER = 10.0
"""Seconds that a communication_manager waits for its pursue_reader; added to the timeout where that is asked."""
_WORDS = 300
"""Letters of a robot's text that are shown."""

Listener = Callable[[int], None]
"""Called with how many bytes of a bundle have been sent."""


@dataclass(frozen=True)
class Robot:
    """Where a robot listens. `timeout` is in seconds; `ca` the certificate that the robot's own must come from."""

    name: str
    host: str
    port: int = PORT
    tls: bool = False
    ca: Optional[Path] = None
    timeout: float = 5.0

    @property
    def address(self) -> str:
        """For people."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{'https://' if self.tls else ''}{host}:{self.port}"


@dataclass(frozen=True)
class Status:
    """The status that a robot's reader reports; missions are digests, OWN the workspace's.

    `current` is what its nodes start with, `next` what follows when the mission under way has ended, `prepared` what
    an order to commit would make so; `kept` are in its store, `history` its earlier ones, newest last; `packages` those
    for missions on this machine; `limit` the largest bundle it takes, in bytes.
    """

    robot: str
    ticket: str
    current: str
    next: Optional[str]
    prepared: Optional[str]
    kept: Tuple[str, ...]
    history: Tuple[str, ...]
    scenario: str
    packages: Tuple[str, ...]
    mission_runs: bool
    limit: int

    @property
    def standing(self) -> str:
        """The mission that it plays from the next start on."""
        return self.current if self.next is None else self.next

    def holds(self, mission: str) -> bool:
        """Whether it has this mission's files."""
        return mission == OWN or mission in (self.current, self.next, self.prepared) or mission in self.kept


@dataclass(frozen=True)
class Answer:
    """A robot's answer to an order; `status` is that after it, where it is reported."""

    http: int
    ok: bool
    code: str
    message: str
    status: Optional[Status]


class Unreached(Exception):
    """No answer that can be used. `sent` where the request may have arrived all the same."""

    def __init__(self, why: str, sent: bool) -> None:
        super().__init__(why)
        self.sent = sent


def health(robot: Robot) -> Status:
    """Queries the status of a robot. Raises Unreached."""
    code, facts = _exchange(robot, "GET", "/health", {}, b"", None)
    if code == 200:
        return _status(facts)
    if code == 503:
        raise Unreached(_why_not(facts), True)
    raise Unreached(f"answers with status {code}: not a robot's communication_manager", True)


def send_order(robot: Robot, order: str, bundle: bytes = b"", listener: Optional[Listener] = None) -> Answer:
    """Sends an order, with a bundle or without. Raises Unreached."""
    code, facts = _exchange(robot, "POST", "/mission", {"Pursue-Order": order}, bundle, listener)
    ok, word, message = facts.get("ok"), facts.get("code"), facts.get("message")
    if not (isinstance(ok, bool) and isinstance(word, str) and isinstance(message, str)):
        raise Unreached(f"answers with status {code}, and not as a robot does", True)
    status = facts.get("status")
    return Answer(code, ok and code == 200, plain(word), plain(message), _status(status) if status else None)


def _why_not(facts: Mapping[str, Any]) -> str:
    """Why a robot does not report its status: its message where there is one, else its code."""
    message, code = (plain(text) if isinstance(text, str) else "" for text in (facts.get("message"), facts.get("code")))
    return message or (f"refuses: {code}" if code else "its pursue_reader is silent")


def plain(text: str) -> str:
    """A robot's text as one line without signs that a terminal would obey."""
    words = " ".join("".join(sign if sign.isprintable() else " " for sign in text[: 2 * _WORDS]).split())
    return words if len(words) <= _WORDS else words[:_WORDS] + "…"


# The exchange ---------------------------------------------------------------------------------------------------------


def _exchange(
    robot: Robot, method: str, path: str, headers: Mapping[str, str], body: bytes, listener: Optional[Listener]
) -> Tuple[int, Mapping[str, Any]]:
    """The answer's status and JSON object."""
    sent = False
    patience = robot.timeout + (_READER if method == "POST" else 0.0)
    seconds = patience + len(body) / _SLOWEST
    late: List[bool] = []
    try:
        with contextlib.closing(socket.create_connection((robot.host, robot.port), robot.timeout)) as plain_socket:
            line = _secured(robot, plain_socket)
            connection = http.client.HTTPConnection(robot.host, robot.port)
            connection.sock = line
            with contextlib.closing(connection), _ended_after(seconds, line, late):
                if isinstance(line, ssl.SSLSocket):
                    line.do_handshake()
                sent = True
                length = {"Content-Length": str(len(body))} if method == "POST" else {}
                chunks = _chunks(body, listener) if body else None
                with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # it may have said why before
                    connection.request(method, path, chunks, {**headers, **length, "Connection": "close"})
                line.settimeout(patience)
                answer = connection.getresponse()
                content = answer.read(ANSWER_LIMIT + 1)
                if answer.length and len(content) <= ANSWER_LIMIT:
                    raise http.client.IncompleteRead(content, answer.length)
    except (OSError, http.client.HTTPException, ValueError) as problem:
        raise Unreached(_reason(problem, bool(late), robot), sent) from problem
    if late:
        raise Unreached("no complete answer in time", sent)
    return answer.status, _object(answer.status, content)


def _secured(robot: Robot, line: socket.socket) -> socket.socket:
    """The connection with TLS around it where that is wanted; the handshake is yet to come."""
    if not robot.tls:
        return line
    context = ssl.create_default_context(cafile=None if robot.ca is None else str(robot.ca))
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    return context.wrap_socket(line, server_hostname=robot.host, do_handshake_on_connect=False)


@contextlib.contextmanager
def _ended_after(seconds: float, line: socket.socket, late: List[bool]) -> Iterator[None]:
    """Cuts the connection after so long: a timeout of the socket alone starts anew with each byte."""

    def cut() -> None:
        late.append(True)
        with contextlib.suppress(OSError):
            socket.socket.shutdown(line, socket.SHUT_RDWR)  # below TLS, whose own would meddle with the reading thread

    watch = threading.Timer(seconds, cut)
    watch.daemon = True
    watch.start()
    try:
        yield
    finally:
        watch.cancel()


def _chunks(body: bytes, listener: Optional[Listener]) -> Iterator[bytes]:
    for start in range(0, len(body), _CHUNK):
        yield body[start : start + _CHUNK]
        if listener is not None:
            listener(min(start + _CHUNK, len(body)))


def _reason(problem: Exception, late: bool, robot: Robot) -> str:
    """Why there is no answer, for people."""
    if late or isinstance(problem, socket.timeout):
        return "no answer in time"
    if isinstance(problem, ssl.SSLCertVerificationError):
        return f"its certificate is not accepted: {problem.verify_message}"
    if isinstance(problem, ssl.SSLError):
        return f"no TLS with it: {problem.reason or 'the connection was cut'}"
    if isinstance(problem, socket.gaierror):
        return f"no machine is called {robot.host}"
    if isinstance(problem, http.client.RemoteDisconnected):
        return "it closed the connection without an answer"
    if isinstance(problem, http.client.IncompleteRead):
        return "its answer is cut off"
    if isinstance(problem, http.client.HTTPException):
        return "its answer is not HTTP"
    return plain(getattr(problem, "strerror", None) or str(problem))[:120].lower()


def _object(code: int, content: bytes) -> Mapping[str, Any]:
    """The answer as a JSON object."""
    if len(content) > ANSWER_LIMIT:
        raise Unreached(f"its answer has more than {ANSWER_LIMIT} bytes", True)
    facts = json_object(content)
    if facts is None:
        raise Unreached(f"answers with status {code}, and not as a robot does", True)
    return facts


# Its status ----------------------------------------------------------------------------------------------------------


def _status(facts: object) -> Status:
    """Checks all that is used. Raises Unreached."""
    if not isinstance(facts, dict):
        raise Unreached("it reports no status", True)
    if facts.get("format") != 1:
        raise Unreached(f"it speaks format {plain(str(facts.get('format')))[:20]} of orders; this is 1", True)
    texts = [facts.get(name) for name in ("robot", "ticket", "scenario")]
    packages, runs, limit = facts.get("packages"), facts.get("mission_runs"), facts.get("limit")
    missions = [facts.get(name) for name in ("current", "next", "prepared")]
    kept, history = facts.get("kept"), facts.get("history")
    good = (
        all(isinstance(text, str) and len(text) <= _WORDS for text in texts)
        and _is_mission(missions[0])
        and all(mission is None or _is_mission(mission) for mission in missions[1:])
        and all(isinstance(several, list) and all(map(_is_mission, several)) for several in (kept, history))
        and isinstance(packages, list)
        and all(isinstance(package, str) for package in packages)
        and isinstance(runs, bool)
        and type(limit) is int
    )
    if not good:
        raise Unreached("a field of its status is missing or has a wrong type", True)
    robot, ticket, scenario = (plain(str(text)) for text in texts)
    return Status(
        robot,
        ticket,
        str(missions[0]),
        missions[1],
        missions[2],
        kept=tuple(kept or ()),
        history=tuple(history or ()),
        scenario=scenario,
        packages=tuple(map(plain, packages or ())),
        mission_runs=bool(runs),
        limit=int(limit or 0),
    )


def _is_mission(value: object) -> bool:
    return value == OWN or is_digest(value)
