"""`assume: agent does event after T`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, ClassVar, Mapping, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.assumptions.base import AboutOne, Setting
from pursue_gen.language.numbers import Number, whole_above
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form


@dataclass(frozen=True)
class NotBefore(AboutOne):
    """`assume: agent does event after time`: it begins the event later than so many time units after the start."""

    agent: Ref
    event: Ref
    time: Number
    span: Span = NOWHERE
    template: ClassVar[Template] = Template("{agent=guest} does {event=call} after {time:number=60}")
    forms: ClassVar[Tuple[Form, ...]] = (Form("from when on somebody does something", template.to_fill_in),)
    numbers: ClassVar[Mapping[str, Callable[[str, Number], str]]] = {
        "after": "It begins that later than {} of time after the start.".format,
    }
    number: ClassVar[str] = "time"
    nearest: ClassVar[int] = 1

    @property
    def clause(self) -> str:
        return f"{self.agent.shown} does {self.event.shown} only later than {units(self.time)} after the start"

    def wrong(self, agent: Agent, setting: Setting) -> Optional[Diagnostic]:
        if self.time <= 0:
            message = "after 0 assumes nothing: expected more than 0"
            return error("PML251", message, self.span, "write the time, or delete the assumption")
        return self.never_does(agent, self.event)

    @property
    def since(self) -> str:
        return "the start"

    def stronger(self, longest: Number) -> Sequence[int]:
        return whole_above(self.time, longest)
