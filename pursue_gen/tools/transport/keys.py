"""The keys at the desk: NAME.key (private, PEM, for its owner's eyes only) and NAME.pub (one line, for the robots).

Whoever has a private key that a robot trusts decides what it does; so a key that others may read is not used.
"""

from __future__ import annotations

import contextlib
import os
import re
import stat
import tempfile
from pathlib import Path
from typing import Dict, List, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, error, warning
from pursue_gen.files import reason_of, write_texts
from pursue_gen.outcomes import Unavailable

try:
    from cryptography.exceptions import UnsupportedAlgorithm
    from cryptography.hazmat.backends import default_backend
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey as Ed25519PrivateKey
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey
    from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat, load_pem_private_key
except ImportError:
    _HINT = "pip install cryptography (Debian, Ubuntu: sudo apt install python3-cryptography)"
    _MISSING = "the Python package cryptography is missing, which signs missions"
    raise Unavailable([error("TRN001", _MISSING, hint=_HINT)]) from None

from pursue_runtime.bundle import Refused, fingerprint, read_public_key, write_public_key
from pursue_runtime.named_files import open_regular, read_text

PRIVATE, PUBLIC = ".key", ".pub"
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", re.ASCII)
_LONGEST = 65536  # bytes; a key has some hundred
_OTHERS = stat.S_IRWXG | stat.S_IRWXO


def keys_folder() -> Path:
    """Where keys are by default: `$XDG_CONFIG_HOME/pursue/keys`, or `~/.config/pursue/keys`."""
    config = os.environ.get("XDG_CONFIG_HOME", "")
    base = Path(config) if os.path.isabs(config) else Path(os.path.expanduser("~")) / ".config"
    return base / "pursue" / "keys"


def new_key(name: str, folder: Path, force: bool = False) -> Tuple[Path, Path]:
    """Makes a pair of keys and returns their files, the private one first. Raises PursueError (exit status 2).

    Files of this name are not replaced unless `force` is given.
    """
    if not _NAME.fullmatch(name):
        message = f"a key cannot be called '{name}'; expected letters, digits, _ and -, a letter or digit first"
        raise PursueError([error("TRN002", message, hint="for example: pursue-gen keys new lab")])
    private, public = folder / f"{name}{PRIVATE}", folder / f"{name}{PUBLIC}"
    key = Ed25519PrivateKey.generate()
    text = key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption())
    try:
        if not force and os.path.lexists(public):
            raise FileExistsError(None, "", str(public))
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        _write_private(private, text, force)
    except FileExistsError as problem:
        there = private if private.exists() else problem.filename or folder
        hint = "choose another name; or replace it with --force: robots then need the new public key"
        raise PursueError([error("TRN005", f"{there} is there already", hint=hint)]) from None
    except OSError as problem:
        message = f"cannot write {private}: {reason_of(problem)}"
        raise PursueError([error("CLI003", message, hint="name another folder with --folder")]) from None
    try:
        write_texts({public: write_public_key(key.public_key(), name)})
    except PursueError:
        if not force:  # both or none
            private.unlink()
        raise
    return private, public


def _write_private(file: Path, text: bytes, force: bool) -> None:
    """Complete or not at all, and at no time readable by others."""
    handle, aside = tempfile.mkstemp(prefix=f".{file.name}.", dir=str(file.parent))  # its mode is 0600
    try:
        with open(handle, "wb") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        if force:
            os.replace(aside, file)
        else:
            os.link(aside, file)  # fails where the file is there
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(aside)


def key_names(folder: Path) -> List[str]:
    """The names of the private keys in the folder."""
    return sorted(file.stem for file in folder.glob(f"*{PRIVATE}") if not file.name.startswith("."))


def default_key(folder: Path) -> str:
    """The name of the only private key in the folder. Raises PursueError (exit status 2) unless there is just one."""
    names = key_names(folder)
    if not names:
        hint = "make one: pursue-gen keys new NAME; its public half then goes to the robots"
        raise PursueError([error("TRN002", f"there is no key to sign with in {folder}", hint=hint)])
    if len(names) > 1:
        message = f"there are several keys in {folder}: {', '.join(names)}"
        raise PursueError([error("TRN006", message, hint=f"name one: --key {names[0]}")])
    return names[0]


