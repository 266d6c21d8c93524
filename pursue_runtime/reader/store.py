"""The missions that a robot keeps on its disk, and which of them counts.

In the store's folder: `<digest>/` for each mission, with its manifest, its signature and `<package>/<name>.yaml`; and
`state.json`, which names the one that nodes start with. A mission is written beside its place and renamed when all of
it is on the disk, so it is there completely or not at all, whenever this process or the machine dies.
"""

from __future__ import annotations

import errno
import fcntl
import hashlib
import io
import json
import os
import shutil
import zipfile
from typing import Any, Callable, Dict, Iterable, List, NamedTuple, Optional, Tuple

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.bundle import (
    MANIFEST,
    MISSION,
    OWN,
    SIGNATURE,
    Bundle,
    Keys,
    Refused,
    check_seal,
    is_digest,
    mission_file,
    mission_id,
)

STATE = "state.json"
KEEP = 5
"""So many earlier missions are kept, unless a parameter sets another number."""

_NEW = ".new-"  # what is being written; after a start it is what a dead process has left
_FOLDER_MODE, _FILE_MODE = 0o700, 0o600
_PASSING = (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EACCES, errno.EPERM, errno.ESTALE, errno.EINTR)

Log = Callable[[str, str], None]
"""Takes a level (info, warn, err) and a sentence."""


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


# Reading: changes nothing ---------------------------------------------------------------------------------------------


def read_state(folder: str) -> Optional[StoreState]:
    """The state on the disk, None where there is none yet. Raises StoreError where it cannot be used."""
    path = os.path.join(folder, STATE)
    try:
        facts = read_json(_read(path))
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
        return _list_digests(folder)
    except OSError:
        return []


def _list_digests(folder: str) -> List[str]:
    with os.scandir(folder) as entries:
        there = [entry for entry in entries if is_digest(entry.name) and entry.is_dir(follow_symlinks=False)]
    return [entry.name for entry in sorted(there, key=lambda entry: (entry.stat().st_mtime, entry.name))]


def manifest(folder: str, digest: str) -> Dict[str, Any]:
    """What a mission in the store is. Raises StoreError where its manifest is not the one that was signed."""
    try:
        text = _read(os.path.join(folder, digest, MANIFEST))
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
        text, seal = (_read(os.path.join(folder, digest, name)) for name in (MANIFEST, SIGNATURE))
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
            if hashlib.sha256(_read(_inside(place, path))).hexdigest() != expected:
                raise StoreError(f"{path} is damaged")
        for package in _packages(facts["files"]):
            if _read(_inside(place, f"{package}/{MISSION}")) != mission_file(digest, facts["scenario"]):
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


def _read(path: str) -> bytes:
    """Raises OSError where the file is not there or damaged, NotNow where that cannot be known."""
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as problem:
        if problem.errno in _PASSING:
            raise TemporaryError(f"cannot read {path} now: {problem.strerror}") from problem
        raise


def _packages(files: Iterable[str]) -> List[str]:
    return sorted({path.split("/")[0] for path in files})


def _inside(folder: str, path: str) -> str:
    """The place of a file in a folder. Raises StoreError for one that is elsewhere, whatever its name says."""
    place, home = os.path.realpath(os.path.join(folder, path)), os.path.realpath(folder)
    if not place.startswith(home + os.sep):
        raise StoreError(f"{path!r} is not in the folder of its mission")
    return place


# The store ------------------------------------------------------------------------------------------------------------


