"""Which mission a node plays, and where its data are: the workspace's own, or one that this machine has received.

Nothing is written here.

What was received is in $ROS_HOME/pursue/missions: state.json says which one is `current`, and each mission is a folder
that is called like its digest, with the data of each package, and a manifest with the digests of the files.
"""

from __future__ import annotations

import hashlib
import os
from typing import Any, Dict, Mapping, NamedTuple, Optional

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.data import DataError, Package, data_file, parse_data, read_data
from pursue_runtime.folders import MISSIONS
from pursue_runtime.manifest import ID_LENGTH, MISSION, OWN, is_digest

STATE, MANIFEST = "state.json", "manifest.json"


class Source(NamedTuple):
    """Where the data of one package in one mission are: all files of a node come from one folder.

    `mission` is the mission's id, "" where the workspace does not say which one it was made for. `digests` are those of
    the files by name, None where they are not signed (the workspace's own); with none the package has no part in it.
    """

    mission: str
    folder: str
    digests: Optional[Mapping[str, str]] = None

    @property
    def empty(self) -> bool:
        """True where the package has no part in this mission."""
        return self.digests is not None and not self.digests

    def has(self, name: str) -> bool:
        """True where there is a data file of this name."""
        return os.path.isfile(os.path.join(self.folder, name)) if self.digests is None else name in self.digests

    def read(self, name: str) -> Dict[str, Any]:
        """The content of a data file. Raises DataError where it is missing, damaged, or not the one that was signed."""
        path = os.path.join(self.folder, name)
        if self.digests is None:
            return read_data(path)
        if name not in self.digests:
            raise DataError(f"mission {self.mission} has no {name} for {os.path.basename(self.folder)}: send it again")
        content = _bytes(path)
        if hashlib.sha256(content).hexdigest() != self.digests[name]:
            raise DataError(f"{path} is not as it was received: send mission {self.mission} again")
        return parse_data(content, path)


def own_source(package: Package, main: str, config: str = "") -> Source:
    """The workspace's own data of a package: the folder of its `main` file (see data_file). Raises DataError."""
    folder = os.path.dirname(data_file(package, main, config))
    path = os.path.join(folder, MISSION)
    if not os.path.isfile(path):
        return Source(OWN, folder)
    digest = read_data(path).get("mission")
    if not is_digest(digest):
        raise DataError(f"{path} says mission: {digest!r}; expected 64 hexadecimal digits: generate it again")
    return Source(str(digest)[:ID_LENGTH], folder)


class Missions:
    """The missions of a package on this machine: the workspace's own, and with `home` (ROS_HOME) those received."""

    def __init__(self, own: Source, package: str, home: str = "") -> None:
        self.own = own
        self._package = package
        self._store = os.path.join(home, MISSIONS) if home else ""
        self._seen: object = self._mark()

    def current(self) -> Source:
        """What a node starts with: the mission received last, the own one where none was. Raises DataError."""
        self._seen = self._mark()
        digest = self._digest()
        return self.own if digest == OWN else self._source(digest)

    def changed(self) -> bool:
        """Return True if another mission may be current since the last call of `current`."""
        return self._mark() != self._seen

    def find(self, mission: str) -> Optional[Source]:
        """The mission of this id, "" for the own one; None where this machine does not have it. Raises DataError.

        The own one may have been received as well. Then what was received counts, as it was signed: a person may have
        changed the files in the workspace. Those count where the desk has ordered this machine to play its own.
        """
        if mission == OWN or (mission == self.own.mission and self._plays_own()):
            return self.own
        received = self._received(mission)
        return self.own if received is None and mission == self.own.mission else received

    def moved(self, mission: str, source: Source) -> bool:
        """True where the own mission is to be read from elsewhere than the `source` that a node has it from."""
        if mission not in (OWN, self.own.mission):
            return False
        try:
            return self.find(mission) not in (None, source)
        except DataError:
            return False

    def _received(self, mission: str) -> Optional[Source]:
        if len(mission) != ID_LENGTH or not self._store or not os.path.isdir(self._store):
            return None
        found = [name for name in sorted(os.listdir(self._store)) if is_digest(name) and name.startswith(mission)]
        return self._source(found[0]) if len(found) == 1 else None

    def _plays_own(self) -> bool:
        """True where the workspace's own mission is current, or takes the place of another one now."""
        current = self._digest()
        if current == OWN:
            return True
        following = _facts(os.path.join(self._store, STATE)).get("next")
        return following == OWN and not current.startswith(self.own.mission)

    def _digest(self) -> str:
        """The digest of the mission received last; OWN where there is none. Raises DataError."""
        if self._mark() is None:
            return OWN
        path = os.path.join(self._store, STATE)
        digest = _facts(path).get("current")
        if digest != OWN and not is_digest(digest):
            raise DataError(f"{path} says current: {str(digest)[:80]!r}; expected the digest of a mission, or nothing")
        return str(digest)

    def _mark(self) -> object:
        """What changes whenever the state of the store is written; None where there is no store."""
        try:
            found = os.stat(os.path.join(self._store, STATE)) if self._store else None
        except FileNotFoundError:
            return None
        except OSError as problem:
            return str(problem)
        return found and (found.st_mtime_ns, found.st_ino, found.st_size)

    def _source(self, digest: str) -> Source:
        """Our part of a mission in the store. Raises DataError unless its manifest is the one of this digest."""
        path = os.path.join(self._store, digest, MANIFEST)
        if hashlib.sha256(_bytes(path)).hexdigest() != digest:
            raise DataError(f"{path} is not as it was received: send mission {digest[:ID_LENGTH]} again")
        try:
            files: Dict[str, str] = dict(_facts(path)["files"])
        except (KeyError, TypeError, ValueError) as problem:
            raise DataError(f"{path} does not list the files of a mission") from problem
        parts = ((file.partition("/"), digest) for file, digest in files.items())
        ours = {name: digest for (package, _, name), digest in parts if package == self._package}
        return Source(digest[:ID_LENGTH], os.path.join(self._store, digest, self._package), ours)


def _bytes(path: str) -> bytes:
    try:
        with open(path, "rb") as file:
            return file.read()
    except OSError as problem:
        raise DataError(f"cannot read {path}: {problem}") from problem


def _facts(path: str) -> Dict[str, Any]:
    """The content of one of the store's JSON files. Raises DataError."""
    try:
        facts = read_json(_bytes(path))
    except BadText as problem:
        raise DataError(f"{path} cannot be read: {problem}") from problem
    if not isinstance(facts, dict) or facts.get("format") != 1:
        raise DataError(f"{path} is not a file of format 1")
    return facts
