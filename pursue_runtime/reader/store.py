"""The missions that a robot keeps on its disk, and which of them counts.

In the store's folder: `<digest>/` for each mission, with its manifest, its signature and `<package>/<name>.yaml`; and
`state.json`, which names the one that nodes start with. A mission is written beside its place and renamed when all of
it is on the disk, so it is there completely or not at all, whenever this process or the machine dies.
"""

from __future__ import annotations

import fcntl
import io
import os
import shutil
import zipfile
from typing import Callable, List, Optional

from pursue_runtime.bundle import MANIFEST, SIGNATURE, Bundle
from pursue_runtime.folders import sync_folder
from pursue_runtime.manifest import MISSION, OWN, mission_file, mission_id
from pursue_runtime.reader.contents import (
    STATE,
    StoreError,
    StoreState,
    TemporaryError,
    find_damage,
    inside,
    list_digests,
    manifest,
    packages_of,
    read_file,
    read_state,
    stored_digests,
)
from pursue_runtime.sentences import Log

KEEP = 5
"""So many earlier missions are kept, unless a parameter sets another number."""

_NEW = ".new-"  # what is being written; after a start it is what a dead process has left
_FOLDER_MODE, _FILE_MODE = 0o700, 0o600


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
            return read_file(os.path.join(self.folder, digest, SIGNATURE)) == _signature_of(content)
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
            sync_folder(self.folder)
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
            there = [OWN, *(digest for digest in list_digests(self.folder) if self.is_intact(digest))]
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
        packages = packages_of(bundle.files)
        mark = mission_file(bundle.digest, bundle.manifest.scenario)
        files = {MANIFEST: bundle.manifest.text(), SIGNATURE: seal, **bundle.files}
        files.update((f"{package}/{MISSION}", mark) for package in packages)
        os.mkdir(new, _FOLDER_MODE)
        for package in packages:
            os.mkdir(inside(new, package), _FOLDER_MODE)
        for path, content in files.items():
            _write(inside(new, path), content)
        for folder in (*(os.path.join(new, package) for package in packages), new):
            sync_folder(folder)

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
    with open(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW, _FILE_MODE), "wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