class Store:
    """The store of one robot, for the one process that changes it."""

    def __init__(self, folder: str, keep: int, log: Log) -> None:
        """Opens it: removes what a dead process has left, and sets aside what is damaged. Raises StoreError."""
        self.folder = folder
        self._keep = max(1, keep)  # nodes may still play the one before
        self._log = log
        self._count = 0
        try:
            os.makedirs(folder, _FOLDER_MODE, exist_ok=True)
            self._lock = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        except OSError as problem:
            raise StoreError(f"cannot keep missions in {folder}: {problem.strerror}") from problem
        try:
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as problem:
            os.close(self._lock)
            raise StoreError(f"another pursue_reader works in {folder}") from problem
        self._remove(*self._leftovers())
        try:
            self.state = self._repaired()
        except StoreError:
            self.close()
            raise
        self._remove_unused()

    def close(self) -> None:
        """Lets another process have it."""
        os.close(self._lock)

    def kept(self) -> List[str]:
        """The missions that it has, the oldest first."""
        return stored_digests(self.folder)

    def is_intact(self, digest: str) -> bool:
        """True where it has this mission, unharmed."""
        wrong = find_damage(self.folder, digest) if digest in self.kept() else "nothing"
        if wrong not in ("", "nothing"):
            self._log("err", wrong)
        return not wrong

    def scenario(self, digest: str) -> str:
        """The name of the mission's scenario, "" where that cannot be known."""
        try:
            return str(manifest(self.folder, digest)["scenario"])
        except StoreError:
            return ""

    def put(self, bundle: Bundle, content: bytes, check: Callable[[str], None]) -> None:
        """Keeps the mission of a bundle, as `unpack` has read it from `content`. `check` gets the folder where the
        mission is complete, and may raise. Raises StoreError, and what `check` raises; then nothing is left of it."""
        place = os.path.join(self.folder, bundle.digest)
        if self.is_intact(bundle.digest) and self._has_seal(bundle.digest, content):
            check(place)
            return
        new = self._new()
        try:
            self._fill(new, bundle, _signature_of(content))
            check(new)
            if os.path.lexists(place):  # damaged, not a mission, or signed by another desk
                os.rename(place, self._new())
            os.rename(new, place)
        except OSError as problem:
            raise StoreError(f"cannot keep mission {mission_id(bundle.digest)}: {problem.strerror}") from problem
        finally:
            self._remove(*self._leftovers())
        self._sync()

    def save(self, state: StoreState) -> None:
        """From now on this is the state, also after a power cut. Raises StoreError; then it is the old one."""
        state = self._trimmed(state)
        if state != self.state:
            try:
                self._save(state)
                self.state = state
            finally:
                self._remove_unused()

    # How it is done ---------------------------------------------------------------------------------------------------

    def _has_seal(self, digest: str, content: bytes) -> bool:
        """True if the mission has the signature of this bundle: it may have been sent before by another desk."""
        try:
            return _read(os.path.join(self.folder, digest, SIGNATURE)) == _signature_of(content)
        except OSError:
            return False

    def _save(self, state: StoreState) -> None:
        new = self._new()
        try:
            _write(new, state.text())
            os.replace(new, os.path.join(self.folder, STATE))
        except OSError as problem:
            self._remove(new)
            raise StoreError(f"cannot write {STATE} in {self.folder}: {problem.strerror}") from problem
        self._sync()

    def _sync(self) -> None:
        """What was renamed stays so in a power cut. Other processes see it already."""
        try:
            _sync_folder(self.folder)
        except OSError as problem:
            self._log("warn", f"{self.folder} may be as it was before after a power cut: {problem.strerror}")

    def _trimmed(self, state: StoreState) -> StoreState:
        """Without the oldest of the history, where that is too long."""
        history = list(state.history)
        while sum(name != OWN for name in history) > self._keep:
            history.pop(0)
        return state._replace(history=tuple(history))

    def _repaired(self) -> StoreState:
        """The state on the disk, without what is not there or damaged. Raises StoreError."""
        try:
            there = [OWN, *(digest for digest in _list_digests(self.folder) if self.is_intact(digest))]
        except OSError as problem:
            raise StoreError(f"cannot read {self.folder}: {problem.strerror}") from problem
        try:
            known: Optional[StoreState] = read_state(self.folder) or StoreState()
        except TemporaryError:
            raise
        except StoreError as problem:
            self._log("err", f"{problem}: from now on the workspace's own mission counts; others can be called back")
            known = None
        state = known or StoreState(history=tuple(there[1:]))
        state = state._replace(
            next=state.next if state.next in there else None,
            prepared=state.prepared if state.prepared in there else None,
            history=tuple(name for name in state.history if name in there),
        )
        if state.current not in there:
            *history, current = state.history or (OWN,)
            lost, found_instead = mission_id(state.current), mission_id(current)
            self._log("err", f"mission {lost} cannot be used any more: from now on mission {found_instead} counts")
            state = state._replace(current=current, history=tuple(history))
        state = self._trimmed(state)
        if state != known:
            self._save(state)
        return state

    def _fill(self, new: str, bundle: Bundle, seal: bytes) -> None:
        """Writes the mission into a new folder."""
        packages = _packages(bundle.files)
        mark = mission_file(bundle.digest, bundle.manifest.scenario)
        files = {MANIFEST: bundle.manifest.text(), SIGNATURE: seal, **bundle.files}
        files.update((f"{package}/{MISSION}", mark) for package in packages)
        os.mkdir(new, _FOLDER_MODE)
        for package in packages:
            os.mkdir(_inside(new, package), _FOLDER_MODE)
        for path, content in files.items():
            _write(_inside(new, path), content)
        for folder in (*(os.path.join(new, package) for package in packages), new):
            _sync_folder(folder)

    def _new(self) -> str:
        self._count += 1
        return os.path.join(self.folder, f"{_NEW}{os.getpid()}-{self._count}")

    def _leftovers(self) -> List[str]:
        try:
            return [os.path.join(self.folder, name) for name in os.listdir(self.folder) if name.startswith(_NEW)]
        except OSError:
            return []

    def _remove_unused(self) -> None:
        """Removes missions that nobody names any more."""
        named = set(self.state.named())
        for digest in self.kept():
            if digest not in named:
                gone = self._new()  # never is a part of a mission called like a mission
                try:
                    os.rename(os.path.join(self.folder, digest), gone)
                except OSError as problem:
                    self._log("warn", f"cannot remove mission {mission_id(digest)}: {problem.strerror}")
                else:
                    self._remove(gone)

    def _remove(self, *paths: str) -> None:
        for path in paths:
            try:
                if os.path.isdir(path) and not os.path.islink(path):
                    shutil.rmtree(path)
                elif os.path.lexists(path):
                    os.unlink(path)
            except OSError as problem:
                self._log("warn", f"cannot remove {path}: {problem.strerror}")


def _signature_of(content: bytes) -> bytes:
    """The signature in a bundle, as it stands there."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return archive.read(SIGNATURE)


def _write(path: str, content: bytes) -> None:
    """A new file, with all of this in it, on the disk."""
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, _FILE_MODE)
    try:
        view = memoryview(content)
        while view:
            view = view[os.write(file, view):]
        os.fsync(file)
    finally:
        os.close(file)


def _sync_folder(folder: str) -> None:
    """What the folder lists is on the disk."""
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
