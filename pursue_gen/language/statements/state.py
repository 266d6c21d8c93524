"""`state "name": initially false, true_if e`: something that events set and reset."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, ClassVar, Iterator, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Filling, Template, names_text
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

_SETS = """sets: "true_if" refs ["false_if" refs]
    | "false_if" refs                       -> only_false"""


def _read_sets(reader: TreeReader, tree: Any) -> Tuple[Tuple[Ref, ...], ...]:
    true_if, false_if = (None, *tree.children) if tree.data == "only_false" else tree.children
    return reader.refs(true_if), reader.refs(false_if)


def _sets_text(true_if: Tuple[Ref, ...], false_if: Tuple[Ref, ...]) -> str:
    lists = {"true_if": names_text(true_if), "false_if": names_text(false_if)}
    return " ".join(f"{word} {names}" for word, names in lists.items() if names)


@dataclass(frozen=True)
class State(StatementKind):
    """A Boolean that events set and reset."""

    name: str
    initially: bool
    true_if: Tuple[Ref, ...] = ()
    false_if: Tuple[Ref, ...] = ()
    span: Span = NOWHERE

    listed_in: ClassVar[str] = "states"
    symbol: ClassVar[str] = "Boolean"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("state", "Something that is true or false, and that events change."),
        Word("initially", "The value at the start, true or false."),
        Word("true", "It holds."),
        Word("false", "It does not hold."),
        Word("true_if", "The events that make the state true.", may_break=True),
        Word("false_if", "The events that make the state false.", may_break=True),
    )
    template: ClassVar[Template] = Template(
        'state {name="open"}: initially {initially:bool=false} [, {true_if,false_if:sets=true_if e1, e2 false_if e3}]',
        sets=Filling("sets", _read_sets, _sets_text, "event", ("true_if", "false_if"), _SETS),
    )
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("true or false, changed by events", 'state "{=open}": initially false, true_if {event} false_if {event}'),
    )
    declares: ClassVar[str] = "state"
    shortest: ClassVar[str] = 'state "{name}": initially false'

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event":
            for value, refs in (("true", self.true_if), ("false", self.false_if)):
                if any(ref.name == name for ref in refs):
                    yield f"makes {self.name} {value}"

    def check(self) -> Iterator[Diagnostic]:
        true_if = {event.name for event in self.true_if}
        for event in self.false_if:
            if event.name in true_if:
                message = f"{event.name} would make {self.name} both true and false"
                yield error("PML320", message, event.span, "take it out of true_if or of false_if")
