"""`assume: agent reaches place within T after event`."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil
from typing import Dict, Iterator, Mapping, Sequence, Tuple

from pursue_gen.diagnostics import NOWHERE, Diagnostic, Span, error, units, warning
from pursue_gen.language.assumptions.base import SHORTEST_STAY, AboutOne, Assumption, Setting, latest_to, visited
from pursue_gen.language.numbers import Number, exact, whole_below
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.template import Template
from pursue_gen.language.times import like, written_time
from pursue_gen.language.word import Form, Word


@dataclass(frozen=True)
class Reaches(AboutOne):
    """`assume: agent reaches place within time after event`: so many time units after the event happened it has been
    there, if it was not there anyway. While it is awaited, more of the same event changes nothing."""

    agent: Ref
    place: Ref
    time: Number
    event: Ref
    span: Span = NOWHERE
    template = Template("{agent=mechanic} reaches {place:POI=m1} within {time:time=180} after {event=call1}")
    own_words = (Word("reaches", "The place to which it comes in time.", True),)
    forms = (Form("how soon somebody comes when called", template.to_fill_in),)
    numbers = {"within": "It has been there {} after the event.".format}
    number = "time"
    nearest = SHORTEST_STAY
    in_rests = True
    counts = True
    sets_off = True
    says = "{agent} reaches {place} within {time} after {event}"
    counts_since = "the first {event} that {agent} has not followed"

    def allows(self, event: str, within: Number) -> bool:
        return True

    @property
    def counted(self) -> Tuple[str, Mapping[str, str]]:
        return f"{self.agent.shown} at {self.place.shown}", {"0": "not awaited", "1": "awaited"}

    def latest(self, ways: Mapping[Tuple[str, str], Number], stay: Number) -> Dict[str, Number]:
        """How long after the event it sets off at the latest from each other place, as `latest_to`."""
        return latest_to(self.place.name, self.time, ways, stay)

    def in_time(self, end: str, lasts: Number, latest: Mapping[str, Number], stay: Number) -> Number:
        """How long after the event it may begin at the latest what lasts so long and leads it to a place, where it
        needs `stay` time units before it sets off again."""
        return exact((self.time if end == self.place.name else latest[end] - stay) - lasts)

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        place = self.place.name
        if self.time <= 0:
            yield error("PML251", "within 0 assumes that it is always there", self.span, "expected more than 0")
        if agent.mobile is None and place == agent.starts_text:
            yield warning("PML254", f"{agent.name} is not mobile: it stays in {place} anyway", self.span, "delete it")
        if all(ref.name != self.event.name for each in setting.agents for ref in each.can_do):
            message = f"nobody can do {self.event.name} anyway"
            yield warning("PML254", message, self.event.span, "delete the assumption, or let somebody do it: can_do")
        yield from self._too_soon(agent, setting)
        yield from self._beside(agent, setting)

    def _too_soon(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        """Errors where the event may find it so that it cannot be there in time, wherever it may be."""
        ways, place = setting.open_ways(agent), self.place.name
        latest, longest = self.latest(ways, setting.shortest_stay), setting.longest(agent)
        for here in visited(agent, setting):
            needed = longest.get(here, 0) + setting.shortest_stay
            if here != place and here not in latest:
                message = f"no way that is always open leads {agent.name} from {here} to {place}"
                yield error("PML252", message, self.span, f"connect {here} and {place}, without only_if")
            elif here != place and latest[here] < needed:
                sooner = like(exact(self.time + needed - latest[here]), self.time)
                where = f"where {self.event.name} finds it on its way to {here}, or busy there"
                message = f"{agent.name} may need {units(sooner)} to {place} {where}"
                yield error("PML252", message, self.span, f"write within {written_time(sooner)} or more")

    def _beside(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        """Errors where something else could keep it from going there."""
        shared = {event.name for event in setting.events if event.is_shared}
        for event in (ref.name for ref in agent.reacts_to if ref.name in shared):
            message = f"{agent.name} takes part in {event}, and could be kept from going to {self.place.name} in time"
            yield error("PML264", message, self.span, f"let it not react to {event}, or delete the assumption")
        others = (each for each in setting.assumptions if each.sets_off and each.binds(agent))
        if any(each.subject != self.subject for each in others):
            message = f"more is assumed of when {agent.name} goes where: it could not keep to both"
            yield error("PML264", message, self.span, "assume one of the two")

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return whole_below(self.time, max(1, ceil(shortest_stay)))


def reaches_in(assumptions: Sequence[Assumption]) -> Iterator[Tuple[int, Reaches]]:
    """Those of this kind, each behind its number among these assumptions, from 1."""
    return ((k, each) for k, each in enumerate(assumptions, start=1) if isinstance(each, Reaches))
