"""Changes of whole statements: where a new one goes, how one is deleted, and all of them in the original's order."""

from __future__ import annotations

from typing import Dict, List, Tuple

from pursue_gen.language.edits import Edit
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.tokens import Statement

_ORDER = (
    "POI", "CONNECT", "EVENT", "RULE", "STATE", "STATEDEPENDENCY", "AGENT", "TRAVEL", "BATTERY", "ASSUME", "OBJECTIVE",
)  # fmt: skip
_RANK: Dict[str, int] = {kind: rank for rank, kind in enumerate(_ORDER)}


def rank(part: Statement) -> int:
    """The place of a statement's kind in the order that the original reads."""
    return _RANK.get(part.kind, _RANK["OBJECTIVE"])


def inserted(document: Document, statement: str) -> Tuple[Edit, ...]:
    """The edit that adds a statement, behind the last one of its kind or of a kind that goes before."""
    word = statement.split(" ", 1)[0].rstrip(":")
    kind = {"connect": "CONNECT", "stateDependency": "STATEDEPENDENCY"}.get(word, word.upper())
    new = _RANK.get(kind, _RANK["OBJECTIVE"])
    before = [part for part in document.statements if rank(part) <= new]
    if before:
        at = line_end(document, before[-1].end)
        gap = "\n" if rank(before[-1]) == new else "\n\n"
        return (Edit(at, at, gap + statement),)
    if document.statements:
        at = document.positions.line_start(document.positions.line_of(document.statements[0].start))
        return (Edit(at, at, statement + "\n\n"),)
    end = len(document.text)
    return (Edit(end, end, ("\n" if document.text.strip() else "") + statement + "\n"),)


def line_end(document: Document, offset: int) -> int:
    """The end of the line that an offset is in; further down where a comment behind the statement goes on there."""
    end = document.positions.line_end(document.positions.line_of(offset))
    for token in document.comments:
        start = token.start_pos or 0
        if offset <= start < end < start + len(token):
            end = document.positions.line_end(document.positions.line_of(start + len(token)))
    return end


def deleted(document: Document, part: Statement) -> Tuple[Edit, ...]:
    """The edit that deletes a statement, with its line where nothing else stands in that."""
    start, end = part.start, part.end
    line_start = document.positions.line_start(document.positions.line_of(start))
    if not document.text[line_start:start].strip():
        rest = document.positions.line_end(document.positions.line_of(end))
        if not document.text[end:rest].strip():
            start, end = line_start, min(rest + 1, len(document.text))
    return (Edit(start, end, ""),)


def ordered(document: Document) -> Tuple[Edit, ...]:
    """The edit that brings the statements into the original's order; comments stay with the statement they precede.

    None where a statement cannot be read: its end is not known.
    """
    if document.reading.scenario is None:
        return ()
    pieces = _pieces(document)
    parts = [piece for piece in pieces if piece[0] >= 0]
    in_order = sorted(parts, key=lambda piece: piece[0])
    if parts == in_order:
        return ()
    text = "".join(piece[1] for piece in pieces if piece[0] < 0)
    for number, (at, piece) in enumerate(in_order):
        new_kind = number > 0 and at != in_order[number - 1][0]
        body = piece.strip("\n") if new_kind or number == 0 else piece.rstrip("\n").lstrip("\n")
        text += ("\n" if new_kind else "") + body + "\n"
    return (Edit(0, len(document.text), text),)


def _pieces(document: Document) -> List[Tuple[int, str]]:
    """(rank, text) of each statement with the comments above it and behind it; -1 for the text's head."""
    found: List[Tuple[int, str]] = []
    at = 0
    for number, part in enumerate(document.statements):
        if number == 0:
            head = _head_end(document, part.start)
            if head:
                found.append((-1, document.text[:head]))
            at = head
        following = document.statements[number + 1].start if number + 1 < len(document.statements) else None
        end = line_end(document, part.end)
        end = len(document.text) if following is None else min(end + 1, following)
        if part.kind == "TAIL" and found:
            found[-1] = (found[-1][0], found[-1][1].rstrip("\n") + "\n" + document.text[at:end].lstrip("\n"))
        else:
            found.append((rank(part), document.text[at:end]))
        at = end
    return found


def _head_end(document: Document, first: int) -> int:
    """Where the comment about the whole text ends: at the first empty line, if that is above the first statement."""
    gap = document.text.find("\n\n", 0, first)
    return gap + 2 if gap >= 0 and not document.in_comment(gap + 1) else 0
