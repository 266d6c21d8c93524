"""`battery agent capacity 100 uses 2 per unit …`: a robot's battery."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Mapping, Optional, Tuple

from pursue_gen.diagnostics import NOWHERE, Span
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.base import StatementKind
from pursue_gen.language.tree_reader import TreeReader
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Battery(StatementKind):
    """The battery of a robot, full at the start: it holds `capacity`, and a robot that is on its way or at work uses
    `uses` per time unit. At work at `dock` it uses nothing, and `recharges` as much per time unit (None, 0: nowhere).
    """

    agent: Ref
    capacity: int
    uses: Number
    recharges: Number = 0
    dock: Optional[Ref] = None
    span: Span = NOWHERE

    listed_in: ClassVar[str] = "batteries"
    words: ClassVar[Tuple[Word, ...]] = (
        Word(
            "battery",
            "The battery of a robot: what it holds, what is used, and where it is recharged. It never runs empty.",
            True,
        ),
        Word("capacity", "What the battery holds when it is full, as it is at the start.", True),
        Word("uses", "What the robot uses in a unit of time on its way or at work. To stand still uses nothing.", True),
        Word("per", "For each unit of time.", True),
        Word("unit", "A unit of time.", True),
        Word("recharges", "What is added in a unit of time in which the robot does something at the dock.", True),
    )
    grammar: ClassVar[str] = (
        'battery: BATTERY (ref | NAME) "capacity" NUMBER "uses" NUMBER "per" "unit"'
        ' ["recharges" NUMBER "per" "unit" "at" ref]'
    )
    form: ClassVar[str] = (
        "battery bot capacity 100 uses 2 per unit recharges 5 per unit at dock (recharges … is optional)"
    )
    forms: ClassVar[Tuple[Form, ...]] = (
        Form(
            "a battery that is recharged at a place",
            "battery {agent} capacity {=100} uses {=2} per unit recharges {=5} per unit at {POI}",
        ),
    )
    refers_to: ClassVar[Mapping[str, str]] = {"agent": "agent", "dock": "POI"}
    used: ClassVar[Mapping[str, str]] = {"battery": "agent", "at": "POI"}
    second: ClassVar[str] = "capacity"

    @classmethod
    def read(cls, reader: TreeReader, *children: Any, **at: Any) -> Battery:
        _, agent, capacity, uses, recharges, dock = children
        numbers = reader.count(capacity), reader.number(uses), reader.number_or_none(recharges) or 0
        return cls(reader.agent_ref(agent), *numbers, reader.ref_or_none(dock), at["span"])

    @property
    def text(self) -> str:
        uses = f'battery "{self.agent.name}" capacity {self.capacity} uses {self.uses} per unit'
        return uses if self.dock is None else f"{uses} recharges {self.recharges} per unit at {self.dock.name}"
