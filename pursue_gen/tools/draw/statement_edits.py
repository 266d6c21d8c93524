"""Changes of one statement, part by part: every comment in it and behind it stays."""

from __future__ import annotations

from typing import Dict, List, Mapping, Optional, Tuple

from lark import Token

from pursue_gen.language.edits import Edit, edited
from pursue_gen.language.messages import KEYWORDS
from pursue_gen.language.rewriting import REMARK
from pursue_gen.tools.lsp.document import Document
from pursue_gen.tools.lsp.edits import written
from pursue_gen.tools.lsp.statements import deleted, inserted
from pursue_gen.tools.lsp.tokens import Statement, are_names, end_of

PARTS: Mapping[str, Tuple[str, ...]] = {
    "POI": ("POI", "LABEL", "POSE"),
    "CONNECT": ("CONNECT", "AND", "DISTANCE", "ONE_WAY", "ONLY_IF"),
    "EVENT": ("EVENT", "LABEL", "COLLABORATIVE", "TOGETHER", "LOCATION", "DURATION", "AT_MOST", "ONLY_IF"),
    "AGENT": ("AGENT", "LABEL", "HUMAN", "CONTROLLABLE", "MOBILE", "LOCATION", "CAN_DO", "REACTS_TO"),
}
"""The parts of a statement by the word that begins each, in the order in which they stand."""

Part = Tuple[Token, ...]


def parts_of(statement: Statement) -> Dict[str, Part]:
    """The parts of a statement of PARTS that are there: the word that begins each → its tokens, that word first."""
    begins = PARTS[statement.kind]
    found: Dict[str, List[Token]] = {}
    current = ""
    for token, named in zip(statement.tokens, are_names(statement.tokens)):
        if token.type in begins and not named and token.type not in found and current != "ONLY_IF":
            current = token.type
            found[current] = []
        found[current].append(token)
    return {kind: tuple(tokens) for kind, tokens in found.items()}


def words_behind(statement: Statement, kind: str) -> str:
    """What stands behind the word that begins a part, without comments; "" where the part is not there."""
    return " ".join(parts_of(statement).get(kind, ())[1:])


def names_behind(statement: Statement, kind: str) -> List[str]:
    """The names in a list such as that behind `can_do`."""
    return [str(token) for token in parts_of(statement).get(kind, ())[1:] if token.type != "COMMA"]


def with_part(document: Document, number: int, kind: str, words: Optional[str]) -> Document:
    """The text with a part of a statement (by its number) written anew, added, or left out (None).

    `words` are those behind the word that begins the part; of a POSE they are the comment itself.
    """
    statement = document.statements[number]
    found = parts_of(statement)
    text = words if words is None or kind == "POSE" else f"{KEYWORDS[kind]} {words}".rstrip()
    old = found.get(kind, ())
    edits = [written(token, "") for token in old]
    if text is not None and old:
        edits[0] = Edit(edits[0].start, edits[0].end, text)
    elif text is not None:
        begins = PARTS[statement.kind]
        before = [part for part in begins[: begins.index(kind)] if part in found]
        at = end_of(found[before[-1]][-1])
        edits.append(Edit(at, at, f" {text}{_break(document, at) if kind == 'POSE' else ''}"))
    return changed(document, *edits)


def _break(document: Document, at: int) -> str:
    """A line end where a pose, which goes on to the end of its line, would otherwise swallow the begin of a block."""
    rest = document.text[at : document.positions.line_end(document.positions.line_of(at))].strip()
    return "" if not rest or rest.startswith("//") else "\n"


def without_remark(document: Document, number: int) -> Document:
    """The text without the remark behind a statement that says which command its number comes from: a person has
    written another one.
    """
    end = document.statements[number].end
    line = document.positions.line_end(document.positions.line_of(end))
    behind = (comment for comment in document.comments if end <= (comment.start_pos or 0) < line)
    remarks = [comment for comment in behind if REMARK.match(comment)]
    return changed(document, *(written(one, "") for one in remarks))


def restated(document: Document, number: int, words: str) -> Document:
    """The text with other words in the place of a statement's."""
    first, *others = document.statements[number].tokens
    return changed(document, written(first, words), *(written(token, "") for token in others))


def added(document: Document, words: str) -> Tuple[Document, int]:
    """The text with a new statement behind those of its kind, and the number of the statement."""
    edits = inserted(document, words)
    number = sum(statement.start < edits[0].start for statement in document.statements)
    return changed(document, *edits), number


def without(document: Document, numbers: List[int]) -> Document:
    """The text without these statements; comments in them and behind them stay."""
    edits: List[Edit] = []
    for number in numbers:
        statement = document.statements[number]
        if any(statement.start < (comment.start_pos or 0) < statement.end for comment in document.comments):
            edits += [written(token, "") for token in statement.tokens]
        else:
            edits += deleted(document, statement)
    return changed(document, *edits)


def changed(document: Document, *edits: Edit) -> Document:
    """The document after edits that do not overlap."""
    return Document(edited(document.text, edits), document.file, document.named)
