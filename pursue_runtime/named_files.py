"""The one reader of files that a person names: a regular file, and no more of it than is expected there.

A device may never end, and a pipe into which nobody writes has no end either. So neither is opened, but for a caller
that has a patience for them.
"""

from __future__ import annotations

import contextlib
import errno
import os
import select
import stat
from typing import BinaryIO, Iterator, Optional, Union

TEXT = 64 * 2**20
"""The most bytes of a text."""

Name = Union[str, "os.PathLike[str]"]

_KINDS = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
_FLAGS = os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC  # a pipe does not block
_PIECE = 1 << 20


@contextlib.contextmanager
def open_regular(name: Name) -> Iterator[BinaryIO]:
    """The file, open for reading bytes. Raises OSError where it is no regular file, ValueError where it is no name."""
    _check(os.stat(name).st_mode)  # first: opening a device alone may do something
    with open(os.open(name, _FLAGS), "rb") as stream:
        _check(os.fstat(stream.fileno()).st_mode)  # it may have been replaced
        yield stream


def read_text(name: Name, most: int = TEXT) -> str:
    """The text of a regular file, its lines ended as Python ends them. Raises as `read_all`, and UnicodeDecodeError."""
    return read_all(name, most).decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")


def read_all(name: Name, most: int = TEXT) -> bytes:
    """The bytes of a regular file. Raises as `open_regular`, and OSError where it has more than `most`."""
    content = read_start(name, most)
    if len(content) > most:
        size = f"{most >> 20} MiB" if most >= 1 << 20 else f"{most} bytes"
        raise OSError(errno.EFBIG, f"it is too large; at most {size} are read")
    return content


def read_start(name: Name, most: int, patience: Optional[float] = None) -> bytes:
    """The bytes of a regular file, of a larger one the first `most` + 1. Raises as `open_regular`.

    With `patience` (seconds) it may be a pipe or a device, from which something has to come within that time each
    time; else OSError is raised.
    """
    if patience is None:
        with open_regular(name) as file:
            return file.read(most + 1) or b""
    content = b""
    with open(os.open(name, _FLAGS), "rb", buffering=0) as stream:
        ready = select.poll()
        ready.register(stream, select.POLLIN)
        while len(content) <= most:
            if not ready.poll(patience * 1000):
                raise OSError(errno.ETIMEDOUT, f"nothing came from it within {patience:g} seconds")
            more = stream.read(min(_PIECE, most + 1 - len(content)))
            if not more:
                break
            content += more
    return content


def _check(mode: int) -> None:
    """Raises OSError for what is no regular file."""
    if not stat.S_ISREG(mode):
        kind = next((kind for is_one, kind in _KINDS if is_one(mode)), "a device")
        raise OSError(errno.EINVAL, f"it is {kind}; expected a regular file")
