"""What travels from the desk to robots: missions (data, never code) and orders, both signed with ed25519.

A bundle is a zip file without compression: `manifest.json`, `signature.json`, and the data files of each package, as
`observer/model.yaml`. A mission's digest is the SHA-256 of its manifest, which holds the digests of the files. Exactly
the bytes that `pack` writes are accepted: equal missions are equal files, and nothing grows when it is unpacked.

An order says what a robot is to do with a mission, once: it names the robot and the ticket that this robot gave out.

It needs `cryptography`.
"""

from __future__ import annotations

import base64
import binascii
import hashlib
import io
import json
import os
import re
import zipfile
from dataclasses import dataclass
from typing import Any, Dict, List, Mapping, Optional, Tuple

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import Encoding, PublicFormat

from pursue_runtime.bounded import BadText, read_json
from pursue_runtime.manifest import FORMAT, MISSION, OWN, Manifest, is_digest
from pursue_runtime.named_files import read_text

LIMIT = 64 * 2**20
"""The largest bundle in bytes, by default."""
FILES = 2000
ORDER_LENGTH = 4096
"""The longest order in characters, as it travels in a header."""

PREPARE, COMMIT, ABORT = "prepare", "commit", "abort"
ACTIONS = (PREPARE, COMMIT, ABORT)

MANIFEST, SIGNATURE = "manifest.json", "signature.json"
_MISSION, _ORDER = b"pursue-mission-1\0", b"pursue-order-1\0"
_TICKET = re.compile(r"[0-9a-f]{32}", re.ASCII)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,99}", re.ASCII)
_FILE = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,99}/[a-z][a-z0-9_]{0,99}\.yaml", re.ASCII)
_VERSION = re.compile(r"[!-~]{1,100}", re.ASCII)
_ENTRY = b"PK\1\2"  # how each file begins in a zip's list of files
_LONGEST_SEAL = 1000  # bytes; longer ones are not even looked at
_EPOCH = (1980, 1, 1, 0, 0, 0)  # zip's first moment: bundles have no date
_KEY_TYPE = "pursue-ed25519"
_LONGEST_KEY = 4096  # bytes of its file

Keys = Mapping[str, Ed25519PublicKey]
"""Those whose missions and orders count, by fingerprint."""


class Refused(Exception):
    """A bundle, an order or a key is not accepted; `code` is a word for programs, the text says why."""

    def __init__(self, code: str, why: str) -> None:
        super().__init__(why)
        self.code = code


@dataclass(frozen=True)
class Bundle:
    """A mission that was checked: its digest, its manifest, its files by path (`package/name.yaml`), who signed it."""

    digest: str
    manifest: Manifest
    files: Mapping[str, bytes]
    signed_by: str


@dataclass(frozen=True)
class Order:
    """What the robot of this name is to do with the mission of this digest (OWN: the workspace's own).

    `ticket` is the one that the robot has out. With PREPARE a bundle may travel along: `size` is its length in bytes
    and `bundle` its SHA-256; 0 and "" without.
    """

    action: str
    mission: str
    robot: str
    ticket: str
    size: int = 0
    bundle: str = ""


# Bundles --------------------------------------------------------------------------------------------------------------


def pack(manifest: Manifest, files: Mapping[str, bytes], key: Ed25519PrivateKey) -> bytes:
    """The bundle, signed. The same arguments give the same bytes: ed25519 has no chance in it."""
    text = manifest.text()
    seal = _seal(fingerprint(key.public_key()), key.sign(_MISSION + text))
    return _zipped({MANIFEST: text, SIGNATURE: seal, **files})


def _seal(signed_by: str, signature: bytes) -> bytes:
    """The text of signature.json."""
    facts = {"format": FORMAT, "key": signed_by, "signature": base64.b64encode(signature).decode()}
    return json.dumps(facts, indent=1).encode() + b"\n"


def unpack(content: bytes, keys: Keys, limit: int = LIMIT) -> Bundle:
    """Checks all of a bundle: whose it is first, then what is in it. Raises Refused."""
    if len(content) > limit:
        raise Refused("too_large", f"the bundle has {len(content)} bytes; at most {limit} are taken")
    entries = _unzipped(content)
    text, seal = entries.pop(MANIFEST, None), entries.pop(SIGNATURE, None)
    if text is None or seal is None or len(seal) > _LONGEST_SEAL:
        raise Refused("bad_bundle", f"a bundle has a {MANIFEST} and a {SIGNATURE}")
    signed_by, signature = check_seal(text, seal, keys)
    manifest = _manifest(text)
    if set(entries) != set(manifest.files):
        raise Refused("bad_bundle", "the files are not those that the manifest lists")
    for path, file in entries.items():
        if hashlib.sha256(file).hexdigest() != manifest.files[path]:
            raise Refused("bad_bundle", f"{path} is not the file that was signed")
    if _zipped({MANIFEST: text, SIGNATURE: _seal(signed_by, signature), **entries}) != content:
        raise Refused("bad_bundle", "there is more in the file than its mission")
    return Bundle(hashlib.sha256(text).hexdigest(), manifest, entries, signed_by)


