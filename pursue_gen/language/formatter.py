"""The layout of a PuRSUE-ML text: blanks and line breaks change, words, comments and their order never do; and of
files, which change completely or not at all."""

from __future__ import annotations

import contextlib
import difflib
import os
import stat
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Tuple

from pursue_gen.diagnostics import PursueError, Severity, error
from pursue_gen.language.document import Document
from pursue_gen.language.kinds import MAY_BREAK, section_of
from pursue_gen.language.parser import read_bytes, text_of
from pursue_gen.outcomes import Invalid

WIDTH = 100
"""A statement that is longer goes on in the next line, where it can be broken; a comment is as long as it is."""

INDENT = "    "
_CLOSE = frozenset({"COMMA", "COLON", "RPAR"})
_MOST_PADDING = 20
_LINE = "LINE"
_COMMENTS: Dict[str, str] = {"LINE_COMMENT": _LINE, "POSE": _LINE, "BLOCK_COMMENT": "BLOCK"}


@dataclass(frozen=True)
class _Item:
    """A word or a comment, as it stands in the text but for blanks at the ends of its lines.

    `kind`: the token, of comments as in _COMMENTS; `breaks`: how many lines it stands below the item before, or below
    the text's beginning.
    """

    kind: str
    text: str
    breaks: int

    @property
    def is_comment(self) -> bool:
        return self.kind in _COMMENTS.values()


@dataclass(frozen=True)
class _Block:
    """A statement with the comments in and behind it, or comments that stand alone.

    `kind`: the word that begins the statement, "" for comments; `blank`: there is an empty line above; `text`: the
    lines without their last comment; `remark`: that comment, where it is the only one and the text is one line.
    """

    kind: str
    blank: bool
    text: str
    remark: str = ""


def format_text(text: str, file: str) -> str:
    """The text in the one layout; `file` is what messages call it.

    One statement a line, wrapped at `WIDTH` columns; an empty line between kinds of statements, elsewhere at most one
    where there was one; comments at the end of neighbouring lines begin in one column; line ends are newlines. The
    same text comes back when it is formatted again, and it means the same scenario. Raises PursueError with every
    syntax error; other findings (a name that is declared nowhere) do not matter here.
    """
    return formatted(Document(text.replace("\r\n", "\n").replace("\r", "\n"), file))


def formatted(document: Document) -> str:
    """As `format_text`."""
    errors = [finding for finding in document.syntax.findings if finding.severity is Severity.ERROR]
    if errors:
        raise Invalid(errors)
    blocks = [_block(items) for items in _items(document)]
    lines: List[str] = []
    for block in _aligned(_spaced(blocks)):
        lines += ["", block.text] if block.blank and lines else [block.text]
    return "".join(line + "\n" for line in lines)


def _items(document: Document) -> Iterator[List[_Item]]:
    """The items of each block."""
    line = 1
    for block in document.blocks:
        items = []
        for token in block:
            text = "\n".join(part.rstrip(" \t\f") for part in token.split("\n"))
            text = " ".join(text.split()) if token.type == "NUMBER" else text
            items.append(_Item(_COMMENTS.get(token.type, token.type), text, (token.line or line) - line))
            line = token.end_line or line
        yield items


def _block(group: List[_Item]) -> _Block:
    first, last = group[0], group[-1]
    kind = "" if first.is_comment else section_of(_begins(group).kind)
    if kind and last.kind == _LINE and not any(item.is_comment for item in group[:-1]):
        return _Block(kind, first.breaks > 1, _laid_out(group[:-1]), last.text)
    return _Block(kind, first.breaks > 1, _laid_out(group))


def _begins(group: List[_Item]) -> _Item:
    """The word that begins a statement; of one that is for each of a group, the one behind the colon."""
    words = [item for item in group if not item.is_comment]
    colon = next((number for number, item in enumerate(words) if item.kind == "COLON"), len(words))
    return words[colon + 1] if words[0].kind == "FOR" and colon + 1 < len(words) else words[0]


def _laid_out(group: List[_Item]) -> str:
    """The items in lines: words are filled into lines, comments stay behind what they stand behind."""
    result = ""
    for text, width, forced in _pieces(group):
        column = len(result) - result.rfind("\n") - 1
        if not result:
            result = text
        elif forced or column + 1 + width > WIDTH:
            result += "\n" + INDENT + text
        else:
            result += " " + text
    return result


def _pieces(group: List[_Item]) -> Iterator[Tuple[str, int, bool]]:
    """What is never torn apart: (its text, the width that counts, whether it has to begin a line)."""
    piece: List[_Item] = []
    forced = False
    word: Optional[_Item] = None  # the last one that is no comment
    for item in group:
        own_line = item.is_comment and item.breaks > 0
        ended = bool(piece) and (piece[-1].kind == _LINE or (piece[0].is_comment and not item.is_comment))
        may = not item.is_comment and (item.kind in MAY_BREAK or (word is not None and word.kind == "COMMA"))
        if piece and (own_line or ended or may):
            yield (*_joined(piece), forced)
            piece, forced = [], own_line or ended
        piece.append(item)
        word = word if item.is_comment else item
    yield (*_joined(piece), forced)


def _joined(piece: List[_Item]) -> Tuple[str, int]:
    """The items of a piece with blanks where they belong, and its width: a comment to the end of the line is free."""
    words: List[str] = []
    before: Optional[_Item] = None
    for item in piece:
        opened = before is not None and before.kind == "LPAR" and item.kind != _LINE
        close = before is None or opened or item.kind in _CLOSE
        words.append(item.text if close else " " + item.text)
        before = item
    text = "".join(words)
    counted = text if piece[-1].kind != _LINE else text[: -len(words[-1])]
    return text, len(counted.split("\n")[0])


def _spaced(blocks: List[_Block]) -> List[_Block]:
    """The blocks with an empty line wherever the kind of statement changes, above the comments of the next kind."""
    result: List[_Block] = []
    kind, behind = "", 0  # the kind of the last statement, and the place behind it
    for block in blocks:
        result.append(block)
        if not block.kind:
            continue
        if kind not in ("", block.kind) and not any(between.blank for between in result[behind:]):
            result[behind] = replace(result[behind], blank=True)
        kind, behind = block.kind, len(result)
    return result


def _aligned(blocks: List[_Block]) -> Iterator[_Block]:
    """The blocks with their remarks in one column, where neighbours of one kind are about equally long."""
    run: List[_Block] = []
    for block in blocks:
        if run and (block.blank or not block.remark or block.kind != run[0].kind):
            yield from _in_column(run)
            run = []
        if block.remark:
            run.append(block)
        else:
            yield block
    yield from _in_column(run)


def _in_column(run: List[_Block]) -> Iterator[_Block]:
    widths = [len(block.text.split("\n")[-1]) for block in run]
    for block, width in zip(run, widths):
        column = max(widths) if max(widths) - min(widths) <= _MOST_PADDING else width
        yield replace(block, text=block.text + " " * (column - width + 1) + block.remark)


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
