"""What comes of statements that are for each of a group: it has a name and a place, and is changed in its statement."""

from __future__ import annotations

from typing import Dict, List

from pursue_gen.diagnostics import PursueError, Span
from pursue_gen.language.draft import Draft
from pursue_gen.language.names import declared
from pursue_gen.language.occurrences import GROUP
from pursue_gen.tools.draw.fields import refused


def made(document: Draft, kind: str) -> Dict[str, Span]:
    """The names of a kind that come of such statements, with their places."""
    known = {} if kind == GROUP else declared(document.scenario, kind)
    return {name: span for name, span in known.items() if span.member and name not in document.declared[kind]}


def names(document: Draft, kind: str) -> List[str]:
    """All names of a kind."""
    return [*document.declared[kind], *made(document, kind)]


def number_at(document: Draft, span: Span) -> int:
    """The number of the statement at a place."""
    start = document.lines.of_span(span)[0]
    return max(number for number, statement in enumerate(document.statements) if statement.start <= start)


def not_there(document: Draft, kind: str, name: str) -> PursueError:
    """Why what has this name cannot be changed: it comes of a statement for each of a group, or is not there."""
    span = made(document, kind).get(name)
    if span is None:
        return refused(f"there is no {'place' if kind == 'POI' else kind} {name}", "choose it again")
    message = f"{name} is one of a group ({span.member}): its statement in line {span.line} is for each of them"
    return refused(message, "change that statement, or write it out, one for each member")


def check_place(document: Draft, name: str) -> None:
    """Raises PursueError where there is no place of this name."""
    if name not in names(document, "POI"):
        raise not_there(document, "POI", name)
