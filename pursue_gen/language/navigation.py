"""Where a name is declared, where it is used, and how it gets another name."""

from __future__ import annotations

from typing import Optional, Tuple

from pursue_gen.diagnostics import PursueError, Span, error
from pursue_gen.language.document import Edit
from pursue_gen.language.draft import Draft
from pursue_gen.language.names import check_names
from pursue_gen.language.occurrences import VARIABLE, Occurrence
from pursue_gen.language.scenario import Poi, Scenario


def definition(document: Draft, offset: int) -> Tuple[Occurrence, ...]:
    """Where the name at an offset is declared; where it is declared as another kind of thing, if it is that only."""
    return tuple(occurrence for occurrence in same_name(document, offset) if occurrence.declares)


def same_name(document: Draft, offset: int) -> Tuple[Occurrence, ...]:
    """Every place where the thing whose name is at an offset is declared or used, in the order of the text."""
    here = document.occurrence_at(offset)
    if here is None:
        return ()
    named = [occurrence for occurrence in document.occurrences if occurrence.name == here.name]
    if here.kind == VARIABLE:
        return tuple(one for one in named if (one.kind, one.statement) == (VARIABLE, here.statement))
    named = [occurrence for occurrence in named if occurrence.kind != VARIABLE]
    kinds = {occurrence.kind for occurrence in named if occurrence.declares}
    if len(kinds) > 1:  # an error; then the use decides what is meant
        named = [occurrence for occurrence in named if occurrence.kind == here.kind]
    return tuple(named)


def rename(document: Draft, offset: int, new: str) -> Tuple[Edit, ...]:
    """The edits that give the thing at an offset another name, wherever it stands.

    Raises PursueError with the reason where there is no name at the offset, the new one is no valid name, or it is
    taken.
    """
    places = same_name(document, offset)
    if not places:
        raise PursueError([error("LSP001", "there is no name here", hint="put the cursor on a name")])
    old = places[0].name
    if new == old:
        return ()
    _check_new(document, new)
    edits = tuple(Edit(place.start, place.end, new) for place in places)
    _check_after(document, edits)
    return edits


def _check_new(document: Draft, new: str) -> None:
    span = Span(document.file, 1, 1, 1, 1)
    alone = Scenario("name", document.file, "", (Poi(new, None, span),), (), (), (), (), (), (), (), ())
    findings = list(check_names(alone))
    if findings:
        raise PursueError(findings[:1])
    for kind, known in document.declared.items():
        taken: Optional[Occurrence] = known.get(new)
        if taken is not None:
            line = document.lines.of(taken.start) + 1
            message = f"{new} is taken: line {line} declares {'an' if kind[0] in 'ea' else 'a'} {kind} of this name"
            raise PursueError([error("LSP002", message, hint="choose another name")])


def _check_after(document: Draft, edits: Tuple[Edit, ...]) -> None:
    """Refuses names that are fine alone, but collide with others in what is generated."""
    changed = document.changed(*edits)
    before = {finding.message for finding in check_names(document.scenario)}
    new = [finding for finding in check_names(changed.scenario) if finding.message not in before]
    if document.syntax.groups and not new:  # names are made of others there, and may be used elsewhere
        known = {(finding.code, finding.span and finding.span.line) for finding in document.findings}
        new = [one for one in changed.findings if (one.code, one.span and one.span.line) not in known]
    if new:
        raise PursueError(new[:1])