def load_private(name_or_path: Optional[str] = None, folder: Optional[Path] = None) -> Ed25519PrivateKey:
    """A private key: of this name in the folder (`keys_folder()` unless given), at this path, or the only one there is.

    Raises PursueError (exit status 2) where there is none, where it is no key, or where others may read it.
    """
    folder = keys_folder() if folder is None else folder
    wanted = default_key(folder) if name_or_path is None else name_or_path
    file = folder / f"{wanted}{PRIVATE}" if _NAME.fullmatch(wanted) else Path(wanted)
    content = _read_private(file, folder)
    hint = "pursue-gen keys new NAME makes a key that fits"
    try:
        key = load_pem_private_key(content, None, default_backend())
    except TypeError:
        message = f"{file} is locked with a password, and cannot be used"
        raise PursueError([error("TRN004", message, hint=hint)]) from None
    except (ValueError, UnsupportedAlgorithm):
        message = f"{file} is not a private key; expected PEM (PKCS8) with an ed25519 key"
        hint = f"the private key is {file.with_suffix(PRIVATE)}" if file.suffix == PUBLIC else hint
        raise PursueError([error("TRN004", message, hint=hint)]) from None
    if not isinstance(key, Ed25519PrivateKey):
        message = f"{file} is a private key of another kind; expected ed25519"
        raise PursueError([error("TRN004", message, hint=hint)])
    return key


def _read_private(file: Path, folder: Path) -> bytes:
    """The content of a file that its owner alone may read."""
    try:
        with open_regular(file) as stream:
            mode = os.fstat(stream.fileno()).st_mode
            if file.suffix != PUBLIC and mode & _OTHERS:
                message = f"others may read or write the private key {file}"
                raise PursueError([error("TRN003", message, hint=f"chmod 600 {file}")])
            return stream.read(_LONGEST)
    except (OSError, ValueError) as problem:
        names = key_names(folder)
        hint = f"there are: {', '.join(names)}" if names else "make one: pursue-gen keys new NAME"
        message = f"cannot read the key {file}: {reason_of(problem)}"
        raise PursueError([error("TRN002", message, hint=hint)]) from None


def load_public(name: str, folder: Path) -> Ed25519PublicKey:
    """The public key of this name; made from the private one where only that is there. Raises PursueError."""
    private, public = folder / f"{name}{PRIVATE}", folder / f"{name}{PUBLIC}"
    if not _NAME.fullmatch(name) or not public.exists():
        return load_private(name, folder).public_key()
    try:
        key, _ = read_public_key(read_text(public, _LONGEST))
    except (OSError, UnicodeDecodeError, Refused) as problem:
        message = f"{public} is not a public key: {reason_of(problem)}"
        hint = f"remove it if {private} is there: keys show then makes it again"
        raise PursueError([error("TRN007", message, hint=hint)]) from None
    if private.exists() and fingerprint(load_private(name, folder).public_key()) != fingerprint(key):
        message = f"{public} does not belong to {private}: robots that trust it would refuse what is signed here"
        raise PursueError([error("TRN007", message, hint=f"remove it, then: pursue-gen keys show {name}")])
    return key


def public_keys(folder: Path) -> Tuple[Dict[str, Ed25519PublicKey], List[Diagnostic]]:
    """All public keys by name, and warnings about files that hold none or that must not be used."""
    keys: Dict[str, Ed25519PublicKey] = {}
    findings: List[Diagnostic] = []
    names = {file.stem for file in folder.glob("*") if file.suffix in (PRIVATE, PUBLIC) and file.name[0] != "."}
    for name in sorted(names):
        try:
            keys[name] = load_public(name, folder)
        except PursueError as problem:
            findings += [warning("TRN008", found.message, hint=found.hint) for found in problem.diagnostics]
    return keys, findings
