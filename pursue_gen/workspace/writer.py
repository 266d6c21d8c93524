"""A mapping path → bytes, onto the disk: completely or not at all, and never over what a person wrote.

At the root of what we write stands a manifest, `.pursue_gen.json`: the digest of each file as it was generated. When
a workspace is generated again, files that still have that digest are replaced (or removed, when they are no longer
part of it); a file that has another one was edited, a file that is not listed was not generated: both are an error
before anything is changed, unless `force` is given. Whatever else stands in the folder (build, devel, install,
packages that the user added) is never touched.
"""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import json
import os
import shutil
import signal
from dataclasses import replace
from pathlib import Path, PurePosixPath
from typing import Dict, Iterator, List, Mapping

from pursue_gen.diagnostics import PursueError, error
from pursue_runtime.bounded import read_json

MANIFEST = ".pursue_gen.json"
_STAGE = ".pursue_gen.new"


def write_tree(files: Mapping[str, bytes], folder: Path, force: bool = False) -> None:
    """Writes the files (relative paths with `/`) under `folder` as described above; `#!` files become executable.

    Raises PursueError, with nothing changed, where an edited or unknown file is in the way and `force` is not given,
    or where the folder cannot be written.
    """
    try:
        _recover(folder)
        _refuse_conflicts(files, folder, force)
        if folder.is_dir() and any(folder.iterdir()):
            _renew(files, folder)
        else:
            _create(files, folder)
    except OSError as problem:
        raise PursueError(
            [error("WSP003", f"cannot write the workspace: {problem}", hint="name another folder with -o DIR")], 2
        ) from problem


def manifest_of(files: Mapping[str, bytes]) -> bytes:
    """The text of the manifest for these files."""
    digests = {path: _digest(content) for path, content in sorted(files.items())}
    return (json.dumps({"files": digests}, indent=1, sort_keys=True) + "\n").encode()


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _known(folder: Path) -> Dict[str, str]:
    """path → digest of what was generated here before; empty where there is no manifest that can be read."""
    try:
        files = read_json((folder / MANIFEST).read_bytes())["files"]
        return {path: digest for path, digest in files.items() if _inside(path) and isinstance(digest, str)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return {}


def _inside(path: str) -> bool:
    """True for a relative path that stays in its folder: a manifest may have been tampered with."""
    pure = PurePosixPath(path)
    return bool(path) and not pure.is_absolute() and ".." not in pure.parts


def _refuse_conflicts(files: Mapping[str, bytes], folder: Path, force: bool) -> None:
    known = _known(folder)
    edited: List[str] = []
    unknown: List[str] = []
    for path in sorted({*files, *known}):
        place = folder / path
        blocked = [p for p in PurePosixPath(path).parents if (folder / p).exists() and not (folder / p).is_dir()]
        if blocked or place.is_dir():
            unknown.append(str(blocked[0]) if blocked else path)
            continue
        if not place.exists():
            continue
        found = _digest(place.read_bytes())
        if found != known.get(path) and found != _digest(files.get(path, b"")):
            (edited if path in known else unknown).append(path)
    if force or not (edited or unknown):
        return
    findings = []
    for code, paths, why in (("WSP001", edited, "was edited"), ("WSP002", unknown, "was not generated")):
        findings += [error(code, f"{folder / path} would be replaced or removed, but it {why}") for path in paths]
    hint = "move it away, write elsewhere with -o DIR, or replace it with --force"
    findings[-1] = replace(findings[-1], hint=hint)
    raise PursueError(findings, 2)


def _create(files: Mapping[str, bytes], folder: Path) -> None:
    """A workspace where there was none: written beside its place, then renamed into it."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    stage = folder.parent / f".{folder.name}{_STAGE}"
    with _only_one(stage):
        _fill(stage, files)
        os.replace(stage, folder)


def _renew(files: Mapping[str, bytes], folder: Path) -> None:
    """A workspace where there is one: everything is on the disk before the first old file is replaced.

    The staged folder gets its final name only when it is complete; a run killed after that is finished by the next.
    """
    draft = folder / f"{_STAGE}.part"
    with _only_one(draft):
        _fill(draft, files)
        os.replace(draft, folder / _STAGE)
        _apply(folder)


def _recover(folder: Path) -> None:
    if (folder / _STAGE).is_dir():
        _apply(folder)


def _apply(folder: Path) -> None:
    """Moves the staged files to their places, removes what is no longer part of the workspace; may be repeated."""
    stage = folder / _STAGE
    new = _known(stage)
    with _uninterrupted():
        if (stage / MANIFEST).exists():  # else all has been moved already
            for path in sorted(set(_known(folder)) - set(new)):
                _remove(folder, path)
            for path in [*sorted(new), MANIFEST]:  # the manifest last: until then the old one lists the generated files
                if (stage / path).exists():
                    _make_room(folder, path)
                    os.replace(stage / path, folder / path)
        shutil.rmtree(stage)


def _make_room(folder: Path, path: str) -> None:
    """What stands where a file or one of its folders goes is removed: it is there only when the user forced it."""
    for parent in reversed(PurePosixPath(path).parents):
        if (folder / parent).exists() and not (folder / parent).is_dir():
            (folder / parent).unlink()
    place = folder / path
    if place.is_dir() and not place.is_symlink():
        shutil.rmtree(place)
    place.parent.mkdir(parents=True, exist_ok=True)


def _remove(folder: Path, path: str) -> None:
    """Removes a file, and the folders that are empty without it (but for compiled Python)."""
    with contextlib.suppress(FileNotFoundError, IsADirectoryError):
        (folder / path).unlink()
    for parent in PurePosixPath(path).parents:
        place = folder / parent
        if place == folder or not place.is_dir() or {p.name for p in place.iterdir()} - {"__pycache__"}:
            return
        shutil.rmtree(place)


def _fill(stage: Path, files: Mapping[str, bytes]) -> None:
    """Writes the files and their manifest."""
    for path, content in [*sorted(files.items()), (MANIFEST, manifest_of(files))]:
        place = stage / path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
        if content.startswith(b"#!"):
            place.chmod(place.stat().st_mode | (place.stat().st_mode & 0o444) >> 2)


@contextlib.contextmanager
def _only_one(stage: Path) -> Iterator[None]:
    """An empty folder for this process alone: the leftover of a killed run is cleared, a failure leaves nothing."""
    stage.mkdir(exist_ok=True)
    handle = os.open(str(stage), os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise PursueError(
                [error("WSP004", f"another run is writing to {stage.parent}", hint="wait until it is done")], 2
            ) from None
        try:
            _clear(stage)
            yield
        finally:
            shutil.rmtree(stage, ignore_errors=True)
    finally:
        os.close(handle)


def _clear(folder: Path) -> None:
    for entry in folder.iterdir():
        if entry.is_dir() and not entry.is_symlink():
            shutil.rmtree(entry)
        else:
            entry.unlink()


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Ctrl-C and a polite kill wait until the (short) body is done."""
    old = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, old)


