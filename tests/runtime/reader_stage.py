"""A reader of a robot for tests: a desk with keys, its missions, and a disk with faults."""

from __future__ import annotations

import base64
import errno
import hashlib
import json
import os
import shutil
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Tuple

from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

from pursue_runtime import bundle as desk_bundle
from pursue_runtime.bundle import KeyFolder
from pursue_runtime.manifest import make_manifest
from pursue_runtime.reader import reader as reader_core
from pursue_runtime.reader.contents import StoreState, read_state
from pursue_runtime.reader.reader import Reader
from pursue_runtime.reader.store import Store
from pursue_runtime.state import SystemState

OWN = ""
PATIENCE = 5.0


def key(seed: int) -> Ed25519PrivateKey:
    """One of the desks' keys."""
    return Ed25519PrivateKey.from_private_bytes(bytes([seed]) * 32)


DESK, STRANGER = key(1), key(2)

STRATEGY = b'format: 1\ncommands_agents: [bot1]\nreaction: "1/10"\nstrategy: []\n'
POSES = b'format: 1\ncomputed: false\nposes:\n  "a": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]\n'


class Mission(NamedTuple):
    """A mission's digest, its bundle, and its files."""

    digest: str
    bundle: bytes
    files: Dict[str, bytes]


def mission(
    name: str = "first", more: Optional[Mapping[str, bytes]] = None, signer: Ed25519PrivateKey = DESK
) -> Mission:
    """A small one; `more` replaces or adds files."""
    files = {
        "controller_bot1/strategy.yaml": f"# {name}\n".encode() + STRATEGY,
        "controller_bot1/poses.yaml": POSES,
        "observer/model.yaml": b"not: [of, this, machine]\n",
        **(more or {}),
    }
    manifest = make_manifest(name, "0", ("controller_bot1",), files)
    return Mission(manifest.digest, desk_bundle.pack(manifest, files, signer), files)


def message(
    action: str,
    digest: str,
    ticket: str,
    bundle: bytes = b"",
    robot: str = "bot1",
    signer: Ed25519PrivateKey = DESK,
    **other: Any,
) -> str:
    """What communication_manager publishes for an order; `other` are fields of the order that are wrong."""
    facts = {"size": len(bundle), "bundle": hashlib.sha256(bundle).hexdigest() if bundle else "", **other}
    order = desk_bundle.write_order(desk_bundle.Order(action, digest, robot, ticket, **facts), signer)
    return json.dumps({"order": order, **({"bundle": base64.b64encode(bundle).decode()} if bundle else {})})


class Robot:
    """A robot's reader without ROS; `now` is its clock. `crash` and a new one of the same folder: killed, respawned."""

    def __init__(self, folder: Path, keep: int = 5, packages: Tuple[str, ...] = ("controller_bot1",)) -> None:
        self.folder = folder
        self.now = 100.0
        self.log: List[Tuple[str, str]] = []
        self.tickets: List[str] = []
        self._make = (keep, packages)
        keys = folder / "keys"
        keys.mkdir(parents=True, exist_ok=True)
        (keys / "desk.pub").write_text(desk_bundle.write_public_key(DESK.public_key(), "desk"))
        self.start()

    def start(self) -> None:
        """Starts the reader; whatever has run before is dead."""
        keep, packages = self._make
        folder = self.folder / "missions"
        self.store = Store(str(folder), keep, lambda *line: self.log.append(line))
        facts = reader_core.Machine("bot1", "own_scenario", packages, 10**6)
        keys = KeyFolder(str(self.folder / "keys"))
        log: Callable[..., None] = lambda *line: self.log.append(line)
        self.reader = Reader(facts, self.store, keys, self.now, log, PATIENCE)

    def restart(self) -> None:
        """As after kill -9: nothing is left but the files."""
        self.store.close()
        self.start()

    # What is heard ----------------------------------------------------------------------------------------------------

    def order(self, action: str, digest: str, bundle: bytes = b"", **other: Any) -> Any:
        """A right order; the answer."""
        ticket = self.reader.ticket
        return self.reader.on_message(message(action, digest, ticket, bundle, **other), self.now)

    def send(self, made: Mission) -> None:
        """The mission is prepared and committed, both with success."""
        for action, bundle in (("prepare", made.bundle), ("commit", b"")):
            answer = self.order(action, made.digest, bundle)
            assert answer.ok, answer

    def state(self, status: str, seq: int = 1, stamp: float = 0.0) -> bool:
        """A system state is heard."""
        return bool(self.reader.on_state(SystemState(seq, stamp or self.now, {}, {}, {}, status=status), self.now))

    # What is there ----------------------------------------------------------------------------------------------------

    @property
    def current(self) -> str:
        """The mission that nodes would start with, as the disk says."""
        return str((read_state(str(self.folder / "missions")) or StoreState()).current)

    @property
    def places(self) -> List[str]:
        """What is in the store, by name."""
        return sorted(path.name for path in (self.folder / "missions").iterdir())

    @property
    def said(self) -> str:
        """All of the log."""
        return "\n".join(text for _, text in self.log)


class Crash(BaseException):
    """The process has died here."""


class Disk:
    """Takes the place of `os` (and of shutil) in the store and in `folders`: dies or fails at the n-th change."""

    CHANGES = ("mkdir", "makedirs", "rename", "replace", "write", "fsync", "unlink", "rmtree", "open")

    def __init__(self, at: int, fault: Optional[int] = None) -> None:
        """`fault`: the errno of everything from then on; None: it dies, and nothing works any more."""
        self._left = at
        self._fault = fault
        self.reached = False

    def __getattr__(self, name: str) -> Any:
        real = getattr(shutil if name == "rmtree" else os, name)
        if name not in self.CHANGES:
            return real

        def change(*args: Any, **more: Any) -> Any:
            self._left -= 1
            if self._left < 0:
                first, self.reached = not self.reached, True
                if self._fault is None:
                    if first and name == "write":  # a part of it has come to the disk
                        real(args[0], bytes(args[1])[: len(args[1]) // 2])
                    elif first and name == "rmtree":  # a part of it has gone
                        next(path for path in Path(args[0]).rglob("*") if path.is_file()).unlink()
                    raise Crash(name)
                if self._applies(name, args):
                    raise OSError(self._fault, os.strerror(self._fault))
            return real(*args, **more)

        return change

    def _applies(self, name: str, args: Tuple[Any, ...]) -> bool:
        """A full disk still lets go of files, and opens those that are there."""
        if self._fault == errno.ENOSPC:
            return name in ("mkdir", "makedirs", "write", "fsync") or (name == "open" and bool(args[1] & os.O_CREAT))
        return name != "open" or bool(args[1] & os.O_CREAT)
