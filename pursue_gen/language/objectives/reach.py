"""`do e1 and e2 after T within D`: what is reached once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, ClassVar, Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed, units
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.objectives.base import StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import like, units_of_time, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Numbers, Word

MOST_EVENTS = 5
"""So many events stand behind one `do` at most: the order in which they happen is free, and each order counts."""


def _things_text(events: Tuple[Ref, ...]) -> str:
    return " and ".join(event.name for event in events)


@dataclass(frozen=True)
class Reach(StatedObjective):
    """`do e1 and e2 after T within D`: each event happens, in any order, later than `after` and at most `within` time
    units from the start (None: without a deadline)."""

    events: Tuple[Ref, ...]
    after: Number = 0
    span: Span = NOWHERE
    within: Optional[Number] = None
    optional: int = 0
    listed_in: ClassVar[str] = "reach"
    word: ClassVar[str] = "reach_objective"
    limited_by: ClassVar[str] = "within"
    once: ClassVar[bool] = True

    template: ClassVar[Template] = Template(
        "do {events:things=e1 and e2} [after {after:time=10}] [within {within:time=60}]",
        things=Filling(
            "things", TreeReader.refs, _things_text, "event", ("do", "and"), 'things: ref ("and" ref)*'
        ),
    )
    note: ClassVar[str] = "or: do e1; after and within are optional"
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("do", "The event that is wanted."),
        Word("after", "Later than so many units of time after the start."),
    )
    numbers: ClassVar[Numbers] = {
        "after": lambda time, number: (
            f"It counts when it happens {f'later than {time} after the start' if number else 'at any time'}."
        ),
        "within": "It must have happened {} after the start at most.".format,
    }
    forms: ClassVar[Tuple[Form, ...]] = (
        Form("achieve something once", "do {event}"),
        Form("achieve several things in time", "do {event} and {event} within {=60}"),
    )

    def sentence(self, shown: Callable[[str], str]) -> str:
        after = f" later than {units(self.after)} after the start" if self.after else ""
        within = "" if self.within is None else f" within {units(self.within)} after the start"
        verb = "happens" if len(self.events) == 1 else "happen, in any order,"
        when = f"{after} and{within}" if after and within else after or within
        return f"{self.words.due} {verb}{when}".rstrip(",") + "."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{self.words.due} not done within {written_time(self.within)} of the start"

    def check(self) -> Iterator[Diagnostic]:
        for ref in twice(self.events):
            yield error("PML222", f"{ref.name} stands twice behind do", ref.span, "delete one: it happens once")
        if len(self.events) > MOST_EVENTS:
            message = f"more than {MOST_EVENTS} events behind one do"
            yield error("PML224", message, self.span, "write several lines: all reach_objectives have to be reached")
        if self.within is not None and self.within <= self.after:
            within, after = written_time(self.within), written_time(self.after)
            enough = written_time(like(exact(self.after + 1), self.within))
            message = f"within {within} ends before it counts, which is later than {after}"
            hint = f"both count from the start of the mission: write within {enough} or more"
            yield error("PML223", message, self.span, hint)

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        names, due = listed(ref.name for ref in self.events), self.words.due
        return Whole((self,), self.text, "within", names, f"a later deadline for {due}", f"{due} within")

    @property
    def words(self) -> Words:
        due = listed(ref.shown for ref in self.events)
        behind = "" if self.after or self.within else " after 0"
        return Words(due, statuses={Role.UNLOCKED: f"{due} to be done"}, behind=behind)

    def done_in(self, location: str) -> Tuple[Ref, ...]:
        done = Symbol.of(location)
        return tuple(self.events[int(k) - 1] for k in done.parts) if done.role is Role.DID else ()

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event" and any(ref.name == name for ref in self.events):
            after = f", later than {units_of_time(self.after)} after the start" if self.after else ""
            within = "" if self.within is None else f", {units_of_time(self.within)} after the start at most"
            yield f"is to be achieved once{after}{within}"
