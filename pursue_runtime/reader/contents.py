"""What is in a robot's store of missions, read; nothing here changes it. `store.py` has its layout."""

from __future__ import annotations

import errno
import hashlib
import json
import os
from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Tuple

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.bundle import MANIFEST, SIGNATURE, Keys, Refused, check_seal
from pursue_runtime.manifest import MISSION, OWN, is_digest, mission_file, mission_id

STATE = "state.json"

_PASSING = (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EACCES, errno.EPERM, errno.ESTALE, errno.EINTR)


class StoreError(Exception):
    """The disk does not take, or does not give, what it should; the message has the reason."""


class TemporaryError(StoreError):
    """What is on the disk cannot be known at the moment: nothing says that it is damaged."""


class StoreState(NamedTuple):
    """Which mission counts; each is a digest, or OWN.

    `current` is what nodes start with; `next` takes its place when the mission under way is over; `prepared` waits for
    its commit; `history` holds those that were current before, the newest last.
    """

    current: str = OWN
    next: Optional[str] = None
    prepared: Optional[str] = None
    history: Tuple[str, ...] = ()

    def named(self) -> List[str]:
        """The missions that have to be on the disk."""
        return [name for name in (self.current, self.next, self.prepared, *self.history) if name]

    def text(self) -> bytes:
        """As it stands in state.json."""
        return json.dumps({"format": 1, **self._asdict()}, indent=1).encode() + b"\n"


def read_state(folder: str) -> Optional[StoreState]:
    """The state on the disk, None where there is none yet. Raises StoreError where it cannot be used."""
    path = os.path.join(folder, STATE)
    try:
        facts = read_json(read_file(path))
    except FileNotFoundError:
        return None
    except OSError as problem:
        raise StoreError(f"cannot read {path}: {problem.strerror}") from problem
    except BadText as problem:
        raise StoreError(f"{path} is damaged: {problem}") from problem
    state = _state(facts)
    if state is None:
        raise StoreError(f"{path} is damaged, or of another version")
    return state


def _state(facts: Any) -> Optional[StoreState]:
    if not isinstance(facts, dict) or facts.get("format") != 1:
        return None
    current, following, prepared, history = (facts.get(name) for name in StoreState._fields)
    history = history if isinstance(history, list) else [None]
    some = [name for name in (following, prepared) if name is not None]
    if not all(name == OWN or is_digest(name) for name in (current, *history, *some)):
        return None
    return StoreState(str(current), following, prepared, tuple(history))


def stored_digests(folder: str) -> List[str]:
    """The digests of the missions in the store, the oldest first."""
    try:
        return list_digests(folder)
    except OSError:
        return []


def list_digests(folder: str) -> List[str]:
    """The same. Raises OSError."""
    with os.scandir(folder) as entries:
        there = [entry for entry in entries if is_digest(entry.name) and entry.is_dir(follow_symlinks=False)]
    return [entry.name for entry in sorted(there, key=lambda entry: (entry.stat().st_mtime, entry.name))]


def manifest(folder: str, digest: str) -> Dict[str, Any]:
    """What a mission in the store is. Raises StoreError where its manifest is not the one that was signed."""
    try:
        text = read_file(os.path.join(folder, digest, MANIFEST))
    except OSError as problem:
        raise StoreError(f"mission {mission_id(digest)} has no {MANIFEST}: {problem.strerror}") from problem
    if hashlib.sha256(text).hexdigest() != digest:
        raise StoreError(f"the {MANIFEST} of mission {mission_id(digest)} is damaged")
    try:
        facts: Dict[str, Any] = read_json(text)
        good = facts["format"] == 1 and all(type(one) is str for one in [facts["scenario"], *facts["files"].values()])
    except (ValueError, LookupError, TypeError, AttributeError):
        good = False
    if not good:
        raise StoreError(f"mission {mission_id(digest)} is of another version")
    return facts


def is_signed(folder: str, digest: str, keys: Keys) -> bool:
    """True if one of the keys has signed a mission in the store. Raises TemporaryError."""
    try:
        text, seal = (read_file(os.path.join(folder, digest, name)) for name in (MANIFEST, SIGNATURE))
        check_seal(text, seal, keys)
    except (OSError, Refused):
        return False
    return True


def find_damage(folder: str, digest: str) -> str:
    """What is wrong with a mission in the store: a sentence, "" if it is whole. Raises NotNow."""
    try:
        facts = manifest(folder, digest)
        place = os.path.join(folder, digest)
        for path, expected in facts["files"].items():
            if hashlib.sha256(read_file(inside(place, path))).hexdigest() != expected:
                raise StoreError(f"{path} is damaged")
        for package in packages_of(facts["files"]):
            if read_file(inside(place, f"{package}/{MISSION}")) != mission_file(digest, facts["scenario"]):
                raise StoreError(f"{package}/{MISSION} is damaged")
    except (StoreError, OSError) as problem:
        if isinstance(problem, TemporaryError):
            raise
        return f"mission {mission_id(digest)} is not whole: {problem}"
    return ""


def table(folder: str, own: str) -> List[Tuple[str, str, str]]:
    """The missions of a machine for people: short name, scenario, what it is. `own` is the workspace's scenario.

    Raises StoreError.
    """
    state = read_state(folder) or StoreState()
    rows = []
    for digest in (OWN, *stored_digests(folder)):
        roles = ((state.current, "current"), (state.next, "next, when no mission runs"), (state.prepared, "prepared"))
        shown = [role for name, role in roles if name == digest] or ["earlier" if digest in state.history else "kept"]
        wrong = find_damage(folder, digest) if digest else ""
        scenario = own if not digest else "?" if wrong else str(manifest(folder, digest)["scenario"])
        what = "the workspace's own; " if not digest else ""
        rows.append((mission_id(digest), scenario, what + "; ".join([*shown, *([wrong] if wrong else [])])))
    return rows


def read_file(path: str) -> bytes:
    """Raises OSError where the file is not there or damaged, NotNow where that cannot be known."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as problem:
        if problem.errno in _PASSING:
            raise TemporaryError(f"cannot read {path} now: {problem.strerror}") from problem
        raise


def packages_of(files: Iterable[str]) -> List[str]:
    """The packages that these files are for, sorted."""
    return sorted({path.split("/")[0] for path in files})


def inside(folder: str, path: str) -> str:
    """The place of a file in a folder. Raises StoreError for one that is elsewhere, whatever its name says."""
    place, home = os.path.realpath(os.path.join(folder, path)), os.path.realpath(folder)
    if not place.startswith(home + os.sep):
        raise StoreError(f"{path!r} is not in the folder of its mission")
    return place
