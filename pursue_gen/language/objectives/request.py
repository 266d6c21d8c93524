"""`if order then pack within T, at_most N open`: what comes again while it waits for its answer is answered, too."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator, Mapping, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.base import Breaks, Counted, Easier, Safety, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Template
from pursue_gen.language.times import units_of_time, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word

MOST_AT_ONCE = 20
"""The most that may be open: each has an automaton and a clock of its own. Games of more than four are large."""


@dataclass(frozen=True)
class Request(Safety):
    """`if trigger then response within deadline, at_most most open`: each time that the trigger happens it is answered
    within so many time units, in the order in which they came: a response answers the one that waits longest.

    A statement is `most` of these, one for each that may be open: `number`, from 0, says which. That no more are open
    is assumed (`assumptions.most_open`).
    """

    trigger: Ref
    response: Ref
    deadline: Number
    most: int
    number: int = 0
    span: Span = NOWHERE
    optional: int = 0
    limited_by = "deadline"
    is_answered = True

    template = Template(
        "if {trigger:event=order} then {response:event=pack} within {deadline:time=120}, at_most {most:count=3} open"
    )
    own_words = (
        Word(
            "open",
            "So many wait for their answer at most, as is assumed; each of them is answered, the oldest first.",
            True,
        ),
    )
    forms = (Form("an answer to each of several at once", "if {event} then {event} within {=120}, at_most {=3} open"),)
    wants = (
        "Whenever {trigger} happens, {response} answers it within {deadline}, also where it happens again before that: "
        "the oldest is answered first."
    )

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Tuple[Safety, ...]:
        return cls(**cls.template.read(reader, children), **at).each

    @property
    def each(self) -> Tuple[Request, ...]:
        """The objectives of its statement; of one with a wrong number some."""
        return tuple(replace(self, number=number) for number in range(min(max(self.most, 1), MOST_AT_ONCE)))

    @property
    def which(self) -> str:
        """Which of those that may be open it is, as in `2 of 3`."""
        return f"{self.number + 1} of {self.most}"

    @property
    def order(self) -> Tuple[str, ...]:
        return tuple(str(each.number) for each in self.each)

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        whole = tuple(each for each in objectives if isinstance(each, Request) and each.span == self.span)
        due = self.response.shown
        return Whole(
            whole, self.text, "deadline", self.response.name, "a later deadline", "a deadline of", f" for each {due}"
        )

    def variables(self, shown: Callable[[str], str]) -> Iterator[Tuple[Role, Mapping[str, str]]]:
        places = [each.which for each in self.each]
        free = {str(k): f"the next one is {which}" for k, which in enumerate(places)}
        yield Role.SAFETY_TURN, {**free, str(len(places)): "no more may come"}
        yield Role.SAFETY_OLDEST, {str(k): f"next to be answered: {which}" for k, which in enumerate(places)}

    def easier(self, counted: Counted) -> Iterator[Easier]:
        event, most = self.trigger.shown, self.most
        yield Easier(
            "open", event, f"fewer of {event} open", most, range(0 if self.number else most - 1, 0, -1),
            lambda each, k: replace(each, most=k) if each.number < k else None,
            lambda k: f"at_most {k} of {event} open instead of {most}",
        )  # fmt: skip

    def broken(self, beside: Callable[[str], str]) -> str:
        within = written_time(self.deadline)
        return f"no {self.response.shown} within {within} of {self.trigger.shown}, the oldest that waits"

    def check(self) -> Iterator[Diagnostic]:
        if self.deadline <= 0:
            message = "within 0 leaves no time to answer: expected more than 0"
            yield error("PML143", message, self.span, "write the time units that the answer may take")
        if self.response.name == self.trigger.name:
            message = f"{self.response.name} cannot be its own answer"
            yield error("PML172", message, self.response.span, "name the event that has to follow")
        if not 1 <= self.most <= MOST_AT_ONCE:
            message = f"at_most {self.most} open: expected 1 to {MOST_AT_ONCE}, as each has a clock of its own"
            hint = "write a number in these limits; if none may come, write an assumption (… does … at_most 0 times)"
            yield error("PML226", message, self.span, hint)

    @property
    def words(self) -> Words:
        due, asked = self.response.shown, self.trigger.shown
        which = f", {self.which}" if self.most > 1 else ""
        statuses = {Role.IDLE: "nothing is due", Role.AT_RISK: f"{due} is due"}
        return Words(
            f"{due}{which}",
            lane=f"{due}{which}",
            since=f"the {asked} that waits{which}",
            statuses=statuses,
            must=f"{due} is due",
            in_time="in time",
            kept="answered",
            which=which and f": {self.which}",
        )

    @property
    def breaks(self) -> Breaks:
        return Breaks(begins=self.trigger, by_robots=True)

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        within, open_ = units_of_time(self.deadline), f"at most {self.most} open"
        if self.number == 0 and kind == "event" and name == self.trigger.name:
            yield f"each time it must be answered by {self.response.name} within {within}, {open_}"
        if self.number == 0 and kind == "event" and name == self.response.name:
            yield f"is the answer to each {self.trigger.name}, within {within}, {open_}"


def requests_in(objectives: Sequence[StatedObjective]) -> Iterator[Tuple[int, Request]]:
    """The first objective of each such statement, behind its number among these objectives."""
    return ((k, each) for k, each in enumerate(objectives) if isinstance(each, Request) and each.number == 0)
