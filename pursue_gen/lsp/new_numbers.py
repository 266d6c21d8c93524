"""Numbers that were measured, written into a scenario's text: each with where it comes from, as a comment.

All other comments stay. A number that is written again replaces the note of the one before it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterator, List, Optional, Sequence, Tuple, Union

from lark import Token

from pursue_gen.language.numbers import Number, decimal_text
from pursue_gen.language.scenario import Connection
from pursue_gen.lsp.document import Document, Edit, applied
from pursue_gen.lsp.edits import pair, written
from pursue_gen.lsp.statements import inserted
from pursue_gen.lsp.tokens import Statement, end_of


@dataclass(frozen=True)
class TravelTime:
    """`travel agent from a to b takes low to high` (time units). `source`: where it comes from, without `;`."""

    agent: str
    a: str
    b: str
    low: Number
    high: Number
    source: str


@dataclass(frozen=True)
class Duration:
    """`duration low to high` of an event that has a duration already. `source` as for TravelTime."""

    event: str
    low: Number
    high: Number
    source: str


@dataclass(frozen=True)
class Distance:
    """The distance of the way between a and b; of two ways in one direction each, of the one from a to b."""

    a: str
    b: str
    distance: Number
    source: str


NewNumber = Union[TravelTime, Duration, Distance]


def with_numbers(text: str, file: str, numbers: Sequence[NewNumber], by: str) -> str:
    """The text with these numbers; `by` is the program that found them, with which each note begins.

    A travel time that is not there yet is added behind the others. Raises ValueError for an event without a duration
    and for a way that is not in the text, which has to be a scenario without errors.
    """
    document = Document.of(text, file)
    edits: List[Edit] = []
    added: List[str] = []
    for number in numbers:
        part, old = _place(document, number)
        if part is None or old is None:
            if not isinstance(number, TravelTime):
                raise ValueError(f"nothing in {file} has this number: {number}")
            added.append(f"travel {number.agent} from {number.a} to {number.b} takes {_value(number)}"
                         f" // {_note(by, number.source)}")  # fmt: skip
            continue
        edits += [Edit(old[0].start_pos or 0, end_of(old[1]), _value(number)), _noted(document, part, by, number)]
    if added:  # first, as of edits at one place the first one stands last: a note comes before a new line
        edits = [*inserted(document, "\n".join(added)), *edits]
    return applied(document.text, tuple(edits))


def _value(number: NewNumber) -> str:
    if isinstance(number, Distance):
        return decimal_text(number.distance)
    return f"{decimal_text(number.low)} to {decimal_text(number.high)}"


def _note(by: str, source: str) -> str:
    return f"{by}: {source}"


Place = Tuple[Optional[Statement], Optional[Tuple[Token, Token]]]
"""The statement of a number, and the first and the last token of what stands there now."""


def _place(document: Document, number: NewNumber) -> Place:
    """Where the number is in the text; nothing where it is not."""
    scenario = document.scenario
    if isinstance(number, TravelTime):
        travels = (each for each in scenario.travels if each.agent.name == number.agent)
        travel = next((each for each in travels if each.way == (number.a, number.b)), None)
        return _window(document, None if travel is None else document.positions.of_span(travel.span)[0], "TAKES")
    if isinstance(number, Duration):
        event = next((each for each in scenario.events if each.name == number.event), None)
        return _window(document, None if event is None else document.positions.of_span(event.span)[0], "DURATION")
    way = next(_ways(scenario.connections, number), None)
    return _window(document, None if way is None else document.positions.of_span(way.span)[0], "DISTANCE")


def _ways(connections: Sequence[Connection], number: Distance) -> Iterator[Connection]:
    """The ways between two places, the one that leads in the wanted direction first."""
    wanted = number.a, number.b
    yield from (each for each in connections if wanted in each.directions)
    yield from (each for each in connections if {each.a, each.b} == set(wanted))


def _window(document: Document, offset: Optional[int], word: str) -> Place:
    """The statement at the offset, and the number behind the word, or both numbers of its window."""
    part = None if offset is None else document.statement_at(offset)
    found = pair(part, word)
    if part is None or found is None:
        return part, None
    first = found[1]
    behind: Dict[int, Token] = dict(enumerate(part.tokens[part.tokens.index(first) + 1 :]))
    to, last = behind.get(0), behind.get(1)
    both = to is not None and last is not None and (to.type, last.type) == ("TO", "NUMBER")
    return part, (first, last if both and last is not None else first)


def _noted(document: Document, part: Statement, by: str, number: NewNumber) -> Edit:
    """Where the number comes from, behind its statement; in the comment that stands there, if one does."""
    note = _note(by, number.source)
    end = part.end
    line_end = document.positions.line_end(document.positions.line_of(end))
    rest = document.text[end:line_end]
    if not rest.strip():
        return Edit(end, line_end, f" // {note}")
    comment = next((c for c in document.comments if end <= (c.start_pos or 0) < line_end), None)
    alone = comment is not None and not document.text[end : comment.start_pos].strip()
    if comment is not None and alone and comment.startswith("//"):
        return written(comment, _joined(str(comment), by, note))
    if comment is not None and alone and comment.startswith(f"/* {by}: "):
        return written(comment, f"/* {note} */")
    return Edit(end, end, f" /* {note} */")


def _joined(comment: str, by: str, note: str) -> str:
    """A comment with the note at its end, and without an earlier one of the same program."""
    kept = ";".join(each for each in comment[2:].split(";") if not each.strip().startswith(f"{by}: ")).rstrip()
    return f"//{kept}; {note}" if kept.strip() else f"// {note}"
