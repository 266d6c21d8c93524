"""A name where it is used: what every part of a scenario refers to others by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, Iterator, Set

from pursue_gen.diagnostics import NOWHERE, Span


@dataclass(frozen=True)
class Ref:
    """A name where it is used (not declared), with the label of what it stands for; "": it has none."""

    name: str
    span: Span = NOWHERE
    label: str = ""

    @property
    def shown(self) -> str:
        """What people read."""
        return self.label or self.name


def twice(refs: Iterable[Ref]) -> Iterator[Ref]:
    """Those whose name stands before already."""
    seen: Set[str] = set()
    for ref in refs:
        if ref.name in seen:
            yield ref
        seen.add(ref.name)
