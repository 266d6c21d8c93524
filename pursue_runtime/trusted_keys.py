"""The public keys whose missions and orders a robot accepts."""

from __future__ import annotations

import os
from typing import List, Optional, Tuple

from pursue_runtime.bundle import Keys, read_keys

Stamp = Tuple[Tuple[str, int, int, int], ...]


class KeyFolder:
    """The trusted keys in a folder; read again when its files change."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.problems: List[str] = []
        self._keys: Keys = {}
        self._stamp: Optional[Stamp] = None

    def keys(self) -> Keys:
        """Return the current keys by fingerprint; `problems` lists the files that hold none."""
        stamp = self._scan()
        if stamp != self._stamp:
            self._keys, self.problems = read_keys(self.folder)
            self._stamp = stamp  # last: another thread may call this meanwhile
        return self._keys

    def complete(self) -> bool:
        """Return True if every key file could be read: only then a key that is not there was removed."""
        try:
            names = [name for name in os.listdir(self.folder) if name.endswith(".pub")]
        except FileNotFoundError:
            return True
        except OSError:
            return False
        return all(os.access(os.path.join(self.folder, name), os.R_OK) for name in names)

    def _scan(self) -> Stamp:
        try:
            with os.scandir(self.folder) as entries:
                found = [(entry.name, entry.stat()) for entry in entries if entry.name.endswith(".pub")]
        except OSError:
            return ()
        return tuple(sorted((name, facts.st_mtime_ns, facts.st_size, facts.st_ino) for name, facts in found))
