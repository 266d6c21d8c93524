"""A scenario that is open in an editor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Optional, Tuple

from pursue_gen.diagnostics import Severity
from pursue_gen.language.draft import Draft
from pursue_gen.tools.lsp.positions import UTF_16, Positions

if TYPE_CHECKING:
    from pursue_gen.explanation.decided import Size


@dataclass(frozen=True)
class OpenDocument(Draft):
    """A draft, and how its editor counts: columns in units of `encoding`, `version` for this state of the text."""

    encoding: str = UTF_16
    version: Optional[int] = None

    @cached_property
    def positions(self) -> Positions:
        """Offsets and positions of the text."""
        return Positions(self.text, self.encoding)

    @cached_property
    def sizes(self) -> Tuple[Size, ...]:
        """What the statements of its objectives cost; () while something is wrong with it, or there is none."""
        from pursue_gen.explanation.decided import sizes

        wrong = any(finding.severity is Severity.ERROR for finding in self.findings)
        return () if wrong else sizes(self.scenario)
