"""`state "name": initially false, true_if e`: something that events set and reset; `initially unknown`: found out. And
`stateDependency: event only_if state is_true`: an event that waits for a state."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Filling, Template, names_text
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

_SETS = """sets: "true_if" refs ["false_if" refs] ["shown_by" refs]
    | "false_if" refs ["shown_by" refs]     -> only_false
    | "shown_by" refs                       -> only_shown"""
_LISTS = ("true_if", "false_if", "shown_by")


def _read_sets(reader: TreeReader, tree: Any) -> Tuple[Tuple[Ref, ...], ...]:
    return tuple(map(reader.refs, [*[None] * (len(_LISTS) - len(tree.children)), *tree.children]))


def _sets_text(*lists: Tuple[Ref, ...]) -> str:
    return " ".join(f"{word} {names_text(refs)}" for word, refs in zip(_LISTS, lists) if refs)


def _read_known(_: TreeReader, token: Any) -> Optional[bool]:
    return None if token.type == "UNKNOWN" else bool(token.type == "TRUE")


def _known_text(value: Optional[bool]) -> str:
    return "unknown" if value is None else str(value).lower()


@dataclass(frozen=True)
class State(StatementKind):
    """A Boolean that events set and reset.

    `initially` None: it is not known at first. It is found out when one of the events `shown_by` has happened, or when
    a robot comes to the place `seen_at`; or an event sets it.
    """

    name: str
    initially: Optional[bool]
    true_if: Tuple[Ref, ...] = ()
    false_if: Tuple[Ref, ...] = ()
    span: Span = NOWHERE
    shown_by: Tuple[Ref, ...] = ()
    seen_at: Optional[Ref] = None

    listed_in = "states"
    symbol = "Boolean"
    own_words = (
        Word("state", "Something that is true or false, and that events change."),
        Word("initially", "The value at the start: true, false or unknown."),
        Word("true", "It holds."),
        Word("false", "It does not hold."),
        Word("true_if", "The events that make the state true.", may_break=True),
        Word("false_if", "The events that make the state false.", may_break=True),
        Word("unknown", "Which of the two it is, is found out.", True),
        Word("shown_by", "When one of these events has happened, it is known what the state is.", True, may_break=True),
        Word("seen_at", "When a robot comes to this place, it is known what the state is.", True),
    )
    template = Template(
        'state {name="open"}: initially {initially:known=false} [seen_at {seen_at:POI}]'
        " [, {true_if,false_if,shown_by:sets=true_if e1, e2 false_if e3}]",
        known=Filling("(TRUE | FALSE | UNKNOWN)", _read_known, _known_text),
        sets=Filling("sets", _read_sets, _sets_text, "event", _LISTS, _SETS),
    )
    note = "or: initially unknown, shown_by e1; or: initially unknown seen_at a"
    forms = (
        Form("true or false, changed by events", 'state "{=open}": initially false, true_if {event} false_if {event}'),
        Form("not known until an event shows it", 'state "{=empty}": initially unknown, shown_by {event}'),
        Form("not known until a robot sees it", 'state "{=empty}": initially unknown seen_at {POI}'),
    )
    declares = "state"
    described = "a state, {0.first_words} at the start"
    shortest = 'state "{name}": initially false'

    @property
    def is_found_out(self) -> bool:
        """True where it is not known at first."""
        return self.initially is None

    @property
    def first_words(self) -> str:
        """What it is at the start."""
        return _known_text(self.initially)

    @property
    def details(self) -> Iterator[str]:
        for value, refs in (("true", self.true_if), ("false", self.false_if)):
            yield f"made {value} by {', '.join(ref.name for ref in refs) or 'nothing'}"
        if self.shown_by:
            yield f"shown by {', '.join(ref.name for ref in self.shown_by)}"
        if self.seen_at is not None:
            yield f"seen by robots at {self.seen_at.shown}"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event":
            for value, refs in (("true", self.true_if), ("false", self.false_if)):
                if any(ref.name == name for ref in refs):
                    yield f"makes {self.name} {value}"
            if any(ref.name == name for ref in self.shown_by):
                yield f"shows whether {self.name} is true"
        elif kind == "POI" and self.seen_at is not None and self.seen_at.name == name:
            yield f"a robot sees here whether {self.name} is true"

    def check(self) -> Iterator[Diagnostic]:
        true_if = {event.name for event in self.true_if}
        for event in self.false_if:
            if event.name in true_if:
                message = f"{event.name} would make {self.name} both true and false"
                yield error("PML320", message, event.span, "take it out of true_if or of false_if")
        if self.is_found_out and not self.shown_by and self.seen_at is None:
            message = f"{self.name} is unknown at first, and nothing says how it is found out"
            hint = "write the event that shows it, as in: initially unknown, shown_by look; or: initially unknown"
            yield error("PML430", message, self.span, f"{hint} seen_at shelf")
        if not self.is_found_out and (self.shown_by or self.seen_at is not None):
            how, ref = ("shown_by", self.shown_by[0]) if self.shown_by else ("seen_at", self.seen_at)
            message = f"{self.name} is {self.first_words} at first, so it need not be found out"
            where = self.span if ref is None else ref.span
            yield error("PML431", message, where, f"write initially unknown, or delete {how} and what follows it")
        sets = true_if.union(event.name for event in self.false_if)
        for event in self.shown_by:
            if event.name in sets:
                message = f"{event.name} sets {self.name}, so it shows nothing"
                yield error("PML431", message, event.span, "take it out of shown_by, or of true_if and false_if")


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
