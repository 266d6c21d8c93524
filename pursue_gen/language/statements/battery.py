"""`battery agent capacity 100 uses 2 per unit …`: a robot's battery."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, Iterator, Optional

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import Written
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word

MOST_CAPACITY = 10_000
"""The largest capacity: levels are values of a variable."""


@dataclass(frozen=True)
class Battery(Written):
    """The battery of a robot, full at the start: it holds `capacity`, and a robot that is on its way or at work uses
    `uses` per time unit; with `driving` it uses as much per unit of distance on its way, and `uses` at work alone. At
    work at `dock` it uses nothing, and `recharges` as much per time unit (None, 0: nowhere).
    """

    agent: Ref
    capacity: int
    uses: Number
    recharges: Number = 0
    dock: Optional[Ref] = None
    driving: Optional[Number] = None
    span: Span = NOWHERE

    listed_in = "batteries"
    own_words = (
        Word("capacity", "What the battery holds when it is full, as it is at the start.", True),
        Word("uses", "What the robot uses in a unit of time on its way or at work. To stand still uses nothing.", True),
        Word("per", "For each unit of time, or metre.", True),
        Word("metre", "One unit of distance: what the robot uses on its way, in place of what it uses in time.", True),
        Word("recharges", "What is added in a unit of time in which the robot does something at the dock.", True),
    )
    template = Template(
        '{agent:"agent"=bot} capacity {capacity:count=100} uses [{driving:number} per metre,] {uses:number=2} per unit'
        " [recharges {recharges:number=5} per unit at {dock:POI=dock}]"
    )
    note = "recharges … is optional; or: uses 2 per metre, 1 per unit"
    forms = (
        Form("a battery that is recharged at a place", template.to_fill_in),
        Form("a battery that is used by distance", template.to_fill_in.replace("uses ", "uses {=1} per metre, ")),
    )

    @property
    def text(self) -> str:
        return f"battery {self.template.written(self)}"

    @property
    def in_words(self) -> str:
        """What it holds, what is used, and where it is recharged."""
        text = f"battery of {self.capacity}, uses {self._used}"
        return text if self.dock is None else f"{text}, recharges {self.recharges} per unit at {self.dock.shown}"

    @property
    def _used(self) -> str:
        at_work = f"{self.uses} per unit"
        return at_work if self.driving is None else f"{self.driving} per metre on its way, {at_work} at work"

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if (kind, name) == ("agent", self.agent.name):
            yield shown(self.in_words)

    def check(self) -> Iterator[Diagnostic]:
        numbers = [("capacity", self.capacity), ("uses", self.uses + (self.driving or 0))]
        for word, number in numbers if self.dock is None else [*numbers, ("recharges", self.recharges)]:
            if number <= 0:
                hint = f"leave out {word} … at" if word == "recharges" else "delete this line if it does not matter"
                yield error("PML312", f"{word} 0: expected more than 0", self.span, hint)
        if self.capacity > MOST_CAPACITY:
            message = f"capacity {self.capacity}: expected {MOST_CAPACITY} or less"
            yield error("PML312", message, self.span, "choose a larger unit, for example per cent")
