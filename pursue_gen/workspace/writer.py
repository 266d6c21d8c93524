"""A mapping path → bytes, onto the disk: completely or not at all, and never over what a person wrote.

At the root of what we write stands a manifest, `.pursue_gen.json`: the digest of each file as it was generated. A file
is ours where the manifest lists it and it has that digest; all others are a person's. Only files of ours are replaced,
or removed when they are no longer part of the workspace. A person's file in the way is an error before anything is
changed, unless `force` is given. Whatever else stands in the folder (build, devel, install, packages that the user
added) is never touched. No link is followed.

New files are first written to a folder of their own, and then renamed one by one. Before the first, the manifest gets
the old digests beside the new ones. So whenever this process dies, each file is the old one, the new one, or a
person's, and the manifest tells which: the next run needs no other knowledge, and refuses what any run refuses.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, FrozenSet, Iterable, Iterator, Mapping, NamedTuple, Optional

from pursue_gen.diagnostics import Diagnostic, PursueError, error
from pursue_gen.workspace.folder import File, Folder, Found, Obstacle, digest_of
from pursue_runtime.bounded import BadText, read_json

MANIFEST = ".pursue_gen.json"
STAGE = ".pursue_gen-"
"""How the name of the folder begins in which new files are first; for a new workspace its name stands before that."""

_MIXED = MANIFEST + ".mixed"
"""The manifest while files are renamed, before it takes its place."""

Known = Mapping[str, FrozenSet[str]]
"""path → the digests that our file there may have."""


def write_tree(files: Mapping[str, bytes], folder: Path, force: bool = False) -> None:
    """Writes the files (relative paths with `/`) under `folder` as described above; `#!` files become executable.

    Raises PursueError, with nothing changed, where a person's file is in the way and `force` is not given, or where
    the folder cannot be written; and with a part changed where a person edits a file at this very moment.
    """
    folder = Path(os.path.abspath(str(folder)))
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with Folder.at(folder.parent) as parent:
            if _is_new(parent, folder.name):
                _create(files, parent, folder.name)
            else:
                with parent.folder(folder.name) as root:
                    _renew(files, root, force)
    except OSError as problem:
        where = str(problem.filename or folder)
        reason = problem.strerror or str(problem)
        hint = "name another folder with -o DIR"
        raise PursueError([error("WSP003", f"cannot write {where}: {reason}", hint=hint)]) from problem


def manifest_of(files: Mapping[str, bytes], before: Optional[Known] = None) -> bytes:
    """The text of the manifest for these files; `before`: those of ours that may still be there."""
    facts: Dict[str, Dict[str, Any]] = {"files": {path: digest_of(content) for path, content in files.items()}}
    if before:
        facts["before"] = {path: sorted(digests) for path, digests in before.items()}
    return (json.dumps(facts, sort_keys=True) + "\n").encode()


def _is_new(parent: Folder, name: str) -> bool:
    """True where there is no such folder, or an empty one. Raises PursueError where something else has the name."""
    found = parent.find(name)
    if found is None:
        return True
    if isinstance(found, File) or found.what != "a folder":
        what = "a file" if isinstance(found, File) else found.what
        hint = "name a folder with -o DIR" + (": the one that the link leads to, if you mean that" * (what == "a link"))
        raise PursueError([error("WSP003", f"cannot write {parent.place / name}: it is {what}", hint=hint)])
    with parent.folder(name) as root:
        return not root.names()


# Whose a file is ------------------------------------------------------------------------------------------------------


def _known(manifest: Optional[bytes]) -> Optional[Known]:
    """What the text of a manifest lists; None where it is none."""
    try:
        facts = read_json(manifest or b"")
        found = {path: frozenset(digests) for path, digests in facts.get("before", {}).items()}
        for path, digest in facts["files"].items():
            found[path] = found.get(path, frozenset()) | {digest}
    except (BadText, KeyError, TypeError, AttributeError):
        return None
    return {path: digests for path, digests in found.items() if _inside(path)}


def _inside(path: str) -> bool:
    """True for a path that stays in its folder: a manifest may have been tampered with."""
    return path != MANIFEST and "\0" not in path and all(part not in ("", ".", "..") for part in path.split("/"))


class _Plan(NamedTuple):
    """What is to be done: the files to write and those to remove, as they were found, and those that are ours."""

    write: Mapping[str, Found]
    remove: Mapping[str, Found]
    known: Known


def _plan(files: Mapping[str, bytes], root: Folder, force: bool) -> _Plan:
    """Looks at every file. Raises PursueError where one is a person's and `force` is not given."""
    known = _known(root.read(MANIFEST))
    found = {path: root.find(path) for path in sorted({*files, *(known or ())})}
    problems = [problem for path in found for problem in _problems(root, path, found[path], files, known or {})]
    if known is None and root.find(MANIFEST) is not None:
        problems.append(error("WSP002", f"{root.place / MANIFEST} would be replaced, but it was not generated"))
    if problems and not force:
        *others, last = {problem.message: problem for problem in problems}.values()
        hint = "move it away, write elsewhere with -o DIR, or replace it with --force"
        raise PursueError([*others, replace(last, hint=hint)])
    write = {path: found[path] for path in files if found[path] != _as_written(files[path])}
    remove = {path: what for path, what in found.items() if path not in files and isinstance(what, File)}
    return _Plan(write, remove, known or {})


