"""`stateDependency: event only_if state is_true`: an event that waits for a state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Dependency(StatementKind):
    """`event` may happen only while `state` has `value`."""

    event: Ref
    state: Ref
    value: bool
    span: Span = NOWHERE

    listed_in = "dependencies"
    symbol = "Operator"
    own_words = (Word("stateDependency", "An event that is allowed only while a state has a value."),)
    template = Template("stateDependency: {event=work} only_if {state=open} {value:is=is_true}")
    note = "or is_false"
    forms = (Form("an event that waits for a state", template.to_fill_in),)
    among = "STATE"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        value = str(self.value).lower()
        if (kind, name) == ("event", self.event.name):
            yield f"only while {self.state.name} is {value}"
        if (kind, name) == ("state", self.state.name):
            yield f"{self.event.name} can happen only while it is {value}"
