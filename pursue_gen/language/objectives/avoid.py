"""`avoid event`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator, Tuple

from pursue_gen.diagnostics import Span
from pursue_gen.language.objectives.base import Breaks, Safety
from pursue_gen.language.refs import Ref


@dataclass(frozen=True)
class Avoid(Safety):
    """`avoid event`: it never happens."""

    event: Ref
    span: Span
    optional: int = 0

    @property
    def text(self) -> str:
        return f"avoid {self.event.name}"

    def sentence(self, shown: Callable[[str], str]) -> str:
        return f"{self.event.shown} never happens."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{self.event.shown} has happened, which was to be avoided"

    def names(self) -> Iterator[Tuple[str, Ref]]:
        yield "event", self.event

    @property
    def breaks(self) -> Breaks:
        return Breaks(event=self.event)

    def about(self, kind: str, name: str) -> Iterator[str]:
        if (kind, name) == ("event", self.event.name):
            yield "must never happen"
