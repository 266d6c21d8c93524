"""`state "name": initially false, true_if e`: something that events set and reset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind, behind, joined, names_text
from pursue_gen.language.tokens import bare
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class State(StatementKind):
    """A Boolean that events set and reset."""

    name: str
    initially: bool
    true_if: Tuple[Ref, ...] = ()
    false_if: Tuple[Ref, ...] = ()
    span: Span = NOWHERE

    listed_in: ClassVar[str] = "states"
    words: ClassVar[Tuple[Word, ...]] = (
        Word("state", "Something that is true or false, and that events change."),
        Word("initially", "The value at the start, true or false."),
        Word("true", "It holds."),
        Word("false", "It does not hold."),
        Word("true_if", "The events that make the state true.", may_break=True),
        Word("false_if", "The events that make the state false.", may_break=True),
    )
    grammar: ClassVar[str] = """state: "state" NAME ":" "initially" (TRUE | FALSE) ["," sets]
sets: "true_if" refs ["false_if" refs]
    | "false_if" refs                       -> only_false"""
    form: ClassVar[str] = 'state "open": initially false, true_if e1, e2 false_if e3'
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("true or false, changed by events", 'state "{=open}": initially false, true_if {event} false_if {event}'),
    )
    declares: ClassVar[str] = "state"
    shortest: ClassVar[str] = 'state "{name}": initially false'
    refers_to: ClassVar[Mapping[str, str]] = {"true_if": "event", "false_if": "event"}
    used: ClassVar[Mapping[str, str]] = {"true_if": "event", "false_if": "event"}

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> State:
        name, initially, sets = children
        found = [] if sets is None else list(sets.children)
        true_if, false_if = ([None] * (2 - len(found)) + found) if found else (None, None)
        return cls(bare(name), initially.type == "TRUE", reader.refs(true_if), reader.refs(false_if), reader.at(name))

    @property
    def text(self) -> str:
        sets = joined(behind("true_if", names_text(self.true_if)), behind("false_if", names_text(self.false_if)))
        return f'state "{self.name}": initially {"true" if self.initially else "false"}{sets and f", {sets}"}'
