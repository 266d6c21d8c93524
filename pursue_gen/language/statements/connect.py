"""`connect a and b distance 3`: a way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Iterator, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.conditions import Condition, condition_words
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.statements.base import ForSome
from pursue_gen.language.template import Template
from pursue_gen.language.times import written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Connection(ForSome):
    """A way between two POIs; `distance` is in distance units, more than 0.

    `ends` are the places in the text where it names them. `one_way`: from `a` to `b` only, else in both directions.
    Agents set off only while `only_if` holds (None: always); `only_for` and `not_for` say which agents may, as in
    `ForSome`. `through`: the doors that it passes; `by`: the lift that it goes by.
    """

    a: str
    b: str
    distance: Number
    span: Span = NOWHERE
    ends: Tuple[Span, Span] = (NOWHERE, NOWHERE)
    one_way: bool = False
    only_if: Optional[Condition] = None
    only_for: Tuple[Ref, ...] = ()
    not_for: Tuple[Ref, ...] = ()
    through: Tuple[Ref, ...] = ()
    by: Optional[Ref] = None

    listed_in = "connections"
    symbol = "Interface"
    own_words = (
        Word("connect", "A way between two places, in both directions unless it is one_way. Write it once."),
        Word(
            "and",
            "The other end of the way; in a rule: both of the two, in any order; in a condition: both hold.",
            may_break=True,
        ),
        Word("distance", "How long the way is, in the unit of distance that you chose, or with its unit: 12 m."),
        Word("one_way", "From the first place to the second only. Without it, the way goes in both directions.", True),
        Word("through", "The doors that the way leads through, each of which opens for whoever sets off.", True),
    )
    template = Template(
        "connect {a:POI=a} and {b:POI=b} distance {distance=3} [one_way] [through {through:doors}] [by {by:lift}] "
        + ForSome.for_whom
        + " [only_if {only_if:condition=open is_true}]"
    )
    note = ("one_way and only_if are optional; between them: through d1; by lift1; for agv, cart, or except gerda")
    forms = (
        Form("a way between two places", "connect {POI} and {POI} distance {=1}"),
        Form("a way in one direction only", "connect {POI} and {POI} distance {=1} one_way"),
        Form("a way that is not always open", "connect {POI} and {POI} distance {=1} only_if {state} is_true"),
        Form("a way through a door", "connect {POI} and {POI} distance {=1} through {door}"),
        Form("a way by lift", "connect {POI} and {POI} distance {=1} by {lift}"),
        Form("a way for some agents only", "connect {POI} and {POI} distance {=1} for {agent}"),
    )
    parts = template.begins

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Connection:
        values = cls.template.read(reader, children)
        a, b = values.pop("a"), values.pop("b")
        return cls(a.name, b.name, ends=(a.span, b.span), **values, **at)

    def names(self) -> Iterator[Tuple[str, Ref]]:
        yield from (("POI", Ref(name, span)) for name, span in zip((self.a, self.b), self.ends))
        yield from super().names()

    @property
    def what(self) -> str:
        return f"the way between {self.a} and {self.b}"

    @property
    def directions(self) -> Tuple[Tuple[str, str], ...]:
        """From and to, for each direction in which it can be taken; the declared one first."""
        return ((self.a, self.b),) if self.one_way else ((self.a, self.b), (self.b, self.a))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "state" and self.only_if is not None and self.speaks_of(kind, name):
            yield f"between {self.a} and {self.b} only while {shown(condition_words(self.only_if))}"
        on_it = {"door": self.through, "lift": () if self.by is None else (self.by,)}.get(kind, ())
        if any(ref.name == name for ref in on_it):
            yield f"on {self.what}"
        if kind == "agent" and not self.admits(name):
            yield f"never takes {self.what} at distance {written_time(self.distance)}"

    def check(self) -> Iterator[Diagnostic]:
        if self.distance <= 0:
            message = f"the way from {self.a} to {self.b} has no length"
            yield error("PML140", message, self.span, "write distance and a number above 0")
        if self.a == self.b:
            yield error("PML145", f"this connects {self.a} with itself", self.span, "name two different places")
        for ref in twice(self.through):
            yield error("PML460", f"{ref.name} stands twice behind through", ref.span, "delete one of the two")
        yield from self.check_whom()
