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
from pursue_gen.language.times import Time, like, time_units, window_text, written_time
from pursue_gen.language.word import Form, Numbers, Word


@dataclass(frozen=True)
class Stays(Departure):
    """`assume: agent stays least to most at each place`: between these time units after it came (or the start) it sets
    off."""

    agent: Ref
    least: Number
    most: Number
    span: Span = NOWHERE
    template: ClassVar[Template] = Template("{agent=visitor} stays {least:time=5} to {most:time=20} at each place")
    own_words: ClassVar[Tuple[Word, ...]] = (Word("stays", "How long it stays at each place.", True),)
    forms: ClassVar[Tuple[Form, ...]] = (Form("how long somebody stays at each place", template.to_fill_in),)
    numbers: ClassVar[Numbers] = {
        "stays": "It sets off {} after it came, or after the start, or later.".format,
        "to": "It has set off {} after it came, or after the start.".format,
    }
    number: ClassVar[str] = "most"
    nearest: ClassVar[int] = SHORTEST_STAY

    @property
    def subject(self) -> str:
        return f"assume: {self.template.written(self, least='…', most='…')}"

    @property
    def clause(self) -> str:
        least = units(self.least) if isinstance(self.least, Time) else self.least
        return f"{self.agent.shown} stays {least} to {units(self.most)} at each place"

    @property
    def window(self) -> Tuple[Number, Number]:
        return self.least, self.most

    def wrong(self, agent: Agent, setting: Setting) -> Optional[Diagnostic]:
        if self.most < setting.shortest_stay:
            message = f"to {written_time(self.most)} is too short"
            message += f": whoever arrives rests for {time_units(like(setting.rest, self.most))} before it can set off"
            enough = written_time(like(setting.shortest_stay, self.most))
            return error("PML251", message, self.span, f"write to {enough} or more")
        if self.most < self.least:
            message = f"stays {window_text(self.least, self.most)}: the second number is smaller than the first one"
            return error("PML200", message, self.span, f"write stays {window_text(self.most, self.least)}")
        for each in setting.assumptions:
            if isinstance(each, Leaves) and each.binds(agent) and each.time < self.least:
                least = written_time(self.least)
                message = f"{agent.name} stays {least} or longer, and is assumed to leave {each.place.name} sooner"
                return error("PML264", message, self.span, "assume one of the two")
        return self.never_away(agent, visited(agent, setting), setting)

    @property
    def since(self) -> str:
        return f"{self.agent.shown}'s arrival"

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return whole_below(self.most, max(1, ceil(shortest_stay), ceil(self.least)))