def _problems(root: Folder, path: str, what: Found, files: Mapping[str, bytes], known: Known) -> Iterator[Diagnostic]:
    """Why what was found at the path may not be replaced or removed."""
    if isinstance(what, Obstacle):
        if path in files:  # else there is nothing of ours
            message = f"{root.place / what.path} would be replaced, but it is {what.what}, and was not generated"
            yield error("WSP002", message)
        return
    as_wanted = path in files and what is not None and what.digest == digest_of(files[path])
    if what is not None and not as_wanted and what.digest not in known.get(path, ()):
        code, why = ("WSP001", "was edited") if path in known else ("WSP002", "was not generated")
        yield error(code, f"{root.place / path} would be replaced or removed, but it {why}")


def _as_written(content: bytes) -> File:
    return File(digest_of(content), content.startswith(b"#!"))


# Writing --------------------------------------------------------------------------------------------------------------


def _create(files: Mapping[str, bytes], parent: Folder, name: str) -> None:
    """A workspace where there was none: written beside its place, then renamed into it."""
    prefix, staged = f".{name}{STAGE}", {MANIFEST: manifest_of(files), **files}
    _sweep(parent, prefix, staged)
    with _stage(parent, prefix, staged) as stage:
        _fill(stage, staged, staged)
        parent.take(parent, stage.place.name, name)


def _renew(files: Mapping[str, bytes], root: Folder, force: bool) -> None:
    """A workspace where there is one: everything is on the disk before the first old file is replaced."""
    if not root.lock():
        hint = "wait until it is done"
        raise PursueError([error("WSP004", f"another run is writing to {root.place}", hint=hint)])
    plan = _plan(files, root, force)
    manifest = manifest_of(files)
    staged = {MANIFEST: manifest, **files, _MIXED: manifest_of(files, plan.known)}
    _sweep(root, STAGE, staged)
    if not plan.write and not plan.remove and root.read(MANIFEST) == manifest:
        return
    with _stage(root, STAGE, staged) as stage:
        _fill(stage, staged, [MANIFEST, *plan.write, _MIXED])
        with _uninterrupted():
            root.take(stage, _MIXED, MANIFEST)
            for path, found in plan.write.items():
                _check_unchanged(root, path, found, force)
                root.take(stage, path, path)
            for path, found in plan.remove.items():
                _check_unchanged(root, path, found, force)
                _remove(root, path)
            root.take(stage, MANIFEST, MANIFEST)


def _fill(stage: Folder, staged: Mapping[str, bytes], wanted: Iterable[str]) -> None:
    """Writes the wanted files; the manifest is the first, since it proves later whose the others are."""
    for path in wanted:
        stage.write(path, staged[path], staged[path].startswith(b"#!"))


def _check_unchanged(root: Folder, path: str, found: Found, force: bool) -> None:
    """Clears the way for a file if a person has ordered that. Raises PursueError where a person was quicker than we."""
    now = root.find(path)
    if isinstance(now, Obstacle) and force:
        root.remove_all(now.path)
    elif now != found and not (now is None and isinstance(found, Obstacle)):  # the way was cleared for another file
        message = f"{root.place / path} would be replaced or removed, but it was edited just now"
        raise PursueError([error("WSP001", message, hint="run the command again, which tells what is in the way")])


def _remove(root: Folder, path: str) -> None:
    """Removes a file, what Python has compiled of it, and the folders that are empty then."""
    root.remove(path)
    folder, _, name = path.rpartition("/")
    if name.endswith(".py"):
        cache = f"{folder}/__pycache__".lstrip("/")
        for compiled in root.names_in(cache):
            if compiled.startswith(name[:-2]) and compiled.endswith(".pyc"):
                root.remove(f"{cache}/{compiled}")
        root.remove_empty(cache)
    while folder and root.remove_empty(folder):
        folder = folder.rpartition("/")[0]


# Where new files are first --------------------------------------------------------------------------------------------


@contextlib.contextmanager
def _stage(folder: Folder, prefix: str, staged: Mapping[str, bytes]) -> Iterator[Folder]:
    """A new folder in this one, for this process alone. What is left in it at the end is removed."""
    stage = folder.new_folder(prefix)
    with stage:
        try:
            yield stage
        finally:
            with contextlib.suppress(OSError), folder.folder(stage.place.name) as left:  # it may have got another name
                _clear(folder, left, staged)


def _sweep(folder: Folder, prefix: str, staged: Mapping[str, bytes]) -> None:
    """Removes what runs that were killed have left, as far as it is proven to be ours."""
    for name in folder.names():
        if name.startswith(prefix):
            with contextlib.suppress(OSError), folder.folder(name) as stage:
                if stage.lock():  # else a run is at work there
                    _clear(folder, stage, staged)


def _clear(folder: Folder, stage: Folder, staged: Mapping[str, bytes]) -> None:
    """Empties a stage of our files, its manifest last, and removes it if nothing of anybody else's is in it.

    A file is ours where the manifest of the stage lists it, or where it is the beginning of what is `staged` now: the
    last one of a run that was killed.
    """
    known = _known(stage.read(MANIFEST)) or {}
    for path in sorted({*known, *staged}, key=lambda path: (path == MANIFEST, path)):
        content = stage.read(path)
        if content is not None:
            ours = digest_of(content) in known.get(path, ()) or staged.get(path, b"").startswith(content)
            if ours or (path in (MANIFEST, _MIXED) and _known(content) is not None):
                stage.remove(path)
        while "/" in path:
            path = path.rpartition("/")[0]
            stage.remove_empty(path)
    folder.remove_empty(stage.place.name)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """Ctrl-C and a polite kill wait until the (short) body is done."""
    old = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, old)
