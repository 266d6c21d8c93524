"""`assume: agent at place by T`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterator, Mapping, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units, warning
from pursue_gen.language.assumptions.base import AboutOne, Departure, Setting, latest_to
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, written_time
from pursue_gen.language.word import Form


@dataclass(frozen=True)
class ThereBy(AboutOne):
    """`assume: agent at place by time`: from so many time units after the start on, it is there."""

    agent: Ref
    place: Ref
    time: Number
    span: Span = NOWHERE
    template = Template("{agent=visitor} at {place:POI=exit} by {time:time=300}")
    forms = (Form("by when somebody has gone", template.to_fill_in),)
    numbers = {"by": "It is there {} after the start, and stays there.".format}
    number = "time"
    nearest = 1
    sets_off = True
    says = "{agent} is at {place} {time} after the start, and from then on"
    counts_since = "the start"

    @property
    def subject(self) -> str:
        return f"assume: {self.template.written(self, place='…', time='…')}"

    def latest(self, ways: Mapping[Tuple[str, str], Number], stay: Number) -> Dict[str, Number]:
        """When it sets off at the latest from each other place, as `latest_to`."""
        return latest_to(self.place.name, self.time, ways, stay)

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        place = self.place.name
        if self.time <= 0:
            message = "by 0 assumes that it is always there: expected more than 0"
            yield error("PML251", message, self.span, "write the time, or take mobile away from it")
        if place == agent.starts_text and agent.mobile is None:
            yield warning("PML254", f"{agent.name} is not mobile: it stays in {place} anyway", self.span, "delete it")
        for start in (ref.name for ref in agent.starts):
            latest = self.latest(setting.open_ways(agent), setting.shortest_stay).get(start)
            if place != start and latest is None:
                message = f"no way that is always open leads {agent.name} from {start} to {place}"
                yield error("PML252", message, self.span, f"connect {start} and {place}, without only_if")
            if latest is not None and latest < setting.shortest_stay:
                sooner = like(exact(self.time + setting.shortest_stay - latest), self.time)
                message = f"{agent.name} may need {units(sooner)} from {start} to {place}"
                yield error("PML252", message, self.span, f"write by {written_time(sooner)} or later")
        shared = {event.name for event in setting.events if event.is_shared}
        for event in (ref.name for ref in agent.reacts_to if ref.name in shared):
            message = f"{agent.name} takes part in {event}, and could be kept from going to {place} in time"
            yield error("PML264", message, self.span, f"let it not react to {event}, or delete the assumption")
        if any(isinstance(each, Departure) and each.binds(agent) for each in setting.assumptions):
            message = f"{agent.name} is assumed to leave places in time, and to stay at {place}"
            yield error("PML264", message, self.span, "assume one of the two")
