"""`rule "name": first before second`: an order of events."""

from __future__ import annotations

from dataclasses import dataclass
from typing import AbstractSet, Any, Callable, ClassVar, Dict, FrozenSet, Iterator, Mapping, Set, Tuple, Type, Union

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class _Two:
    """Two sides in a rule, with the word between them."""

    first: RuleBody
    second: RuleBody
    span: Span = NOWHERE
    word: ClassVar[str]
    between: ClassVar[str] = ""
    """The same for people; "": it is that word."""
    behind: ClassVar[str] = ""
    """What people read behind the two."""

    @property
    def in_words(self) -> str:
        """The order of events, in words: one word between all sides, however these are bracketed."""
        sides = (side.name if isinstance(side, Ref) else f"({side.in_words})" for side in self._sides)
        return (self.between or f" {self.word} ").join(sides) + self.behind

    @property
    def _sides(self) -> Tuple[RuleBody, ...]:
        sides = (side._sides if isinstance(side, type(self)) else (side,) for side in (self.first, self.second))
        return tuple(each for some in sides for each in some)


class Sequence(_Two):
    """`first before second` in a rule."""

    word = "before"
    between = ", then "


class Choice(_Two):
    """`first or second` in a rule."""

    word = "or"


class Both(_Two):
    """`first and second` in a rule: in any order, and while the other one goes on."""

    word = "and"
    behind = ", in any order"


RuleBody = Union[Ref, Sequence, Choice, Both]

_BODIES: Mapping[str, Type[Union[Sequence, Choice, Both]]] = {"sequence": Sequence, "choice": Choice, "both": Both}
"""The bodies of two sides, by their rules in the grammar."""

_MOST_EARLIER = 1000  # sets of events

_RULES = """_body: sequence | choice | both
sequence: _side ("before" _side)+
choice: _side ("or" _side)+
both: _side ("and" _side)+
_side: ref | "(" _body ")\""""


def _body(reader: TreeReader, tree: Any) -> RuleBody:
    if tree.data == "ref":
        return reader.ref(tree)
    sides = tuple(_body(reader, child) for child in tree.children)
    return _joined(_BODIES[tree.data], sides, reader.span(tree))


def _joined(kind: Type[Union[Sequence, Choice, Both]], sides: Tuple[RuleBody, ...], span: Span) -> RuleBody:
    """Several sides with one word between them, whose brackets make no difference: few of these are in one another."""
    if len(sides) == 1:
        return sides[0]
    middle = (len(sides) + 1) // 2
    return kind(_joined(kind, sides[:middle], span), _joined(kind, sides[middle:], span), span)


def _events(body: RuleBody) -> Iterator[Ref]:
    if isinstance(body, Ref):
        yield body
    else:
        yield from (*_events(body.first), *_events(body.second))


def _body_text(body: RuleBody) -> str:
    if isinstance(body, Ref):
        return body.name
    sides = (side.name if isinstance(side, Ref) else f"({_body_text(side)})" for side in (body.first, body.second))
    return f" {body.word} ".join(sides)


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

    listed_in = "rules"
    symbol = "Struct"
    own_words = (
        Word("rule", "An order of events, round after round: each may happen only when it is its turn."),
        Word("before", "First this, then that, and then the first again.", may_break=True),
        Word("or", "Either of the two, round after round; in a condition: at least one holds.", may_break=True),
    )
    template = Template(
        'rule {name="order"} [for each {each:who}]: {body:body=first before second}',
        who=Filling("(ROBOT | AGENT)", lambda _, token: str(token)),
        body=Filling("_body", _body, _body_text, "event", ("rule", "robot", "agent", "before", "or", "and"), _RULES),
    )
    note = (
        'or: first or second, first and second; brackets where the words differ; or: rule "order" for each robot: …'
    )
    forms = (
        Form("events in turn", 'rule "{=order}": {event} before {event}'),
        Form("three events in turn", 'rule "{=order}": {event} before {event} before {event}'),
        Form("events in turn, for each robot", 'rule "{=order}" for each robot: {event} before {event}'),
        Form("either of two events", 'rule "{=choice}": {event} or {event}'),
        Form("two events in any order, then a third", 'rule "{=all}": ({event} and {event}) before {event}'),
    )
    declares = "rule"
    described = "a rule, round after round"

    @property
    def events(self) -> Tuple[Ref, ...]:
        """The events that it names, from left to right."""
        return tuple(_events(self.body))

    def names(self) -> Iterator[Tuple[str, Ref]]:
        return (("event", ref) for ref in self.events)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        turns = predecessors(self) if kind == "event" else {}
        if name in turns:
            after = " and ".join(" or ".join(sorted(some)) for some in turns[name])
            yield f"rule {self.name}: its turn comes {f'after {after}' if after else 'first in each round'}"


Earlier = Tuple[FrozenSet[str], ...]
"""What has to have happened: of each of these sets one event. Empty: nothing."""


def predecessors(rule: Rule) -> Dict[str, Earlier]:
    """For each event of a rule what it waits for in a round; nothing: it is its turn at the start."""
    before: Dict[str, Earlier] = {ref.name: () for ref in rule.events}

    def visit(body: RuleBody) -> Tuple[Set[str], Earlier]:
        """Notes who follows whom in the body; its first events, and what has happened when it is over."""
        if isinstance(body, Ref):
            return {body.name}, (frozenset({body.name}),)
        first, over = visit(body.first)
        first_then, over_then = visit(body.second)
        if isinstance(body, Choice):
            return first | first_then, _either(over, over_then)
        if isinstance(body, Both):
            return first | first_then, over + over_then
        for name in first_then:
            before[name] = over
        return first, over_then

    starts, _ = visit(rule.body)
    return {name: () if name in starts else earlier for name, earlier in before.items()}


def _either(a: Earlier, b: Earlier) -> Earlier:
    """What has happened if one of these has; where that would be long, something that is less."""
    if len(a) * len(b) > _MOST_EARLIER:
        return (frozenset().union(*a, *b),)
    return tuple(dict.fromkeys(one | other for one in a for other in b))


def locations_of(body: RuleBody, lasting: AbstractSet[str]) -> int:
    """How many locations the automaton of a rule has between the first and the last one of that part of it."""
    if isinstance(body, Ref):
        return int(body.name in lasting)
    first, second = locations_of(body.first, lasting), locations_of(body.second, lasting)
    if isinstance(body, Both):
        return (first + 2) * (second + 2) - 2
    return first + second + isinstance(body, Sequence)


def has_both(body: RuleBody) -> bool:
    """True where some of its parts come in any order."""
    if isinstance(body, Ref):
        return False
    return isinstance(body, Both) or has_both(body.first) or has_both(body.second)


def can_turn(body: RuleBody, possible: FrozenSet[str]) -> bool:
    """True where a round can end with these events alone."""
    if isinstance(body, Ref):
        return body.name in possible
    first, second = can_turn(body.first, possible), can_turn(body.second, possible)
    return first or second if isinstance(body, Choice) else first and second
