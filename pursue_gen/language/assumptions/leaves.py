"""`assume: agent leaves place within T`."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Iterator, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import SHORTEST_STAY, Departure, Setting
from pursue_gen.language.numbers import Number, whole_below
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, time_units, written_time
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Leaves(Departure):
    """`assume: agent leaves place within time`: so many time units after it came (or the start) it has set off."""

    agent: Ref
    place: Ref
    time: Number
    span: Span = NOWHERE
    template = Template("{agent=visitor} leaves {place:POI=hall} within {time:time=30}")
    own_words = (Word("leaves", "The place that it leaves in time.", True),)
    forms = (Form("how long somebody stays", template.to_fill_in),)
    numbers = {"within": "It has set off {} after it came, or after the start.".format}
    number = "time"
    nearest = SHORTEST_STAY
    says = "{agent} leaves {place} within {time}"
    counts_since = "{agent}'s arrival at {place}"

    @property
    def only_at(self) -> str:
        return self.place.name

    @property
    def window(self) -> Tuple[Number, Number]:
        return 0, self.time

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        if self.time < setting.shortest_stay:
            message = f"within {written_time(self.time)} is too short"
            message += f": whoever arrives rests for {time_units(like(setting.rest, self.time))} before it can set off"
            enough = written_time(like(setting.shortest_stay, self.time))
            yield error("PML251", message, self.span, f"write within {enough} or more")
        yield from self.never_comes(agent, self.place, setting)
        yield from self.never_away(agent, [self.place.name], setting)

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return whole_below(self.time, max(1, ceil(shortest_stay)))
