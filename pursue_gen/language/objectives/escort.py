"""`escort agent at place within T by who`: somebody is where an agent is, soon after it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, Iterator, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed, units
from pursue_gen.language.conditions import AllOf, At, Condition, Not, Who, by_robot, one_at, who_text
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.base import Breaks, Safety, StatedObjective, Whole, Words
from pursue_gen.language.objectives.patrol import PATROLLER, check_who
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Template
from pursue_gen.language.times import units_of_time, written_time
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Escort(Safety):
    """`escort ward at place within deadline by who`: whenever the ward is at the place and `who` is not, that changes
    within so many time units.

    `who`: an agent, several, or any robot: then one of them. A statement with several places is several of these.
    """

    ward: Ref
    place: Ref
    deadline: Number
    who: Who
    span: Span = NOWHERE
    optional: int = 0
    limited_by = "deadline"

    template = Template(
        "escort {ward:agent=visitor} at {place:POIs=a, b} within {deadline:time=5} by {who:patroller=bot1}",
        patroller=PATROLLER._replace(rules=""),
    )
    note = "or: by bot1 or bot2, by any robot"
    own_words = (Word("escort", "Somebody who is not alone at these places for long.", True),)
    numbers = {}
    forms = (Form("somebody who is escorted", "escort {agent} at {POI} within {=5} by {agent}"),)

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Tuple[Safety, ...]:
        values = {**cls.template.read(reader, children), **at}
        return tuple(cls(place=place, **values) for place in values.pop("place"))

    @property
    def text(self) -> str:
        return self.template.written(self, place=self.place.name)

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        whole = tuple(each for each in objectives if isinstance(each, Escort) and each.span == self.span)
        places = ", ".join(each.place.name for each in whole)
        about = f"{self.ward.name} at {listed(each.place.name for each in whole)}"
        text = self.template.written(self, place=places)
        return Whole(whole, text, "deadline", about, "a later escort", f"an escort of {self.ward.shown} within")

    @property
    def alone(self) -> Condition:
        """That the ward is there alone."""
        return AllOf((At(Who(self.ward), self.place), Not(one_at(self.who, self.place))))

    @property
    def trigger(self) -> Condition:
        """What has to be answered, as of an answer in time."""
        return self.alone

    @property
    def response(self) -> Condition:
        """What answers it."""
        return Not(self.alone)

    @property
    def conditions(self) -> Tuple[Condition, ...]:
        return (self.trigger,)

    @property
    def breaks(self) -> Breaks:
        return Breaks(begins=self.trigger, ends=self.response)

    def sentence(self, shown: Callable[[str], str]) -> str:
        who, ward, within = who_text(self.who, shown=True), self.ward.shown, units(self.deadline)
        at = f"{ward} is at {self.place.shown} without {who}"
        return f"Whenever {at}, {who} is there within {within}, or {ward} has set off."

    def broken(self, beside: Callable[[str], str]) -> str:
        who = who_text(self.who, shown=True)
        return f"{self.ward.shown} has been at {self.place.shown} without {who} for {written_time(self.deadline)}"

    def check(self) -> Iterator[Diagnostic]:
        if self.deadline <= 0:
            message = "within 0 leaves no time to come: expected more than 0"
            yield error("PML143", message, self.span, "write the time units that it may take")
        yield from check_who(self.who)
        if any(ref.name == self.ward.name for ref in self.who.named):
            yield error("PML173", f"{self.ward.name} is always with itself", self.span, "name two different agents")

    @property
    def words(self) -> Words:
        due = f"{who_text(self.who, shown=True)} at {self.place.shown}"
        statuses = {Role.IDLE: "nobody is awaited", Role.AT_RISK: f"{due} is due"}
        since = f"{self.ward.shown} was at {self.place.shown} alone"
        return Words(due, since=since, statuses=statuses, must=f"{due} is due", in_time="in time", kept="escorted")

    def kept_by(self, robot: Ref) -> Escort:
        return replace(self, who=by_robot(self.who, robot))

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "agent" and name == self.ward.name:
            yield f"is escorted at {self.place.name} by {who_text(self.who)} within {units_of_time(self.deadline)}"
