"""The scenarios that come with the package: which there are, and what each is about."""

from __future__ import annotations

import difflib
import re
import shutil
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import Tuple

from pursue_gen.diagnostics import usage_error
from pursue_gen.files import read_text, write_texts

_COMMENT = re.compile(r"\s*((?://[^\n]*\n?[ \t]*)+|/\*.*?\*/)", re.S)
_SIGNS = re.compile(r"^[ \t]*(//+|/\*+|\*+/|\*)[ \t]?|[ \t]*\*+/[ \t]*$", re.M)


@dataclass(frozen=True)
class Example:
    """A scenario: its name (folder and file, without .pur), its file, the first sentence of its first comment."""

    name: str
    file: Path
    about: str


def examples_dir() -> Path:
    """The scenarios: beside the installed modules, or in the checkout they run from."""
    package = Path(__file__).resolve().parents[2]
    installed = package / "_scenarios"
    return installed if installed.is_dir() else package.parent / "scenarios"


def examples() -> Tuple[Example, ...]:
    """All that there are, by name."""
    folder = examples_dir()
    files = {file.relative_to(folder).with_suffix("").as_posix(): file for file in folder.rglob("*.pur")}
    return tuple(Example(name, files[name], about(read_text(files[name], "an example"))) for name in sorted(files))


def about(text: str) -> str:
    """The first sentence of the comment that a text begins with; "" where there is none."""
    found = _COMMENT.match(text)
    words = " ".join(_SIGNS.sub("", found.group(1)).split()) if found else ""
    return re.split(r"(?<=[.!?]) (?=[A-Z])", words, maxsplit=1)[0]


def example(name: str) -> Example:
    """The example with this name; its last part is enough where no other one has it. Raises PursueError (status 2)."""
    known = examples()
    wanted = name[:-4] if name.endswith(".pur") else name
    found = [each for each in known if each.name == wanted] or [each for each in known if each.file.stem == wanted]
    if len(found) == 1:
        return found[0]
    if found:
        raise usage_error(
            f"there are {len(found)} examples {wanted}", "name one: " + ", ".join(each.name for each in found)
        )
    words = {word: each.name for each in known for word in (each.file.stem, each.name)}
    close = difflib.get_close_matches(wanted, list(words), n=1)
    hint = f"did you mean {words[close[0]]}?" if close else "pursue-gen examples lists them"
    raise usage_error(f"there is no example {name}", hint)


def copied(wanted: Example, folder: Path, force: bool) -> Path:
    """Copies the example into the folder, and says where it is. A file there that is another one stays without `force`.

    Raises PursueError (exit status 2) where it cannot be written.
    """
    file, text = folder / wanted.file.name, read_text(wanted.file, "an example")
    if file.exists() and not force and not (file.is_file() and read_text(file, "another place with -o") == text):
        hint = "name another folder with -o, or replace it with --force"
        raise usage_error(f"{file} is there already, and is not this example", hint)
    write_texts({file: text})
    return file


def listed(known: Tuple[Example, ...], terminal: bool) -> str:
    """One line for each example; on a terminal broken at its width, so that names stand out."""
    column = max((len(each.name) for each in known), default=0) + 2
    width = max(shutil.get_terminal_size().columns, column + 30)
    lines = [f"{each.name:{column}}{each.about}".rstrip() for each in known]
    if terminal:
        lines = [textwrap.fill(line, width, subsequent_indent=" " * column, break_on_hyphens=False) for line in lines]
    return "\n".join(lines)
