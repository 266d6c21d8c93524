"""A folder that is reached through its descriptor only: no link in it is followed, whoever puts one there meanwhile.

Paths are relative, with `/` between their parts. Every OSError names the place that it is about.
"""

from __future__ import annotations

import contextlib
import errno
import fcntl
import hashlib
import os
import secrets
import stat
from pathlib import Path
from typing import Iterator, List, NamedTuple, Optional, Tuple, Union

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC
_FILE = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC  # a pipe does not block
_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC


class File(NamedTuple):
    """A file as it was found: the SHA-256 of its content, and whether it can be executed."""

    digest: str
    executable: bool


class Obstacle(NamedTuple):
    """What is no file where one could be, or no folder on the way there."""

    path: str
    what: str


Found = Union[File, Obstacle, None]
"""What is at a path; None: nothing."""


def digest_of(content: bytes) -> str:
    """The SHA-256 of the content."""
    return hashlib.sha256(content).hexdigest()


class Folder:
    """An open folder; `place` is its name in messages. It is closed at the end of a `with`."""

    def __init__(self, handle: int, place: Path) -> None:
        self.handle, self.place = handle, place

    @classmethod
    def at(cls, place: Path) -> Folder:
        """The folder that a person has named, by way of links too. Raises OSError."""
        return cls(os.open(str(place), os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC), place)

    def __enter__(self) -> Folder:
        return self

    def __exit__(self, *problem: object) -> None:
        os.close(self.handle)

    def lock(self) -> bool:
        """True where no other process has locked it: from now on it is locked, until it is closed."""
        try:
            fcntl.flock(self.handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True

    # Looking ----------------------------------------------------------------------------------------------------------

    def names(self) -> List[str]:
        """What is in it, sorted."""
        return sorted(os.listdir(self.handle))

    def names_in(self, path: str) -> List[str]:
        """What is in the folder at the path, sorted; nothing where there is no folder."""
        with contextlib.suppress(OSError), self._parent(f"{path}/.") as (handle, _):
            return sorted(os.listdir(handle))
        return []

    def folder(self, name: str) -> Folder:
        """The folder of this name in it. Raises OSError where it is none: a link is none."""
        with self._named(name):
            return Folder(os.open(name, _FOLDER, dir_fd=self.handle), self.place / name)

    def find(self, path: str) -> Found:
        """What is at the path."""
        try:
            content, executable = self._read(path)
        except FileNotFoundError:
            return None
        except _InTheWay as problem:
            return problem.obstacle
        return File(digest_of(content), executable)

    def read(self, path: str) -> Optional[bytes]:
        """The content of the file at the path, None where there is none."""
        try:
            return self._read(path)[0]
        except (FileNotFoundError, _InTheWay):
            return None

    def _read(self, path: str) -> Tuple[bytes, bool]:
        with self._parent(path) as (handle, name), self._named(path):
            mode = os.stat(name, dir_fd=handle, follow_symlinks=False).st_mode
            if not stat.S_ISREG(mode):
                raise _InTheWay(Obstacle(path, _kind(mode)))
            with open(os.open(name, _FILE, dir_fd=handle), "rb") as file:
                return file.read(), bool(mode & 0o111)

    # Changing ---------------------------------------------------------------------------------------------------------

    def write(self, path: str, content: bytes, executable: bool = False) -> None:
        """A new file, and the folders that it needs. Raises OSError, also where something is there."""
        self._make_parents(path)
        with self._parent(path) as (handle, name), self._named(path):
            file = os.open(name, _NEW, 0o777 if executable else 0o666, dir_fd=handle)
            try:
                left = memoryview(content)
                while left:
                    left = left[os.write(file, left) :]
            finally:
                os.close(file)

    def take(self, source: Folder, old: str, path: str) -> None:
        """Moves what is at the path `old` of a folder to a path here, in one step.

        A file takes the place of a file or link, a folder that of an empty folder; all others are an OSError.
        """
        self._make_parents(path)
        with self._parent(path) as (target, leaf), source._parent(old) as (origin, name), self._named(path):
            os.rename(name, leaf, src_dir_fd=origin, dst_dir_fd=target)

    def remove(self, path: str) -> None:
        """Removes the file or link at the path."""
        with self._parent(path) as (handle, name), self._named(path):
            os.unlink(name, dir_fd=handle)

    def remove_empty(self, path: str) -> bool:
        """Removes the folder at the path if it is empty; returns whether it is gone."""
        try:
            with self._parent(path) as (handle, name):
                os.rmdir(name, dir_fd=handle)
        except FileNotFoundError:
            return True
        except OSError:
            return False
        return True

    def remove_all(self, path: str) -> None:
        """Removes whatever is at the path; of a folder all that is in it."""
        if self._is_folder(path):
            for inner in self.names_in(path):
                self.remove_all(f"{path}/{inner}")
            with self._parent(path) as (handle, name), self._named(path):
                os.rmdir(name, dir_fd=handle)
        else:
            self.remove(path)

    def new_folder(self, prefix: str) -> Folder:
        """A new, empty, locked folder in this one, whose name nobody could know before."""
        while True:
            name = prefix + secrets.token_hex(8)
            with contextlib.suppress(FileExistsError), self._named(name):
                os.mkdir(name, dir_fd=self.handle)
                break
        made = self.folder(name)
        made.lock()
        return made

    # How it is done ---------------------------------------------------------------------------------------------------

    @contextlib.contextmanager
    def _parent(self, path: str) -> Iterator[Tuple[int, str]]:
        """The descriptor of the folder that the path is in, and its name there. Raises _InTheWay."""
        *parts, name = path.split("/")
        handle = os.dup(self.handle)
        try:
            for number, part in enumerate(parts):
                here = "/".join(parts[: number + 1])
                with self._named(here):
                    try:
                        inner = os.open(part, _FOLDER, dir_fd=handle)
                    except OSError as problem:
                        if problem.errno not in (errno.ENOTDIR, errno.ELOOP):
                            raise
                        mode = os.stat(part, dir_fd=handle, follow_symlinks=False).st_mode
                        raise _InTheWay(Obstacle(here, _kind(mode))) from None
                os.close(handle)
                handle = inner
            yield handle, name
        finally:
            os.close(handle)

    def _make_parents(self, path: str) -> None:
        parts = path.split("/")
        for number in range(1, len(parts)):
            here = "/".join(parts[:number])
            with self._parent(here) as (handle, name), self._named(here), contextlib.suppress(FileExistsError):
                os.mkdir(name, dir_fd=handle)

    def _is_folder(self, path: str) -> bool:
        with self._parent(path) as (handle, name):
            return stat.S_ISDIR(os.stat(name, dir_fd=handle, follow_symlinks=False).st_mode)

    @contextlib.contextmanager
    def _named(self, path: str) -> Iterator[None]:
        """Errors inside name this path."""
        try:
            yield
        except _InTheWay:
            raise
        except OSError as problem:
            raise type(problem)(problem.errno, problem.strerror, str(self.place / path)) from None


class _InTheWay(OSError):
    """Something is no folder, or no file, where one was expected."""

    def __init__(self, obstacle: Obstacle) -> None:
        super().__init__(errno.ENOTDIR, f"{obstacle.path} is {obstacle.what}")
        self.obstacle = obstacle


def _kind(mode: int) -> str:
    if stat.S_ISLNK(mode):
        return "a link"
    if stat.S_ISDIR(mode):
        return "a folder"
    return "a file" if stat.S_ISREG(mode) else "no file"
