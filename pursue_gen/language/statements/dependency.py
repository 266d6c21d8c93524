"""`stateDependency: event only_if state is_true`: an event that waits for a state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Dependency(StatementKind):
    """`event` may happen only while `state` has `value`."""

    event: Ref
    state: Ref
    value: bool
    span: Span = NOWHERE

    listed_in: ClassVar[str] = "dependencies"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("stateDependency", "An event that is allowed only while a state has a value."),
    )
    grammar: ClassVar[str] = 'dependency: "stateDependency" ":" ref "only_if" ref (IS_TRUE | IS_FALSE)'
    form: ClassVar[str] = "stateDependency: work only_if open is_true (or is_false)"
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("an event that waits for a state", "stateDependency: {event} only_if {state} is_true"),
    )
    refers_to: ClassVar[Mapping[str, str]] = {"event": "event", "state": "state"}
    used: ClassVar[Mapping[str, str]] = {"stateDependency": "event", "only_if": "state"}
    among: ClassVar[str] = "STATE"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Dependency:
        event, state, value = children
        return cls(reader.ref(event), reader.ref(state), value.type == "IS_TRUE", at["span"])

    @property
    def text(self) -> str:
        value = "is_true" if self.value else "is_false"
        return f"stateDependency: {self.event.name} only_if {self.state.name} {value}"
