"""Files that the user names: read with an error where that fails, written completely or not at all.

YAML is read as a tree of nodes with their positions, for messages with line and column.
"""

from __future__ import annotations

import contextlib
import os
import shlex
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, List, Mapping, Optional, Tuple

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_runtime import named_files

if TYPE_CHECKING:
    from pursue_runtime.bounded import Bounds

LARGEST_TEXT = 256 << 20
"""Bytes of a text that a program has written: a plan, a network."""


def read_text(file: Path, what: str, most: int = named_files.TEXT) -> str:
    """The text of a regular file of at most so many bytes; `what` describes in messages the expected file.

    Raises PursueError (exit status 2).
    """
    try:
        return named_files.read_text(file, most)
    except UnicodeDecodeError as problem:
        message = f"{file} is not text in UTF-8 (byte {problem.start + 1})"
        raise PursueError([error("CLI002", message, hint=f"name {what}")]) from None
    except (OSError, ValueError) as problem:
        message = f"cannot read {file}: {reason_of(problem)}"
        raise PursueError([error("CLI001", message, hint=f"name {what}")]) from None


def write_texts(texts: Mapping[Path, str]) -> None:
    """Write all the files as UTF-8, and make their folders; none is replaced before all are on the disk.

    Raises PursueError (exit status 2) where a file cannot be written, or is a link to one.
    """
    write_bytes({file: text.encode("utf-8") for file, text in texts.items()})


def check_new(file: Path, force: bool) -> None:
    """Raises PursueError (exit status 2) where a command that takes long would not write the file at its end: it is
    there already, unless `force`, or it is a link.
    """
    if file.is_symlink():
        message = f"cannot write {file}: it is a link"
        raise PursueError([error("CLI003", message, hint="name the file that it leads to, or another one")])
    if file.exists() and not force:
        message = f"cannot write {file}: it is there already"
        raise PursueError([error("CLI003", message, hint="name another file, or replace it with --force")])


def write_bytes(contents: Mapping[Path, bytes]) -> None:
    """Write files of bytes, otherwise as `write_texts`."""
    staged: List[Tuple[str, Path]] = []
    try:
        for file, content in contents.items():
            if file.is_dir():
                raise IsADirectoryError(None, "it is a folder")
            if file.exists() and not file.is_file():  # a pipe or /dev/stdout: nothing to replace
                file.write_bytes(content)
                continue
            if file.is_symlink():
                raise OSError(None, "it is a link: name the file that it leads to, or remove it")
            file.parent.mkdir(parents=True, exist_ok=True)
            handle, name = tempfile.mkstemp(prefix=f".{file.name}.", dir=str(file.parent))
            staged.append((name, file))
            with open(handle, "wb") as stream:
                stream.write(content)
            os.chmod(name, 0o666 & ~_umask())
        while staged:
            name, file = staged[0]
            os.replace(name, file)  # of a link the link itself, if one has come meanwhile
            staged.pop(0)
    except OSError as problem:
        message = f"cannot write {file}: {reason_of(problem)}"
        raise PursueError([error("CLI003", message, hint="name another place with -o")]) from None
    finally:
        for name, _ in staged:
            with contextlib.suppress(OSError):
                os.unlink(name)


def compose_yaml(text: str, file: str, code: str, hint: str, bounds: Optional[Bounds] = None) -> Any:
    """The text as PyYAML's tree of nodes, None for an empty text; `file` is its name in messages. `bounds`: what it may
    hold, where that is more than what people write.

    Raises PursueError with this code and hint where the text is not YAML, or is refused (exit status 2).
    """
    # Most commands read no YAML, and PyYAML takes long to import.
    from pursue_runtime.bounded import SETTINGS, BadText, yaml_tree

    try:
        return yaml_tree(text, bounds or SETTINGS)
    except BadText as problem:
        line, column = max(1, problem.line), max(1, problem.column)
        place = Span(file, line, column, line, column + 1)
        raise PursueError([error(code, problem.reason, place, hint)]) from None


def span_of(node: Any, file: str) -> Span:
    """The span of a node of the tree; of None the beginning of the file."""
    if node is None:
        return Span(file, 1, 1, 1, 2)
    start, end = node.start_mark, node.end_mark
    return Span(file, start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def shell_quoted(path: Path) -> str:
    """The path, quoted for a shell."""
    return shlex.quote(str(path))


def reason_of(problem: Exception) -> str:
    """Why a file could not be read or written, in words."""
    return getattr(problem, "strerror", None) or str(problem)


def _umask() -> int:
    """The mask of this process; it can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
