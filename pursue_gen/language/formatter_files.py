"""Files and their layout: what would change in a file, and the change itself, completely or not at all."""

from __future__ import annotations

import contextlib
import difflib
import os
import stat
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import List

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.language.formatter import format_text
from pursue_gen.language.parser import read_bytes, text_of


@dataclass(frozen=True)
class Layout:
    """A text before and after; `file` is what messages call it. Before, its line ends are as they stand in the file."""

    file: str
    before: str
    after: str
    changed: bool

    def diff(self) -> str:
        """What changes, as `diff -u` has it; line ends of other systems are changes, too."""
        changes = difflib.unified_diff(_lines(self.before), _lines(self.after), fromfile=self.file, tofile=self.file)
        return "".join(line if line.endswith("\n") else line + "\n\\ No newline at end of file\n" for line in changes)


def _lines(text: str) -> List[str]:
    """The lines with their ends; only a line feed is one."""
    *lines, rest = text.split("\n")
    return [line + "\n" for line in lines] + ([rest] if rest else [])


def layout_of(file: str) -> Layout:
    """The layout of a scenario file. Raises PursueError where it cannot be read, or has syntax errors."""
    path = Path(file)
    if path.exists() and not path.is_file():
        message = f"{file} is not a file whose text could be changed"
        raise PursueError([error("CLI001", message, hint="name scenario files; - stands for stdin")])
    return layout_of_bytes(read_bytes(file), file)


def layout_of_bytes(data: bytes, file: str) -> Layout:
    """The layout of a text in UTF-8 that is in no file. Raises PursueError as `layout_of`."""
    after = format_text(text_of(data, file), file)
    return Layout(file, data.decode("utf-8-sig"), after, data != after.encode("utf-8"))


def replace_text(layout: Layout) -> None:
    """Puts the text into its file, which keeps its mode; behind a link, into the file that the link leads to.

    Raises PursueError (exit status 2) where that cannot be; the file is then as it was.
    """
    place = Path(layout.file).resolve()
    staged = ""
    try:
        if not os.access(str(place), os.W_OK):
            raise PermissionError(None, "it is write-protected")
        before = place.stat()
        handle, staged = tempfile.mkstemp(prefix=f".{place.name}.", dir=str(place.parent))
        with open(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(layout.after)
        with contextlib.suppress(OSError):  # only root may give a file away
            os.chown(staged, before.st_uid, before.st_gid)
        os.chmod(staged, stat.S_IMODE(before.st_mode))
        os.replace(staged, str(place))
        staged = ""
    except OSError as problem:
        message = f"cannot write {layout.file}: {problem.strerror or problem}"
        hint = "allow writing there, or print the text with: pursue-gen fmt - < FILE"
        raise PursueError([error("CLI003", message, hint=hint)]) from None
    finally:
        if staged:
            with contextlib.suppress(OSError):
                os.unlink(staged)
