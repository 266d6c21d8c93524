"""What a text consists of: its statements for an outline, and stretches that can be folded away."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import groupby
from typing import Dict, List, Tuple

from pursue_gen.language.draft import Draft
from pursue_gen.language.kinds import KEYWORDS, STATEMENTS, section_of
from pursue_gen.language.tokens import bare, end_of, start_of


@dataclass(frozen=True)
class Symbol:
    """A statement in the outline: text[start:end], of which text[name_start:name_end] names it.

    `detail`: what it declares, and its label.
    """

    name: str
    detail: str
    kind: str
    start: int
    end: int
    name_start: int
    name_end: int


@dataclass(frozen=True)
class Fold:
    """Lines that fold into their first one, counted from 0, both included."""

    first: int
    last: int
    comment: bool


def symbols(document: Draft) -> Tuple[Symbol, ...]:
    """The outline: a symbol for each statement that begins like one, in the order of the text."""
    found = []
    for part in document.statements:
        if part.kind not in STATEMENTS:
            continue
        words = " ".join(document.text[part.start : part.end].split())
        token = part.name
        if token is not None and len(token) > 2:
            start = start_of(token) + 1
            name, detail = bare(token), KEYWORDS[part.kind]
            behind = part.tokens[2:4]
            if [one.type for one in behind] == ["LABEL", "NAME"]:
                detail += f" {behind[1]}"
            found.append(Symbol(name, detail, part.kind, part.start, part.end, start, start + len(token) - 2))
        else:
            name, end = words[:80], part.start + len(part.tokens[0])
            found.append(Symbol(name, "", part.kind, part.start, part.end, part.start, end))
    return tuple(found)


def folds(document: Draft) -> Tuple[Fold, ...]:
    """Sections (neighbouring statements of one kind), statements over several lines, and comments over several."""
    line_of = document.lines.of
    found: Dict[Tuple[int, int], Fold] = {}

    def add(first: int, last: int, comment: bool = False) -> None:
        if last > first:
            found.setdefault((first, last), Fold(first, last, comment))

    for _, section in groupby(document.statements, key=lambda part: section_of(part.kind)):
        parts = list(section)
        for part in parts:
            add(line_of(part.start), line_of(part.end))
        add(line_of(parts[0].start), line_of(parts[-1].end))
    block: List[int] = []
    for token in document.comments:
        start = start_of(token)
        first, last = line_of(start), line_of(end_of(token))
        alone = not document.text[document.lines.start(first) : start].strip()
        if token.type == "LINE_COMMENT" and alone and block and first == block[-1] + 1:
            block.append(first)
            continue
        add(*_ends(block), comment=True)
        block = [first] if token.type == "LINE_COMMENT" and alone else []
        if token.type != "LINE_COMMENT":
            add(first, last, comment=True)
    add(*_ends(block), comment=True)
    return tuple(found[key] for key in sorted(found))


def _ends(block: List[int]) -> Tuple[int, int]:
    return (block[0], block[-1]) if block else (0, 0)
