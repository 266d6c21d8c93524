"""What the checker reports: a level, a kind, the state that it is about, a sentence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence, Tuple

NOTE, WORLD, FAULT, UNRECORDED = "note", "world", "fault", "unrecorded"
"""Nothing wrong; the world did what the model does not know; a node did what it must not, or it cannot be known; the
recorder was not there yet."""


@dataclass(frozen=True)
class Finding:
    """`seq` is the number of the state (0: of the whole recording), `kind` a stable word for programs."""

    level: str
    kind: str
    seq: int
    text: str


def of_kind(findings: Sequence[Finding], *kinds: str) -> Tuple[Finding, ...]:
    """The findings of these kinds."""
    return tuple(finding for finding in findings if finding.kind in kinds)
