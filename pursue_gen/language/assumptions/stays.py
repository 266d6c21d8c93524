"""`assume: agent stays T to T at each place`."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import ClassVar, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units
from pursue_gen.language.assumptions.base import SHORTEST_STAY, Departure, Setting, visited
from pursue_gen.language.assumptions.leaves import Leaves
from pursue_gen.language.numbers import Number, whole_below
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Numbers, Word


@dataclass(frozen=True)
class Stays(Departure):
    """`assume: agent stays least to most at each place`: between these time units after it came (or the start) it sets
    off."""

    agent: Ref
    least: Number
    most: Number
    span: Span = NOWHERE
    template: ClassVar[Template] = Template("{agent=visitor} stays {least:number=5} to {most:number=20} at each place")
    own_words: ClassVar[Tuple[Word, ...]] = (Word("stays", "How long it stays at each place.", True),)
    forms: ClassVar[Tuple[Form, ...]] = (Form("how long somebody stays at each place", template.to_fill_in),)
    numbers: ClassVar[Numbers] = {
        "stays": "It sets off {} of time after it came, or after the start, or later.".format,
        "to": "It has set off {} of time after it came, or after the start.".format,
    }
    number: ClassVar[str] = "most"
    nearest: ClassVar[int] = SHORTEST_STAY

    @property
    def subject(self) -> str:
        return f"assume: {self.template.written(self, least='…', most='…')}"

    @property
    def clause(self) -> str:
        return f"{self.agent.shown} stays {self.least} to {units(self.most)} at each place"

    @property
    def window(self) -> Tuple[Number, Number]:
        return self.least, self.most

    def wrong(self, agent: Agent, setting: Setting) -> Optional[Diagnostic]:
        if self.most < SHORTEST_STAY:
            message = f"to {self.most} is too short: whoever arrives rests for 1 time unit before it can set off"
            return error("PML251", message, self.span, f"write to {SHORTEST_STAY} or more")
        if self.most < self.least:
            message = f"stays {self.least} to {self.most}: the second number is smaller than the first one"
            return error("PML200", message, self.span, f"write stays {self.most} to {self.least}")
        for each in setting.assumptions:
            if isinstance(each, Leaves) and each.binds(agent) and each.time < self.least:
                message = f"{agent.name} stays {self.least} or longer, and is assumed to leave {each.place.name} sooner"
                return error("PML264", message, self.span, "assume one of the two")
        return self.never_away(agent, visited(agent, setting), setting)

    @property
    def since(self) -> str:
        return f"{self.agent.shown}'s arrival"

    def stronger(self, longest: Number) -> Sequence[int]:
        return whole_below(self.most, max(SHORTEST_STAY, ceil(self.least)))
