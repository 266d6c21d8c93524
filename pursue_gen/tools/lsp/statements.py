"""All statements of a text in the original's order."""

from __future__ import annotations

from typing import List, Tuple

from pursue_gen.language.document import Edit, rank
from pursue_gen.language.draft import Draft


def ordered(document: Draft) -> Tuple[Edit, ...]:
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


def _pieces(document: Draft) -> List[Tuple[int, str]]:
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
        end = document.line_end(part.end)
        end = len(document.text) if following is None else min(end + 1, following)
        if part.kind == "TAIL" and found:
            found[-1] = (found[-1][0], found[-1][1].rstrip("\n") + "\n" + document.text[at:end].lstrip("\n"))
        else:
            found.append((rank(part), document.text[at:end]))
        at = end
    return found


def _head_end(document: Draft, first: int) -> int:
    """Where the comment about the whole text ends: at the first empty line, if that is above the first statement."""
    gap = document.text.find("\n\n", 0, first)
    return gap + 2 if gap >= 0 and not document.in_comment(gap + 1) else 0
