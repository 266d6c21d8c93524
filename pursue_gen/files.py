"""Text files that a person names: read with a message where that fails, written completely or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import List, Mapping, Tuple

from pursue_gen.diagnostics import PursueError, error


def read_text(file: Path, what: str) -> str:
    """The text of a file; `what` says in messages what was expected there. Raises PursueError (exit status 2)."""
    try:
        return file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as problem:
        message = f"{file} is not text in UTF-8 (byte {problem.start + 1})"
        raise PursueError([error("CLI002", message, hint=f"name {what}")], exit_status=2) from None
    except (OSError, ValueError) as problem:
        message = f"cannot read {file}: {_reason(problem)}"
        raise PursueError([error("CLI001", message, hint=f"name {what}")], exit_status=2) from None


def write_texts(texts: Mapping[Path, str]) -> None:
    """Writes all the files as UTF-8, making their folders; none is replaced before all are on the disk.

    Raises PursueError (exit status 2) where that cannot be.
    """
    write_bytes({file: text.encode("utf-8") for file, text in texts.items()})


def write_bytes(contents: Mapping[Path, bytes]) -> None:
    """As `write_texts`, with files that are no texts."""
    staged: List[Tuple[str, Path]] = []
    try:
        for file, content in contents.items():
            if file.is_dir():
                raise IsADirectoryError(None, "it is a folder")
            if file.exists() and not file.is_file():  # a pipe or /dev/stdout: nothing to replace
                file.write_bytes(content)
                continue
            file.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(prefix=f".{file.name}.", dir=str(file.parent))
            staged.append((name, file.resolve()))
            with open(handle, "wb") as stream:
                stream.write(content)
            os.chmod(name, 0o666 & ~_umask())
        while staged:
            os.replace(*staged[0])
            staged.pop(0)
    except OSError as problem:
        message = f"cannot write {file}: {_reason(problem)}"
        raise PursueError([error("CLI003", message, hint="name another place with -o")], exit_status=2) from None
    finally:
        for name, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(name)


def _reason(problem: Exception) -> str:
    return getattr(problem, "strerror", None) or str(problem)


def _umask() -> int:
    """The mask of this process; it can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
