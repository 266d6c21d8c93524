"""`battery agent lasts T, charges in T at place`: a robot that has to be at its charger in time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, ClassVar, Iterator, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.conditions import At, Not, Who
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.base import Breaks, Safety, StatedObjective, Whole, Words
from pursue_gen.language.refs import Ref
from pursue_gen.language.symbols import Role
from pursue_gen.language.template import Template
from pursue_gen.language.times import written_time
from pursue_gen.language.word import Form, Numbers, Word


@dataclass(frozen=True)
class Endurance(Safety):
    """A robot's battery by time, full at the start: it lasts `lasts` time units away from `dock` since it was full, and
    is full when the robot has been there, idle or at work, for `charge` time units without a break.

    A charge that is broken off counts for nothing: the time since it was full goes on as if the robot had been away.
    """

    agent: Ref
    lasts: Number
    charge: Number
    dock: Ref
    span: Span = NOWHERE
    optional: int = 0
    word: ClassVar[str] = ""
    limited_by: ClassVar[str] = "lasts"
    last: ClassVar[bool] = True
    template: ClassVar[Template] = Template(
        '{agent:"agent"=bot} lasts {lasts:time=1200}, charges in {charge:time=300} at {dock:POI=dock}'
    )
    own_words: ClassVar[Tuple[Word, ...]] = (
        Word("lasts", "How long the robot may be away from the charger since its battery was full.", True),
        Word(
            "charges",
            "How long the robot has to be at the charger, without a break, until the battery is full again.",
            True,
        ),
    )
    numbers: ClassVar[Numbers] = {
        "lasts": "Since it was full at the charger, the robot is back there within {}.".format,
        "in": "It is full again after {} at the charger, if the robot does not leave before.".format,
    }
    forms: ClassVar[Tuple[Form, ...]] = (Form("a battery that lasts some time", template.to_fill_in),)

    @property
    def text(self) -> str:
        return f"battery {self.template.written(self)}"

    @property
    def full_text(self) -> str:
        return self.text

    @property
    def in_words(self) -> str:
        """How long it lasts, and where it is charged."""
        return f"battery lasts {written_time(self.lasts)}, full after {written_time(self.charge)} at {self.dock.shown}"

    def sentence(self, shown: Callable[[str], str]) -> str:
        return (
            f"The battery of {self.agent.shown} lasts {units(self.lasts)} away from {self.dock.shown}, and is full "
            f"after {units(self.charge)} there."
        )

    def broken(self, beside: Callable[[str], str]) -> str:
        lasted = f"{written_time(self.lasts)} since it was full"
        return f"the battery of {self.agent.shown} is empty: not at {self.dock.shown} within {lasted}"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("agent", self.agent.name):
            yield shown(self.in_words)

    def check(self) -> Iterator[Diagnostic]:
        for word, number in (("lasts", self.lasts), ("charges in", self.charge)):
            if number <= 0:
                message = f"{word} {written_time(number)}: expected more than 0"
                yield error("PML312", message, self.span, "delete this line if the battery does not matter")

    def statement(self, objectives: Sequence[StatedObjective]) -> Whole:
        before = f"a battery of {self.agent.name} that lasts"
        return Whole((self,), self.text, "lasts", self.agent.name, "a battery that lasts longer", before)

    @property
    def words(self) -> Words:
        name, dock = self.agent.shown, self.dock.shown
        return Words(
            due=f"{name}'s return to {dock}",
            due_by=f"{name} at {dock}",
            lane=f"battery: {name}",
            since=f"{name}'s battery was full at {dock}, or the start",
            statuses={
                Role.IDLE: f"full, {name} is at {dock}",
                Role.CHARGING: f"{name} charges at {dock}",
                Role.EMPTY: f"{name} charges at {dock}, and has to stay there until it is full",
                Role.AT_RISK: f"{name} has to be back at {dock} in time",
                Role.LOSE: "empty",
            },
            must=f"{name} has to be back at {dock}",
            there="full",
            kept="back at the charger",
        )

    @property
    def breaks(self) -> Breaks:
        there = At(Who(self.agent), self.dock)
        return Breaks(begins=Not(there), by_robots=True, stands=(there,))
