"""`rule "name": first before second`: an order of events."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Iterator, Mapping, Tuple, Type, Union

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Sequence:
    """`first before second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


@dataclass(frozen=True)
class Choice:
    """`first or second` in a rule."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


@dataclass(frozen=True)
class Both:
    """`first and second` in a rule: in any order, and while the other one goes on."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE


RuleBody = Union[Ref, Sequence, Choice, Both]

_BODIES: Mapping[str, Tuple[Type[Union[Sequence, Choice, Both]], str]] = {
    "sequence": (Sequence, "before"), "choice": (Choice, "or"), "both": (Both, "and"),
}
"""By its rule in the grammar each body of two sides, and the word between them."""


_RULES = """_body: sequence | choice | both
sequence: _side "before" _side
choice: _side "or" _side
both: _side "and" _side
_side: ref | "(" _body ")\""""


def _body(reader: TreeReader, tree: Any) -> RuleBody:
    if tree.data == "ref":
        return reader.ref(tree)
    first, second = (_body(reader, child) for child in tree.children)
    return _BODIES[tree.data][0](first, second, reader.span(tree))


def _events(body: RuleBody) -> Iterator[Ref]:
    if isinstance(body, Ref):
        yield body
    else:
        yield from (*_events(body.first), *_events(body.second))


def _body_text(body: RuleBody) -> str:
    if isinstance(body, Ref):
        return body.name
    word = next(word for kind, word in _BODIES.values() if isinstance(body, kind))
    sides = (side.name if isinstance(side, Ref) else f"({_body_text(side)})" for side in (body.first, body.second))
    return f" {word} ".join(sides)


@dataclass(frozen=True)
class Rule(StatementKind):
    """A cyclic order of events: each event that a rule names may happen only when it is its turn.

    `each`: every robot ("robot"), or every agent ("agent"), that can do one of its events has its own turn; "": all
    have one turn.
    """

    name: str
    body: RuleBody
    span: Span = NOWHERE
    each: str = ""

    listed_in: ClassVar[str] = "rules"
    symbol: ClassVar[str] = "Struct"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("rule", "An order of events, round after round: each may happen only when it is its turn."),
        Word("for", "A rule for each of several: each of them has its own turn."),
        Word("each", "A rule for each of several: each of them has its own turn.", True),
        Word("before", "First this, then that, and then the first again.", may_break=True),
        Word("or", "Either of the two, round after round; in a condition: at least one holds.", may_break=True),
    )
    template: ClassVar[Template] = Template(
        'rule {name="order"} [for each {each:who}]: {body:body=first before second}',
        who=Filling("(ROBOT | AGENT)", lambda _, token: str(token)),
        body=Filling("_body", _body, _body_text, "event", ("rule", "robot", "agent", "before", "or", "and"), _RULES),
    )
    note: ClassVar[str] = (
        'or: first or second, first and second; use brackets to nest; or: rule "order" for each robot: …'
    )
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("events in turn", 'rule "{=order}": {event} before {event}'),
        Form("three events in turn", 'rule "{=order}": ({event} before {event}) before {event}'),
        Form("events in turn, for each robot", 'rule "{=order}" for each robot: {event} before {event}'),
        Form("either of two events", 'rule "{=choice}": {event} or {event}'),
        Form("two events in any order, then a third", 'rule "{=all}": ({event} and {event}) before {event}'),
    )
    declares: ClassVar[str] = "rule"

    @property
    def events(self) -> Tuple[Ref, ...]:
        """The events that it names, from left to right."""
        return tuple(_events(self.body))

    def names(self) -> Iterator[Tuple[str, Ref]]:
        return (("event", ref) for ref in self.events)