def check_seal(text: bytes, seal: bytes, keys: Keys) -> Tuple[str, bytes]:
    """Who has signed the text of a manifest, and the signature, from signature.json. Raises Refused."""
    facts = _object(seal, SIGNATURE)
    signed_by = str(facts.get("key"))
    return signed_by, _check_signature(keys, signed_by, str(facts.get("signature")), _MISSION + text)


def _manifest(text: bytes) -> Manifest:
    """Reads what Manifest.text writes, and nothing else."""
    facts = _object(text, MANIFEST)
    if facts.get("format") != FORMAT:
        raise Refused("bad_version", f"the mission has format {str(facts.get('format'))[:40]}; known here is {FORMAT}")
    scenario, generator, names, files = (facts.get(key) for key in ("scenario", "generator", "controllers", "files"))
    named = isinstance(scenario, str) and _NAME.fullmatch(scenario)
    named = named and isinstance(generator, str) and _VERSION.fullmatch(generator)
    listed = isinstance(names, list) and all(isinstance(name, str) and _NAME.fullmatch(name) for name in names)
    if not (named and listed and isinstance(files, dict) and 0 < len(files) <= FILES):
        raise Refused("bad_bundle", f"{MANIFEST} lacks or misspells something")
    for path, digest in files.items():
        if not (_FILE.fullmatch(path) and is_digest(digest)) or path.endswith(f"/{MISSION}"):
            raise Refused("bad_bundle", f"not the name of a data file, or not a digest: {path[:120]!r}")
    manifest = Manifest(str(scenario), str(generator), tuple(names or ()), files)
    if manifest.text() != text:
        raise Refused("bad_bundle", f"{MANIFEST} is not written as it should be")
    return manifest


def _zipped(files: Mapping[str, bytes]) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_STORED) as archive:
        for path, content in sorted(files.items(), key=lambda file: (file[0] != MANIFEST, file[0] != SIGNATURE, file)):
            entry = zipfile.ZipInfo(path, _EPOCH)
            entry.create_system = 3  # the same on every system
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, content)
    return out.getvalue()


def _unzipped(content: bytes) -> Dict[str, bytes]:
    """path → content; nothing is larger than what came. Raises Refused."""
    if content.count(_ENTRY) > FILES + 2:  # before zipfile makes objects of all of them
        raise Refused("bad_bundle", f"not a bundle: more than {FILES} files")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            stored = all(entry.compress_type == zipfile.ZIP_STORED and not entry.flag_bits & 1 for entry in entries)
            size = sum(entry.file_size for entry in entries)
            names = {entry.filename for entry in entries}
            if not stored or size > len(content) or len(names) < len(entries):
                raise Refused("bad_bundle", "not a bundle: compressed, or a file is there twice")
            return {entry.filename: archive.read(entry) for entry in entries}
    except Refused:
        raise
    except Exception as problem:  # whatever zipfile makes of junk
        raise Refused("bad_bundle", f"not a bundle: {problem}") from problem


def _object(text: bytes, name: str) -> Dict[str, Any]:
    try:
        facts = read_json(text)
    except BadText as problem:
        raise Refused("bad_bundle", f"{name}: {problem}") from problem
    if not isinstance(facts, dict):
        raise Refused("bad_bundle", f"{name} is not what it should be")
    return facts


# Orders ---------------------------------------------------------------------------------------------------------------


def write_order(order: Order, key: Ed25519PrivateKey) -> str:
    """Return the order as text: content, fingerprint of the key, signature, separated by dots."""
    text = json.dumps({"format": FORMAT, **order.__dict__}, sort_keys=True).encode()
    signature = key.sign(_ORDER + text)
    return ".".join((_encoded(text), fingerprint(key.public_key()), _encoded(signature)))


