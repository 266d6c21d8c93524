"""`first never_with second`: two agents that are never together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator, Optional

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.conditions import At, Who
from pursue_gen.language.objectives.base import Breaks, Safety
from pursue_gen.language.refs import Ref
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class NeverWith(Safety):
    """`first never_with second`: two agents that never share a POI nor a connection; with `place` not this POI."""

    first: Ref
    second: Ref
    span: Span = NOWHERE
    place: Optional[Ref] = None
    optional: int = 0

    template = Template("{first:agent=bot1} never_with {second:agent=bot2} [at {place:POI=a}]")
    note = "at is optional"
    own_words = (Word("never_with", "These two agents must never be at one place, nor meet on a way."),)
    forms = (
        Form("two who never meet", "{agent} never_with {agent}"),
        Form("two who are never at one place", "{agent} never_with {agent} at {POI}"),
    )

    def sentence(self, shown: Callable[[str], str]) -> str:
        where = "at one place or on one connection" if self.place is None else f"both at {self.place.shown}"
        return f"{self.first.shown} and {self.second.shown} are never {where}."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{self.first.shown} and {self.second.shown} are together{beside(self.first.name)}"

    def check(self) -> Iterator[Diagnostic]:
        if self.first.name == self.second.name:
            yield error("PML173", f"{self.first.name} is always with itself", self.span, "name two different agents")

    @property
    def breaks(self) -> Breaks:
        pair = (self.first.name, self.second.name)
        if self.place is None:
            return Breaks(pair=pair)
        stands = (At(Who(self.first), self.place), At(Who(self.second), self.place))
        return Breaks(pair=pair, place=self.place.name, stands=stands)

    def apart(self, one: str, other: str, place: str) -> bool:
        return {one, other} == {self.first.name, self.second.name} and (self.place is None or self.place.name == place)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "agent" and name in (self.first.name, self.second.name):
            other = self.second.name if self.first.name == name else self.first.name
            where = "be where" if self.place is None else f"be at {self.place.name} while"
            yield f"must never {where} {other} is" + ("" if self.place is None else " there")
