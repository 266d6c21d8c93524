"""`assume: agent stays T to T at each place`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import Between, Departure, Setting, visited
from pursue_gen.language.assumptions.leaves import Leaves
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, time_units, written_time
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Stays(Between, Departure):
    """`assume: agent stays least to most at each place`: between these time units after it came (or the start) it sets
    off."""

    agent: Ref
    least: Number
    most: Number
    span: Span = NOWHERE
    template = Template("{agent=visitor} stays {least:time=5} to {most:time=20} at each place")
    own_words = (Word("stays", "How long it stays at each place.", True),)
    forms = (Form("how long somebody stays at each place", template.to_fill_in),)
    numbers = {
        "stays": "It sets off {} after it came, or after the start, or later.".format,
        "to": "It has set off {} after it came, or after the start.".format,
    }
    says = "{agent} stays {least_to_most} at each place"
    counts_since = "{agent}'s arrival"

    @property
    def window(self) -> Tuple[Number, Number]:
        return self.least, self.most

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        why = f"whoever arrives rests for {time_units(like(setting.rest, self.most))} before it can set off"
        yield from self.ill_timed("stays", why, setting)
        for each in setting.assumptions:
            if isinstance(each, Leaves) and each.binds(agent) and each.time < self.least:
                least = written_time(self.least)
                message = f"{agent.name} stays {least} or longer, and is assumed to leave {each.place.name} sooner"
                yield error("PML264", message, self.span, "assume one of the two")
        yield from self.never_away(agent, visited(agent, setting), setting)
