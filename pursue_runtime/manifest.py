"""Which mission the data of a workspace is: its manifest, the digest of that, and the short name in states and logs.

It needs Python and PyYAML alone, so that nodes which only have to know their mission's name do not need
`cryptography`.
"""

from __future__ import annotations

import hashlib
import json
import re
from dataclasses import dataclass
from typing import Mapping, Tuple

import yaml

FORMAT = 1
ID_LENGTH = 12
"""So many digits of a digest name a mission in system states, logs and tables."""
OWN = ""
"""In place of a digest: the mission that the workspace was generated for."""
MISSION = "mission.yaml"
"""Beside the data of a package: which mission it is part of. Not part of the mission itself."""

_DIGEST = re.compile(r"[0-9a-f]{64}", re.ASCII)


@dataclass(frozen=True)
class Manifest:
    """What a mission is: its scenario, the generator's version, the controllers, and the SHA-256 of each data file."""

    scenario: str
    generator: str
    controllers: Tuple[str, ...]
    files: Mapping[str, str]

    def text(self) -> bytes:
        """As it stands in the bundle; the same manifest gives the same bytes."""
        facts = {
            "format": FORMAT,
            "scenario": self.scenario,
            "generator": self.generator,
            "controllers": list(self.controllers),
            "files": dict(self.files),
        }
        return json.dumps(facts, indent=1, sort_keys=True).encode() + b"\n"

    @property
    def digest(self) -> str:
        """Of the mission: 64 hexadecimal digits."""
        return hashlib.sha256(self.text()).hexdigest()


def make_manifest(scenario: str, generator: str, controllers: Tuple[str, ...], files: Mapping[str, bytes]) -> Manifest:
    """The manifest of these files (`package/name.yaml` → content)."""
    digests = {path: hashlib.sha256(content).hexdigest() for path, content in sorted(files.items())}
    return Manifest(scenario, generator, controllers, digests)


def mission_file(digest: str, scenario: str) -> bytes:
    """The text of mission.yaml, which stands beside the data of each package."""
    head = "# Which mission the files of this folder are part of.\n"
    data = {"format": FORMAT, "mission": digest, "scenario": scenario}
    return (head + yaml.safe_dump(data, sort_keys=False)).encode()


def mission_id(digest: str) -> str:
    """The short name of a mission, `own` for the workspace's."""
    return digest[:ID_LENGTH] if digest else "own"


def is_digest(text: object) -> bool:
    """True for 64 hexadecimal digits in small letters."""
    return isinstance(text, str) and _DIGEST.fullmatch(text) is not None
