"""`assume: agent does event every T to T`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterator

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error
from pursue_gen.language.assumptions.base import Assumption, Between, Setting
from pursue_gen.language.numbers import Number
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.statements.event import Event
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, time_units
from pursue_gen.language.word import Form


@dataclass(frozen=True)
class Every(Between):
    """`assume: agent does event every least to most`: between these time units after the start, and after each time, it
    does the event.

    Nothing may keep the agent from that, else time could not go on: so the event is free of all conditions.
    """

    agent: Ref
    event: Ref
    least: Number
    most: Number
    span: Span = NOWHERE
    template = Template("{agent=belt} does {event=bring} every {least:time=20} to {most:time=30}")
    forms = (Form("how often something happens", template.to_fill_in),)
    numbers = {
        "every": "It happens {} after the start, or after the last time, or later.".format,
        "to": "It has happened {} after the start, or after the last time.".format,
    }
    says = "{agent} does {event} every {least_to_most}"
    counts_since = "{agent}'s last {event}"

    def allows(self, event: str, within: Number) -> bool:
        return self.event.name != event or self.least < within

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        rest = time_units(like(setting.rest, self.most))
        yield from self.ill_timed("every", f"agents rest for {rest} between two steps", setting)
        event = next(each for each in setting.events if each.name == self.event.name)
        why = self._hindered(agent, event, setting)
        if why:
            message = f"{agent.name} may be kept from {event.name}, and is assumed to do it in time: {why}"
            yield error("PML442", message, self.span, "assume waits, or leave out what keeps it from that")

    def _hindered(self, agent: Agent, event: Event, setting: Setting) -> str:
        """Why the agent may be unable to do the event in time; "": it never is."""
        only = event.location
        is_there = only is None or (agent.mobile is None and all(ref.name == only.name for ref in agent.starts))
        reasons = (
            (all(ref.name != event.name for ref in agent.can_do), f"it cannot do {event.name}"),
            (bool(agent.reacts_to), "it takes part in what others do"),
            (event.duration is not None, f"{event.name} has a duration"),
            (event.collaborative, f"{event.name} takes two"),
            (not is_there, f"it is not always where {event.name} happens"),
            (bool(event.only_if or event.at_most), f"{event.name} is not always allowed"),
            (event.name in setting.ruled, f"{event.name} is not always allowed"),
            (any((event.takes, event.gives, event.mounts, event.needs)), f"{event.name} is about a thing"),
        )
        others = (each for each in setting.assumptions if each is not self and self._is_touched_by(each, setting))
        found = [reason for holds, reason in reasons if holds]
        found += [f"{other.span.in_words} assumes something of that, too" for other in others]
        return found[0] if found else ""

    def _is_touched_by(self, other: Assumption, setting: Setting) -> bool:
        """True if the other one is about the same agent or event, or about a state that the event sets."""
        changed = {
            state.name
            for state in setting.states
            if self.event.name in {ref.name for ref in (*state.true_if, *state.false_if)}
        }
        named = set(other.names())
        return other.is_about(self.agent.name) or any(
            (kind, ref.name) == ("event", self.event.name) or (kind == "state" and ref.name in changed)
            for kind, ref in named
        )
