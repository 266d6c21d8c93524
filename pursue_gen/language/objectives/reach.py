"""`do e1 and e2 after T within D`, `do e 3 times at_least T apart`: what is reached once."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed, units
from pursue_gen.language.numbers import Number, exact, whole_below
from pursue_gen.language.objectives.base import Counted, Easier, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.symbols import Role, Symbol
from pursue_gen.language.template import Filling, Template
from pursue_gen.language.times import instead, like, units_of_time, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

MOST_EVENTS = 5
"""So many events stand behind one `do` at most: the order in which they happen is free, and each order counts."""

MOST_TIMES = 100
"""So often an event can have to happen: each time is a location of an automaton."""


def _read_often(reader: TreeReader, tree: Any) -> int:
    (token,) = tree.children
    return 2 if token.type == "TWICE" else reader.count(token)


def _often_text(times: int) -> str:
    return {1: "once", 2: "twice"}.get(times, f"{times} times")


def _things_text(events: Tuple[Ref, ...]) -> str:
    return " and ".join(event.name for event in events)


@dataclass(frozen=True)
class Reach(StatedObjective):
    """`do e1 and e2 after T within D`: each event happens, in any order, later than `after` and at most `within` time
    units from the start (None: without a deadline). One event alone may have to happen several `times`; then it counts
    at least `apart` time units after it has counted before (None: whenever it happens)."""

    events: Tuple[Ref, ...]
    after: Number = 0
    span: Span = NOWHERE
    within: Optional[Number] = None
    optional: int = 0
    times: int = 1
    apart: Optional[Number] = None
    listed_in = "reach"
    word = "reach_objective"
    limited_by = "within"
    once = True

    template = Template(
        "do {events:things=e1 and e2} [{times:often}] [at_least {apart:time} apart] [after {after:time=10}] "
        "[within {within:time=60}]",
        things=Filling(
            "things", TreeReader.refs, _things_text, "event", ("do", "and"), 'things: ref ("and" ref)*'
        ),
        often=Filling("often", _read_often, _often_text, rules='often: TWICE | NUMBER "times"'),
    )
    note = "or: do e1; do e1 3 times at_least 60 apart; after and within are optional"
    own_words = (
        Word("do", "The event that is wanted."),
        Word("twice", "Two times.", True),
        Word("apart", "So many units of time between two times that count.", True),
        Word("after", "Later than so many units of time after the start."),
    )
    numbers = {
        "at_least": "The next time counts {} after the last one that counted, or later.".format,
        "after": lambda time, number: (
            f"It counts when it happens {f'later than {time} after the start' if number else 'at any time'}."
        ),
        "within": "It must have happened {} after the start at most.".format,
    }
    forms = (
        Form("achieve something once", "do {event}"),
        Form("achieve something several times", "do {event} {=2} times at_least {=60} apart"),
        Form("achieve several things in time", "do {event} and {event} within {=60}"),
    )

    def sentence(self, shown: Callable[[str], str]) -> str:
        after = f" later than {units(self.after)} after the start" if self.after else ""
        within = "" if self.within is None else f" within {units(self.within)} after the start"
        verb = "happens" if len(self.events) == 1 else "happen, in any order,"
        verb += f" {self.often}" if self.times > 1 else ""
        verb += "" if self.apart is None else f", at least {units(self.apart)} apart,"
        when = f"{after} and{within}" if after and within else after or within
        return f"{listed(ref.shown for ref in self.events)} {verb}{when}".rstrip(",") + "."

    def broken(self, beside: Callable[[str], str]) -> str:
        return f"{self.words.due} not done within {written_time(self.within)} of the start"

    def check(self) -> Iterator[Diagnostic]:
        for ref in twice(self.events):
            yield error("PML222", f"{ref.name} stands twice behind do", ref.span, "delete one: it happens once")
        if len(self.events) > MOST_EVENTS:
            message = f"more than {MOST_EVENTS} events behind one do"
            yield error("PML224", message, self.span, "write several lines: all reach_objectives have to be reached")
        yield from self._check_times()
        first = like(exact(self.after + (self.times - 1) * (self.apart or 0)), self.after)
        if self.within is not None and self.within <= first:
            within, enough = written_time(self.within), written_time(like(exact(first + 1), self.within))
            message = f"within {within} ends before it counts, which is later than {written_time(first)}"
            hint = f"both count from the start of the mission: write within {enough} or more"
            yield error("PML223", message, self.span, hint)

    def _check_times(self) -> Iterator[Diagnostic]:
        """What is wrong with how often it has to happen."""
        if self.times < 1 or self.times > MOST_TIMES:
            message = f"do {self.times} times: expected 1 to {MOST_TIMES}, as each time is counted"
            yield error("PML225", message, self.span, "write how often it has to happen")
        if self.times > 1 and len(self.events) > 1:
            message = f"{self.often} behind several events: expected one event"
            yield error("PML225", message, self.span, "write a line for each: all reach_objectives have to be reached")
        if self.apart is not None and (self.times == 1 or self.apart <= 0):
            message = f"at_least {written_time(self.apart)} apart: expected more than 0, and an event that happens "
            message += "twice or more"
            yield error("PML225", message, self.span, "write how often: do e1 twice at_least 60 apart")

    def easier(self, counted: Counted) -> Iterator[Easier]:
        event, due, after, apart = self.events[0].shown, self.words.due, self.after, self.apart or 0
        yield Easier(
            "after", listed(ref.name for ref in self.events), f"an earlier {due}", after, whole_below(after, 0),
            lambda each, k: replace(each, after=like(k, after)), lambda k: f"{due} after {instead(k, after)}", 1,
        )  # fmt: skip
        yield Easier(
            "times", event, f"{event} less often", self.times, range(self.times - 1, 1 if apart else 0, -1),
            lambda each, k: replace(each, times=k), lambda k: f"{event} {_often_text(k)} instead of {self.often}",
        )  # fmt: skip
        yield Easier(
            "pause", event, f"{event} less far apart", apart, whole_below(apart, 1),
            lambda each, k: replace(each, apart=k), lambda k: f"{event} at least {instead(k, apart)} apart",
        )  # fmt: skip

    @property
    def often(self) -> str:
        """How often it has to happen, as it is written."""
        return _often_text(self.times)

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        names, due = listed(ref.name for ref in self.events), self.words.due
        return Whole((self,), self.text, "within", names, f"a later deadline for {due}", f"{due} within")

    @property
    def words(self) -> Words:
        due = listed(ref.shown for ref in self.events) + f" {self.often}" * (self.times > 1)
        behind = "" if self.after or self.within else " after 0"
        return Words(due, statuses={Role.UNLOCKED: f"{due} to be done"}, behind=behind)

    def done_in(self, location: str) -> Tuple[Ref, ...]:
        done = Symbol.of(location)
        return tuple(self.events[int(k) - 1] for k in done.parts) if done.role is Role.DID else ()

    def is_done(self, done: Sequence[str]) -> bool:
        """True where it is reached by these events, each as often as it has counted."""
        return all(done.count(ref.name) >= self.times for ref in self.events)

    def status(self, location: str) -> str:
        place = Symbol.of(location)
        if place.role not in (Role.DONE_TIMES, Role.APART):
            return super().status(location)
        soon = ", too soon for the next" * (place.role is Role.APART)
        return f"{self.events[0].shown} done {place.parts[0]} of {self.times} times{soon}"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event" and any(ref.name == name for ref in self.events):
            after = f", later than {units_of_time(self.after)} after the start" if self.after else ""
            within = "" if self.within is None else f", {units_of_time(self.within)} after the start at most"
            apart = "" if self.apart is None else f", at least {units_of_time(self.apart)} apart"
            yield f"is to be achieved {self.often}{apart}{after}{within}"
