"""`assume: agent waits T between event and event`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Optional, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, units
from pursue_gen.language.assumptions.at_most import AtMost
from pursue_gen.language.assumptions.base import Assumption, NotSooner, Setting
from pursue_gen.language.numbers import Number, whole_above
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Waits(NotSooner):
    """`assume: agent waits time between event and then`: so many time units from each end of `event` to the next
    beginning of `then` (None: of the same event)."""

    agent: Ref
    event: Ref
    time: Number
    span: Span = NOWHERE
    then: Optional[Ref] = None
    template = Template("{agent=guest} waits {time:time=5} between {event=call} [and {then:event}]")
    own_words = (Word("waits", "How many units of time it waits at least.", True),)
    forms = (Form("how long somebody waits in between", template.to_fill_in),)
    numbers = {"waits": "The next one begins {} after the end of the last, or later.".format}
    counts = True  # whether it has happened: the first time is free
    counts_since = "{agent}'s last {event}"

    @property
    def following(self) -> Ref:
        """The event with which it waits."""
        return self.event if self.then is None else self.then

    @property
    def clause(self) -> str:
        if self.following.name == self.event.name:
            return f"{self.agent.shown} waits {units(self.time)} between one {self.event.shown} and the next"
        between = f"a {self.event.shown} and the next {self.following.shown}"
        return f"{self.agent.shown} waits {units(self.time)} between {between}"

    def allows(self, event: str, within: Number) -> bool:
        return self.following.name != event or self.time < within

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        yield from super().wrong(agent, setting)
        yield from self.never_does(agent, self.following)

    @classmethod
    def missing(cls, setting: Setting, longest: Number) -> Iterator[Tuple[Assumption, Sequence[int]]]:
        """For each event that has to be answered, and each agent that may begin it again and again as it likes."""
        calls = (each.breaks.begins for each in setting.safety)
        answered = {call.name: call for call in calls if isinstance(call, Ref)}
        known = {each.subject for each in setting.assumptions}
        counted = {event.name for event in setting.events if event.at_most is not None}
        for name, event in answered.items():
            for agent in setting.agents:
                if agent.controllable or name in counted or all(ref.name != name for ref in agent.can_do):
                    continue
                pause = cls(Ref(agent.name, agent.span), event, 1, event.span)
                if known.isdisjoint((pause.subject, AtMost(pause.agent, event, 1).subject)):
                    yield pause, whole_above(0, longest)
