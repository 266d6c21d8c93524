"""`assume: not (condition)`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator, List

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import Assumption, Setting
from pursue_gen.language.conditions import Atom, Condition, Doing, Has, Holds, atoms, condition_words
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.word import Form

_DECIDED = "what robots and allies do is decided, not assumed"
_OBJECTIVE = "write an objective instead, as in objective: avoid …"


@dataclass(frozen=True)
class NeverHolds(Assumption):
    """`assume: not (condition)`: nobody makes it hold, nor sets off where it could hold on arrival.

    It is about agents that are not controlled alone.
    """

    condition: Condition
    span: Span = NOWHERE
    template = Template("not {condition:bracketed=(visitor at a and guest at a)}")
    forms = (Form("what never holds", "not ({agent} at {POI} and {agent} at {POI})"),)

    @property
    def clause(self) -> str:
        return f"it never holds that {condition_words(self.condition)}"

    def binds(self, agent: Agent) -> bool:
        return not agent.controllable

    def check_in(self, setting: Setting) -> Iterator[Diagnostic]:
        found = [finding for atom in atoms(self.condition) for finding in self._of_others(atom, setting)]
        if not found and setting.at_start(self.condition):
            message = f"this holds at the start: {condition_words(self.condition)}"
            hint = "let agents start somewhere else, start the states with other values, or correct the condition"
            found = [error("PML252", message, self.span, hint)]
        return iter(found)

    def _of_others(self, atom: Atom, setting: Setting) -> List[Diagnostic]:
        """What is wrong with a part of the condition: who can bring it about, and who may not be kept from moving."""
        controlled = [agent for agent in setting.agents if agent.controllable]
        if isinstance(atom, Holds):
            state = atom.state
            if any(each.name == state.name and each.is_found_out for each in setting.states):
                message = f"{state.name} is unknown at first: nobody could tell what this keeps agents from"
                hint = "name states that are known from the start, or let it be found out and write an objective"
                return [error("PML432", message, state.span, hint)]
            events = {r.name for s in setting.states if s.name == state.name for r in (*s.true_if, *s.false_if)}
            doers = [(agent.name, ref.name) for agent in controlled for ref in agent.can_do if ref.name in events]
            said = [f"{who} is controlled, and its {event} sets {state.name}: {_DECIDED}" for who, event in doers]
            return [error("PML263", message, state.span, _OBJECTIVE) for message in said]
        if isinstance(atom, Has):
            message = f"what somebody has cannot be assumed: {atom.thing.shown} is taken and given by events"
            return [error("PML263", message, atom.thing.span, "assume how often the event happens, or an objective")]
        ref = atom.who.agent
        if ref is None:
            message = f"any {'robot' if atom.who.robots else 'agent'} means controlled ones as well: {_DECIDED}"
            hint = "name the agents that are meant, or write an objective instead"
            return [error("PML263", message, self.span, hint)] if controlled else []
        if any(agent.name == ref.name for agent in controlled):
            message = f"{ref.name} is controlled: what it does is decided, not assumed"
            return [error("PML250", message, ref.span, _OBJECTIVE)]
        bound = [agent for agent in setting.agents if agent.name == ref.name]
        if any(each.sets_off and any(map(each.binds, bound)) for each in setting.assumptions):
            message = f"{ref.name} is assumed to leave a place in time, and could be kept from setting off by this"
            hint = "assume one of the two, or never at in place of not"
            return [error("PML264", message, ref.span, hint)]
        if not isinstance(atom, Doing) or not any(e.name == atom.event.name and e.is_shared for e in setting.events):
            return []
        name = atom.event.name
        able = [agent.name for agent in controlled if any(each.name == name for each in agent.can_do)]
        said = [f"{who} is controlled, and can begin {name} with {ref.name}: {_DECIDED}" for who in able]
        return [error("PML263", message, atom.event.span, _OBJECTIVE) for message in said]
