"""What `if order then pack within T, at_most N open` assumes: that with N open ones no further one comes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import Assumption, Setting
from pursue_gen.language.numbers import Number
from pursue_gen.language.objectives.request import Request
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template


@dataclass(frozen=True)
class MostOpen(Assumption):
    """`at_most most open`, behind an objective: agents that are not controlled do the event only while fewer than
    `most` of these events wait for their answer."""

    event: Ref
    answer: Ref
    most: int
    span: Span = NOWHERE
    template = Template("at_most {most:count=3} open")

    @classmethod
    def of(cls, request: Request) -> MostOpen:
        """What a statement of requests assumes."""
        return cls(request.trigger, request.response, request.most, request.span)

    @property
    def text(self) -> str:
        return self.clause

    @property
    def clause(self) -> str:
        few = "none waits" if self.most == 1 else f"fewer than {self.most} wait"
        return f"{self.event.shown} happens only while {few} for {self.answer.shown}"

    def allows(self, event: str, within: Number) -> bool:
        return self.event.name != event or self.most > 1

    def binds(self, agent: Agent) -> bool:
        return not agent.controllable and any(ref.name == self.event.name for ref in agent.can_do)

    def check_in(self, setting: Setting) -> Iterator[Diagnostic]:
        name = self.event.name
        for agent in setting.agents:
            if agent.controllable and any(ref.name == name for ref in agent.can_do):
                message = f"{agent.name} is controlled and can do {name}: what it does is decided, not assumed"
                hint = f"let agents do it that are not controlled, or write if {name} then … without at_most … open"
                yield error("PML250", message, self.event.span, hint)
        for event in setting.events:
            if event.name == name and event.duration is not None:
                message = f"{name} has a duration: how many are open is counted when it happens, at once"
                hint = f"take duration away from {name}; what somebody does before is another event, in a rule"
                yield error("PML227", message, self.event.span, hint)
