"""A scenario as it is being written: its text, what is known of it so far, and how a name in it gets another one."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath
from typing import Dict, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, PursueError, Span, an, error
from pursue_gen.language.checks import check_reading
from pursue_gen.language.document import Document, Edit
from pursue_gen.language.names import KINDS, check_names
from pursue_gen.language.occurrences import GROUP, VARIABLE, Occurrence, occurrences
from pursue_gen.language.parser import Reading, read_document
from pursue_gen.language.scenario import Poi, Scenario
from pursue_gen.language.tokens import plain


@dataclass(frozen=True)
class Draft(Document):
    """A document of which names, findings and scenario are known. `named`: it has a file name that can be wrong."""

    named: bool = True

    @classmethod
    def of(cls, source: str, file: str) -> Draft:
        """The draft for a text, whatever its line ends."""
        return cls(plain(source), file)

    @cached_property
    def occurrences(self) -> Tuple[Occurrence, ...]:
        """Every name where one may stand."""
        return occurrences(self.statements)

    @cached_property
    def declared(self) -> Dict[str, Dict[str, Occurrence]]:
        """kind → name → its first declaration, of groups, too."""
        found: Dict[str, Dict[str, Occurrence]] = {kind: {} for kind in (*KINDS, GROUP)}
        for occurrence in self.occurrences:
            if occurrence.declares and occurrence.kind in found:
                found[occurrence.kind].setdefault(occurrence.name, occurrence)
        return found

    @cached_property
    def reading(self) -> Reading:
        """What the parser makes of it."""
        return read_document(self, PurePosixPath(self.file).stem if self.named else "untitled")

    @cached_property
    def findings(self) -> Tuple[Diagnostic, ...]:
        """Everything that is wrong with it."""
        return check_reading(self.reading)

    @cached_property
    def scenario(self) -> Scenario:
        """The scenario that its sound statements make; those with a syntax error are left out."""
        return self.reading.partial

    def occurrence_at(self, offset: int) -> Optional[Occurrence]:
        """The name that an offset is in, or right behind of."""
        return next((one for one in self.occurrences if one.start <= offset <= one.end), None)


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
    findings = list(check_names(Scenario("name", pois=(Poi(new, span=Span(document.file, 1, 1, 1, 1)),))))
    if findings:
        raise PursueError(findings[:1])
    for kind, known in document.declared.items():
        taken: Optional[Occurrence] = known.get(new)
        if taken is not None:
            line = document.lines.of(taken.start) + 1
            message = f"{new} is taken: line {line} declares {an(kind)} of this name"
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
