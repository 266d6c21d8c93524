"""The scenario's file: read when the page opens, written when the person saves, never over another change."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple

from pursue_gen.diagnostics import PursueError, error, usage_error
from pursue_gen.files import shell_quoted, write_texts
from pursue_gen.language.formatter_files import Layout, replace_text
from pursue_gen.language.parser import read_text
from pursue_gen.lsp.positions import plain


@dataclass(frozen=True)
class Stored:
    """What the file held when it was last read or written; None: there was no file."""

    file: Path
    content: Optional[bytes]


def opened(file: Path) -> Tuple[Stored, str]:
    """The file and its text, "" where there is none yet. Raises PursueError (exit status 2)."""
    if file.is_symlink():
        raise _cannot(file, "it is a link", "name the file that it leads to")
    if not file.exists():
        if not file.parent.is_dir():
            raise _cannot(file, f"there is no folder {file.parent}", "make it first, or name another place")
        return Stored(file, None), ""
    if not file.is_file():
        raise _cannot(file, "it is no file whose text could be changed", "name a scenario, by convention *.pur")
    text = plain(read_text(str(file)))
    return Stored(file, file.read_bytes()), text


def started(file: Path, force: bool) -> Stored:
    """A file that is to be made, which is not there yet. Raises PursueError (exit status 2) where it is, unless
    `force`: then its text is replaced when the person saves.
    """
    stored, _ = opened(file)
    if stored.content is not None and not force:
        named = shell_quoted(file)
        hint = f"to go on with it, name it: pursue-gen draw {named}; to begin anew and replace it: --force"
        raise usage_error(f"{file} is there already", hint)
    return stored


def is_unchanged(stored: Stored) -> bool:
    """True where the file still holds what it held."""
    return _content(stored.file) == stored.content


def saved(stored: Stored, text: str) -> Stored:
    """Writes the text, completely or not at all; an existing file keeps its mode. Raises PursueError where it cannot be
    written, or has become a link.
    """
    file = stored.file
    if file.is_symlink():
        raise _cannot(file, "it is a link", "name the file that it leads to")
    if file.exists():
        replace_text(Layout(str(file), "", text, True))
    else:
        write_texts({file: text})
    return Stored(file, text.encode("utf-8"))


def _content(file: Path) -> Optional[bytes]:
    try:
        return file.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as problem:
        raise _cannot(file, problem.strerror or str(problem), "allow reading it") from None


def _cannot(file: Path, why: str, hint: str) -> PursueError:
    return PursueError([error("CLI001", f"{file} cannot be drawn: {why}", hint=hint)], exit_status=2)