def read_order(text: str, keys: Keys) -> Order:
    """Reads what `write_order` writes. Raises Refused: whether robot and ticket are ours is for the caller to see."""
    if len(text) > ORDER_LENGTH:
        raise Refused("bad_order", "the order is too long")
    body_text, signed_by, signature = (text.split(".") + ["", ""])[:3] if text.count(".") == 2 else ("", "", "")
    try:
        body = base64.b64decode(body_text.encode("ascii"), altchars=b"-_", validate=True)
        seal = base64.b64decode(signature.encode("ascii"), altchars=b"-_", validate=True)
    except (ValueError, binascii.Error) as problem:
        raise Refused("bad_order", "not an order") from problem
    if not body or ".".join((_encoded(body), signed_by, _encoded(seal))) != text:
        raise Refused("bad_order", "not an order")
    _check_signature(keys, signed_by, base64.b64encode(seal).decode(), _ORDER + body)
    facts = _object(body, "the order")
    if facts.get("format") != FORMAT:
        raise Refused("bad_version", f"the order has format {str(facts.get('format'))[:40]}; known here is {FORMAT}")
    return _order(facts)


def _order(facts: Mapping[str, Any]) -> Order:
    fields = ("action", "mission", "robot", "ticket", "size", "bundle")
    action, mission, robot, ticket, size, bundle = (facts.get(field) for field in fields)
    good = action in ACTIONS and (mission == OWN or is_digest(mission)) and isinstance(robot, str) and (
        isinstance(ticket, str) and _TICKET.fullmatch(ticket) and type(size) is int and size >= 0
    ) and (is_digest(bundle) and action == PREPARE and mission != OWN if size else bundle == "")
    if not good:
        raise Refused("bad_order", "the order lacks or misspells something")
    return Order(str(action), str(mission), str(robot), str(ticket), int(size or 0), str(bundle))


def new_ticket() -> str:
    """One that nobody can guess."""
    return os.urandom(16).hex()


def _encoded(content: bytes) -> str:
    return base64.urlsafe_b64encode(content).decode()


# Keys -----------------------------------------------------------------------------------------------------------------


def fingerprint(key: Ed25519PublicKey) -> str:
    """The first 16 hexadecimal digits of the key's SHA-256."""
    return hashlib.sha256(key.public_bytes(Encoding.Raw, PublicFormat.Raw)).hexdigest()[:16]


def write_public_key(key: Ed25519PublicKey, name: str) -> str:
    """One line: type, key, whose it is."""
    raw = base64.b64encode(key.public_bytes(Encoding.Raw, PublicFormat.Raw)).decode()
    return f"{_KEY_TYPE} {raw} {name}\n"


def read_public_key(text: str) -> Tuple[Ed25519PublicKey, str]:
    """A key and whose it is, from the line that `write_public_key` writes. Raises Refused."""
    words = text.split(None, 2)
    try:
        if len(words) < 2 or words[0] != _KEY_TYPE or len(text.strip().splitlines()) > 1:
            raise ValueError("expected one line: pursue-ed25519, the key, a name")
        key = Ed25519PublicKey.from_public_bytes(base64.b64decode(words[1].encode("ascii"), validate=True))
    except (ValueError, binascii.Error) as problem:
        raise Refused("bad_key", f"not a public key: {problem}") from problem
    return key, words[2].strip() if len(words) > 2 else ""


def read_keys(folder: str) -> Tuple[Dict[str, Ed25519PublicKey], List[str]]:
    """The keys in the *.pub files of a folder, by fingerprint, and what is wrong with files that hold none."""
    keys: Dict[str, Ed25519PublicKey] = {}
    problems: List[str] = []
    try:
        names = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    except OSError as problem:
        return keys, [f"{folder}: {problem}"]
    for path in (os.path.join(folder, name) for name in names if name.endswith(".pub")):
        try:
            key, _ = read_public_key(read_text(path, _LONGEST_KEY))
        except (OSError, UnicodeDecodeError, Refused) as problem:
            problems.append(f"{path}: {problem}")
        else:
            keys[fingerprint(key)] = key
    return keys, problems


def _check_signature(keys: Keys, signed_by: str, signature: str, what: bytes) -> bytes:
    """The signature, decoded. Raises Refused unless one of the keys has signed it."""
    key: Optional[Ed25519PublicKey] = keys.get(signed_by)
    if key is None:
        raise Refused("unknown_key", f"signed with a key that this machine does not trust: {signed_by[:16]!r}")
    try:
        seal = base64.b64decode(signature.encode("ascii", "replace"), validate=True)
        key.verify(seal, what)
    except (ValueError, binascii.Error, InvalidSignature) as problem:
        raise Refused("bad_signature", "the signature is not right") from problem
    return seal


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
