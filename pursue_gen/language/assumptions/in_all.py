"""`assume: at_most N of event, event in all`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, listed
from pursue_gen.language.assumptions.at_most import Counted
from pursue_gen.language.assumptions.base import Setting
from pursue_gen.language.refs import Ref, twice
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form


@dataclass(frozen=True)
class InAll(Counted):
    """`assume: at_most times of events in all`: agents that are not controlled begin these events no more often, all of
    them counted together."""

    times: int
    events: Tuple[Ref, ...]
    span: Span = NOWHERE
    template = Template("at_most {times:count=5} of {events:events=call1, call2} in all")
    forms = (Form("how often several events happen in all", template.to_fill_in),)
    counts_what = "{_shown} by others"

    @property
    def clause(self) -> str:
        often = "never" if not self.times else f"{'once' if self.times == 1 else f'{self.times} times'} in all"
        return f"others do {self._shown} {'at most ' if self.times else ''}{often}"

    @property
    def _shown(self) -> str:
        return listed([ref.shown for ref in self.events])

    def binds(self, agent: Agent) -> bool:
        done = {ref.name for ref in self.events}
        return not agent.controllable and any(ref.name in done for ref in agent.can_do)

    def check_in(self, setting: Setting) -> Iterator[Diagnostic]:
        yield from self.too_often()
        for ref in twice(self.events):
            yield error("PML253", f"{ref.name} stands twice behind of", ref.span, "delete one of the two")
        for ref in dict.fromkeys(self.events):
            doers = [agent for agent in setting.agents if any(each.name == ref.name for each in agent.can_do)]
            if doers and all(agent.controllable for agent in doers):
                message = f"all who can do {ref.name} are controlled: what they do is decided, not assumed"
                yield error("PML250", message, ref.span, f'delete it here, or write event "{ref.name}" at_most … times')
