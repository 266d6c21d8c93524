"""A scenario as it is being written: its text, and what is known of it so far."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import PurePosixPath
from typing import Dict, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic
from pursue_gen.language.checks import check_reading
from pursue_gen.language.document import Document
from pursue_gen.language.lines import plain
from pursue_gen.language.names import KINDS
from pursue_gen.language.occurrences import GROUP, Occurrence, occurrences
from pursue_gen.language.parser import Reading, read_document
from pursue_gen.language.scenario import Scenario


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
        return read_document(self, self._name)

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
        for occurrence in self.occurrences:
            if occurrence.start <= offset <= occurrence.end:
                return occurrence
        return None

    @property
    def _name(self) -> Optional[str]:
        return PurePosixPath(self.file).stem if self.named else "untitled"
