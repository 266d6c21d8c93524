"""The scenario's file: read when the page opens, written when the person saves, never over another change."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Tuple

from pursue_gen.diagnostics import PursueError, error, usage_error
from pursue_gen.files import shell_quoted, write_texts
from pursue_gen.language.formatter import Layout, replace_text
from pursue_gen.language.parser import MOST_BYTES, read_text
from pursue_gen.language.tokens import plain
from pursue_runtime.named_files import read_all

NOTHING = ""
"""The version of a file that is not there."""


def opened(file: Path) -> Tuple[str, str]:
    """The text of a file, and its version; of a file that is not there yet "" and NOTHING.

    Raises PursueError (exit status 2).
    """
    if file.is_symlink():
        raise _cannot(file, "it is a link", "name the file that it leads to")
    if not file.exists():
        if not file.parent.is_dir():
            raise _cannot(file, f"there is no folder {file.parent}", "make it first, or name another place")
        return "", NOTHING
    if not file.is_file():
        raise _cannot(file, "it is no file whose text could be changed", "name a scenario, by convention *.pur")
    version_before = version(file)
    return plain(read_text(str(file))), version_before


def check_new(file: Path, force: bool) -> None:
    """Raises PursueError (exit status 2) where a file that is to be begun cannot be, or is there already; with `force`
    it may be there.
    """
    _, found = opened(file)
    if found != NOTHING and not force:
        named = shell_quoted(file)
        hint = f"to go on with it, name it: pursue-gen draw {named}; to begin anew and replace it: --force"
        raise usage_error(f"{file} is there already", hint)


def version(file: Path) -> str:
    """What stands for the content of a file. Raises PursueError (exit status 2) where it cannot be read."""
    try:
        return hashlib.sha256(read_all(file, MOST_BYTES)).hexdigest()
    except FileNotFoundError:
        return NOTHING
    except OSError as problem:
        raise _cannot(file, problem.strerror or str(problem), "allow reading it") from None


def save(file: Path, text: str) -> str:
    """Writes the text, completely or not at all, and returns the file's version; an existing file keeps its mode.

    Raises PursueError (exit status 2) where it cannot be written, or is a link.
    """
    if file.is_symlink():
        raise _cannot(file, "it is a link", "name the file that it leads to")
    if file.exists():
        replace_text(Layout(str(file), "", text, True))
    else:
        write_texts({file: text})
    return version(file)


def _cannot(file: Path, why: str, hint: str) -> PursueError:
    return PursueError([error("CLI001", f"{file} cannot be drawn: {why}", hint=hint)])
