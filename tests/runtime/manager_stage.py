"""A server of communication_manager for tests: a robot's reader that answers it, and desks that send."""

from __future__ import annotations

import hashlib
import json
import ssl
import threading
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional

import pytest
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from pursue_runtime import bundle as mission_bundle
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.http_server import Background, bind
from pursue_runtime.manager.manager import Manager, RequestLog
from pursue_runtime.manager.server import Limits, Server
from pursue_runtime.manifest import make_manifest
from tests.waiting import PATIENCE, connected, may_close, rest

pytest.importorskip("tornado", reason="tornado is not installed")


ROBOT = "bot1"
FILES = {"observer/model.yaml": b"format: 1\n", "controller_bot1/strategy.yaml": b"format: 1\nstrategy: []\n"}


class Desk:
    """Somebody with a key: makes bundles and orders."""

    def __init__(self, seed: int = 1) -> None:
        self.key = Ed25519PrivateKey.from_private_bytes(bytes([seed]) * 32)

    def trusted_by(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        text = mission_bundle.write_public_key(self.key.public_key(), "desk")
        (folder / f"{mission_bundle.fingerprint(self.key.public_key())}.pub").write_text(text)

    def bundle(self, scenario: str = "example", files: Mapping[str, bytes] = FILES) -> "Sent":
        manifest = make_manifest(scenario, "0", ("controller_bot1",), files)
        return Sent(manifest.digest, mission_bundle.pack(manifest, files, self.key))

    def order(self, ticket: str, action: str = "prepare", mission: str = "a" * 64, body: bytes = b"",
              robot: str = ROBOT, **more: Any) -> str:
        facts = {"size": len(body), "bundle": hashlib.sha256(body).hexdigest() if body else "", **more}
        return mission_bundle.write_order(mission_bundle.Order(action, mission, robot, ticket, **facts), self.key)


class Sent(NamedTuple):
    """A mission's digest, and its bundle."""

    digest: str
    content: bytes


class Reader:
    """Stands for pursue_reader: takes every order that is rightly signed, and remembers what it got."""

    def __init__(self, keys: Path, say: Callable[[str], None], answers: bool = True) -> None:
        self.keys, self.say, self.answers, self.there = keys, say, answers, True
        self.ticket = mission_bundle.new_ticket()
        self.prepared: List[str] = []
        self.messages: List[Dict[str, str]] = []
        self.verdict = {"ok": True, "code": "prepared", "message": "the mission is here"}

    def status(self, answer: Optional[Mapping[str, Any]] = None) -> str:
        return json.dumps({
            "format": 1, "robot": ROBOT, "ticket": self.ticket, "current": "", "next": None, "prepared": None,
            "kept": self.prepared, "history": [], "scenario": "example", "packages": ["observer"],
            "mission_runs": False, "limit": mission_bundle.LIMIT, "answer": answer,
        })

    def hear(self, text: str) -> None:
        answers = self.answers  # as it was when the message came: nobody waits for this thread
        self.messages.append(json.loads(text))
        if not answers:
            return
        keys, _ = mission_bundle.read_keys(str(self.keys))
        order = mission_bundle.read_order(self.messages[-1]["order"], keys)
        answer = {"ticket": order.ticket, **self.verdict}
        self.ticket = mission_bundle.new_ticket()
        if order.mission:
            self.prepared.append(order.mission)
        self.say(self.status(answer))


class Robot:
    """A server with its reader, on a free port of this machine. It is patient, unless `options` say otherwise."""

    def __init__(self, folder: Path, reader: Any = None, **options: Any) -> None:
        self.keys = folder / "keys"
        self.lines: List[str] = []
        self.notes: List[str] = []
        self.record = RequestLog(self.lines.append, self.notes.append)
        self.reader = (reader or Reader)(self.keys, self.say)
        exposed, limit = options.pop("exposed", False), options.pop("limit", mission_bundle.LIMIT)
        there = options.pop("there", lambda: bool(self.reader.there))
        self.manager = Manager(ROBOT, KeyFolder(str(self.keys)), there, limit, exposed)
        sockets = bind("127.0.0.1", 0, "~port")
        context = options.pop("context", None)
        patient = dict.fromkeys(("patience", "header", "window"), PATIENCE)
        limits = Limits(**{**patient, **options})
        self.server = Server(self.manager, sockets, self.publish, self.record, limits, context)
        self.background = Background((self.server,), self.record.count)
        self.background.start()
        self.say(self.reader.status())

    @property
    def port(self) -> int:
        return int(self.server.port)

    def say(self, text: str) -> None:
        self.background.call(self.server.on_status, text)

    def publish(self, text: str) -> None:
        """As ROS does: in another thread."""
        threading.Thread(target=self.reader.hear, args=(text,), daemon=True).start()

    def close(self) -> None:
        self.background.close()


class Told(NamedTuple):
    """An answer of the server: status, headers, JSON; status 0 where the connection was closed without one."""

    http: int
    headers: Dict[str, str]
    facts: Dict[str, Any]


def exchange(port: int, data: bytes, more: bytes = b"", tls: Optional[ssl.SSLContext] = None) -> bytes:
    """Sends bytes, and more, and reads until the server closes, which may be before it has got all."""
    there = connected(port)
    try:
        if tls is not None:
            there = tls.wrap_socket(there, server_hostname="127.0.0.1")
        with may_close():
            there.sendall(data)
            if more:
                there.sendall(more)
        return rest(there)
    finally:
        there.close()


def parse(answer: bytes) -> Told:
    head, _, body = answer.partition(b"\r\n\r\n")
    lines = head.decode("latin1").split("\r\n")
    if not lines[0].startswith("HTTP/1.1 "):
        return Told(0, {}, {})
    headers = dict(line.split(": ", 1) for line in lines[1:])
    return Told(int(lines[0].split()[1]), headers, json.loads(body) if body else {})


def head(path: str = "/mission", method: str = "POST", **headers: object) -> bytes:
    """A request's head; `Content_Length=3` writes Content-Length."""
    lines = [f"{method} {path} HTTP/1.1", *(f"{key.replace('_', '-')}: {value}" for key, value in headers.items())]
    return ("\r\n".join([*lines, "Host: robot"]) + "\r\n\r\n").encode("latin1")


def ask(robot: Any, path: str = "/health", method: str = "GET", body: bytes = b"", **headers: object) -> Told:
    """One request, as a client sends it."""
    return parse(exchange(robot.port, head(path, method, **headers) + body))


def send(robot: Any, order: str, body: bytes = b"", tls: Optional[ssl.SSLContext] = None) -> Told:
    """An order with its bundle."""
    return parse(exchange(robot.port, head(Content_Length=len(body), Pursue_Order=order), body, tls))
