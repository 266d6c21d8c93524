"""`assume: agent never at place`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import AboutOne, Assumption, Setting
from pursue_gen.language.conditions import At, atoms
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class NeverAt(AboutOne):
    """`assume: agent never at place`: it does not set off to that place."""

    agent: Ref
    place: Ref
    span: Span = NOWHERE
    template = Template("{agent=visitor} never at {place:POI=store}")
    own_words = (Word("never", "It never sets off to that place.", True),)
    forms = (Form("where somebody never goes", template.to_fill_in),)
    says = "{agent} is never at {place}"

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        place = self.place.name
        if any(ref.name == place for ref in agent.starts):
            starts = "may start" if agent.is_somewhere else "starts"
            stays = f"{agent.name} is not mobile: it stays in {place}"
            message = stays if agent.mobile is None else f"{agent.name} {starts} in {place}"
            yield error("PML252", message, self.span, "let it start somewhere else")
        yield from self.never_comes(agent, self.place, setting)

    @property
    def shunned(self) -> Tuple[str, ...]:
        return (self.place.name,)

    @classmethod
    def missing(cls, setting: Setting, longest: Number) -> Iterator[Tuple[Assumption, Sequence[int]]]:
        """For each place in a condition that must always, or never, hold, and each agent of whom it is said."""
        conditions = [each.breaks.condition for each in setting.safety if each.breaks.condition is not None]
        said = [atom for condition in conditions for atom in atoms(condition) if isinstance(atom, At)]
        known = {each.subject for each in setting.assumptions}
        for agent in (agent for agent in setting.agents if not agent.controllable and agent.mobile is not None):
            for place in dict.fromkeys(atom.place.name for atom in said if _speaks_of(atom, agent)):
                never = cls(Ref(agent.name, agent.span), Ref(place, agent.span), agent.span)
                if never.subject not in known:
                    yield never, (1,)


def _speaks_of(atom: At, agent: Agent) -> bool:
    return not atom.who.robots if atom.who.agent is None else atom.who.agent.name == agent.name
