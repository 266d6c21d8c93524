"""Changes of one statement, part by part: every comment in it and behind it stays."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import List, Optional, Tuple

from pursue_gen.language.document import Edit, written
from pursue_gen.language.draft import Draft
from pursue_gen.language.rewriting import part_edits, parts_of, remark_behind
from pursue_gen.language.syntax import Statement


def words_behind(statement: Statement, kind: str) -> str:
    """What stands behind the word that begins a part, without comments; "" where the part is not there."""
    return re.sub(r"(?<=\() | (?=[),])", "", " ".join(parts_of(statement).get(kind, ())[1:]))


def names_behind(statement: Statement, kind: str) -> List[str]:
    """The names in a list such as that behind `can_do`."""
    return [str(token) for token in parts_of(statement).get(kind, ())[1:] if token.type != "COMMA"]


def with_part(document: Draft, number: int, kind: str, words: Optional[str]) -> Draft:
    """The text with a part of a statement (by its number) written anew, added, or left out (None).

    `words` are those behind the word that begins the part; of a POSE they are the comment itself.
    """
    statement = document.statements[number]
    edits = part_edits(statement, kind, words)
    if kind == "POSE" and len(edits) == 1 and edits[0].start == edits[0].end:
        edits = [replace(edits[0], text=edits[0].text + _break(document, edits[0].end))]
    return document.changed(*edits)


def _break(document: Draft, at: int) -> str:
    """A line end where a pose, which goes on to the end of its line, would otherwise swallow the begin of a block."""
    rest = document.text[at : document.lines.end_at(at)].strip()
    return "" if not rest or rest.startswith("//") else "\n"


def without_remark(document: Draft, number: int) -> Draft:
    """The text without the remark behind a statement that says which command its number comes from: a person has
    written another one.
    """
    remark = remark_behind(document, document.statements[number])
    return document if remark is None else document.changed(written(remark, ""))


def restated(document: Draft, number: int, words: str) -> Draft:
    """The text with other words in the place of a statement's."""
    first, *others = document.statements[number].tokens
    return document.changed(written(first, words), *(written(token, "") for token in others))


def added(document: Draft, words: str) -> Tuple[Draft, int]:
    """The text with a new statement behind those of its kind, and the number of the statement."""
    edit = document.inserted(words)
    number = sum(statement.start < edit.start for statement in document.statements)
    return document.changed(edit), number


def without(document: Draft, numbers: List[int]) -> Draft:
    """The text without these statements; comments in them and behind them stay."""
    edits: List[Edit] = []
    for number in numbers:
        statement = document.statements[number]
        if document.comments_in(statement):
            edits += [written(token, "") for token in statement.tokens]
        else:
            edits.append(document.deleted(statement))
    return document.changed(*edits)
