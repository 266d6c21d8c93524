"""`if trigger then response within deadline`."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Iterator, Sequence

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.conditions import EventOrCondition, condition_text, condition_words, held_by
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.base import Breaks, Safety, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Template, event_or_condition_text
from pursue_gen.language.times import units_of_time, written_time
from pursue_gen.language.word import Form, Word


def _shown(what: EventOrCondition) -> str:
    """What people read: an event's label, or a condition as it is written."""
    return what.shown if isinstance(what, Ref) else condition_text(what)


@dataclass(frozen=True)
class Respond(Safety):
    """`if trigger then response within deadline` (time units): events, or conditions.

    A condition has to be answered when it comes to hold, and at the start where it holds; it answers as soon as it
    holds.
    """

    trigger: EventOrCondition
    response: EventOrCondition
    deadline: Number
    span: Span = NOWHERE
    optional: int = 0
    limited_by = "deadline"
    is_answered = True

    template = Template(
        "if {trigger:event or condition=e1} then {response:event or condition=e2} within {deadline:time=20}"
    )
    note = "or conditions: if bot1 at a then open is_true within 20"
    own_words = (
        Word(
            "if",
            "After this event, or when this condition comes to hold, there has to be an answer: one for all that come "
            "before it; with at_most 3 open behind it each event has an answer of its own.",
        ),
        Word("then", "The event that has to follow, or the condition that has to hold at some moment."),
        Word("within", "How many units of time later the answer must have come."),
    )
    numbers = {"within": "The answer must have come {} later at most.".format}
    forms = (
        Form("an answer in time", "if {event} then {event} within {=20}"),
        Form("an answer to what comes to hold", "if {agent} at {POI} then {agent} at {POI} within {=20}"),
    )

    def sentence(self, shown: Callable[[str], str]) -> str:
        trigger, response = self.trigger, self.response
        if isinstance(trigger, Ref):
            begins = f"Whenever {trigger.shown} happens"
        else:
            begins = f"Whenever it becomes true that {condition_words(trigger)}"
        answer = f"{response.shown} happens" if isinstance(response, Ref) else condition_words(response)
        return f"{begins}, {answer} within {units(self.deadline)}."

    def broken(self, beside: Callable[[str], str]) -> str:
        no = "no" if isinstance(self.response, Ref) else "not once"
        return f"{no} {_shown(self.response)} within {written_time(self.deadline)} of {_shown(self.trigger)}"

    def check(self) -> Iterator[Diagnostic]:
        if self.deadline <= 0:
            message = "within 0 leaves no time to answer: expected more than 0"
            yield error("PML143", message, self.span, "write the time units that the answer may take")
        name = event_or_condition_text(self.response)
        if name == event_or_condition_text(self.trigger):
            kind, place = ("event", self.response.span) if isinstance(self.response, Ref) else ("condition", self.span)
            yield error("PML172", f"{name} cannot be its own answer", place, f"name the {kind} that has to follow")

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        about, due = event_or_condition_text(self.response), _shown(self.response)
        return Whole((self,), self.text, "deadline", about, "a later deadline", "a deadline of", f" for {due}")

    @property
    def words(self) -> Words:
        due, since = _shown(self.response), f"the last {_shown(self.trigger)} or {_shown(self.response)}"
        must, statuses = f"{due} is due", {Role.IDLE: "nothing is due", Role.AT_RISK: f"{due} is due"}
        return Words(due, since=since, statuses=statuses, must=must, in_time="in time", kept="answered")

    @property
    def breaks(self) -> Breaks:
        return Breaks(begins=self.trigger, ends=self.response)

    def kept_by(self, robot: Ref) -> Respond:
        return self if isinstance(self.response, Ref) else replace(self, response=held_by(self.response, robot))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "event" and name == event_or_condition_text(self.trigger):
            yield f"must be answered by {event_or_condition_text(self.response)} within {units_of_time(self.deadline)}"
        if kind == "event" and name == event_or_condition_text(self.response):
            yield f"is the answer to {event_or_condition_text(self.trigger)}, within {units_of_time(self.deadline)}"
