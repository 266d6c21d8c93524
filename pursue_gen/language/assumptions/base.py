"""What every kind of assumption has: a kind is a class in a module of its own, which says what is different with it."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice
from math import ceil
from typing import (
    AbstractSet,
    Any,
    Callable,
    ClassVar,
    Dict,
    Iterable,
    Iterator,
    Mapping,
    NamedTuple,
    Sequence,
    Tuple,
)

from pursue_gen.diagnostics import Diagnostic, Span, error, units, warning
from pursue_gen.language.conditions import Condition
from pursue_gen.language.numbers import Number, exact, whole_above, whole_below
from pursue_gen.language.objectives import Safety
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.statements.base import Written
from pursue_gen.language.statements.event import Event
from pursue_gen.language.statements.state import State
from pursue_gen.language.times import Time, like, window_text, written_time

SHORTEST_STAY = 2
"""Rests: an agent rests once before it may set off, and needs some time to do so."""


class Setting(NamedTuple):
    """The scenario in which an assumption stands, as far as one asks for it."""

    agents: Tuple[Agent, ...]
    events: Tuple[Event, ...]
    states: Tuple[State, ...]
    safety: Tuple[Safety, ...]
    assumptions: Tuple[Assumption, ...]
    onward: Callable[[str, str], AbstractSet[str]]  # from a place, itself included, the places to which an agent gets
    next_to: Callable[[str, str], AbstractSet[str]]  # those to which a single way leads it from there
    open_ways: Callable[[Agent], Mapping[Tuple[str, str], Number]]  # nothing keeps it from them: how long they take
    at_start: Callable[[Condition], bool]  # whether a condition holds at the start
    longest: Callable[[Agent], Mapping[str, Number]]  # by place the longest time of what leads it there, or ends there
    rest: Number  # so many time units agents rest between two steps
    ruled: AbstractSet[str]  # the events that rules and dependencies are about

    @property
    def shortest_stay(self) -> Number:
        """So many time units are enough to come to a place and set off again."""
        return exact(SHORTEST_STAY * self.rest)


class Assumption(Written):
    """What agents that are not controlled are assumed to do, or not to do: a frozen dataclass."""

    span: Span
    listed_in: ClassVar[str] = "assumptions"
    """The field of a scenario that has it."""
    number: ClassVar[str] = ""
    """Its field with a number; "": it has none."""
    nearest: ClassVar[int] = 0
    """What is proposed in place of a number that it cannot have."""
    in_rests: ClassVar[bool] = False
    """`nearest` counts rests, and not time units."""
    counts: ClassVar[bool] = False
    """A variable counts for it how often something has happened."""
    sets_off: ClassVar[bool] = False
    """Its agent has to set off in time, so nothing may keep it from that."""
    says: ClassVar[str] = ""
    """What is assumed, in words, as `Written.told` has them."""
    counts_since: ClassVar[str] = ""
    """The moment since which its clock counts, likewise; "": it has no clock."""

    @property
    def text(self) -> str:
        """The statement, as in `assume: visitor never at lab`."""
        return f"assume: {super().text}"

    @property
    def subject(self) -> str:
        """The statement without its number: two of one subject say the same, or contradict."""
        return f"assume: {self.template.written(self, **{self.number: '…'})}"

    @property
    def clause(self) -> str:
        """What is assumed, in words, as in `visitor is never at lab`."""
        return self.told(self.says)

    @property
    def since(self) -> str:
        """The moment since which its clock counts; "": it has no clock."""
        return self.told(self.counts_since)

    def is_about(self, agent: str) -> bool:
        """True if it names the agent, be it in a condition."""
        return self.speaks_of("agent", agent) or any((kind, ref.name) == ("agent", agent) for kind, ref in self.names())

    def about(self, kind: str, name: str, shown: Callable[[str], str]) -> Iterator[str]:
        if kind == "agent" and self.is_about(name):
            yield f"assumed: {shown(self.clause)}"

    def allows(self, event: str, within: Number) -> bool:
        """True if it lets an event come again so many time units after it has come."""
        return all(ref.name != event for _, ref in self.names())

    def binds(self, agent: Agent) -> bool:
        """True if it says of this agent that it does not do all that it could."""
        raise NotImplementedError

    def again(self, first: Span) -> Diagnostic:
        """The finding that another statement assumes the same already."""
        return error("PML253", f"{first.in_words} assumes this already", self.span, "delete one of the two")

    def check_in(self, setting: Setting) -> Iterator[Diagnostic]:
        """What is wrong with it in its scenario; its names are declared."""
        raise NotImplementedError

    @property
    def excluded(self) -> Tuple[str, ...]:
        """An agent and an event that it never does, where that is all that it says; (): it says something else."""
        return ()

    @property
    def shunned(self) -> Tuple[str, ...]:
        """The places to which its agent never sets off."""
        return ()

    @property
    def counted(self) -> Tuple[str, Mapping[str, str]]:
        """What it counts, and the words for each number; "" and none where nothing is said of that."""
        return "", {}

    @property
    def known_number(self) -> Number:
        """Its number; 0 where it has none."""
        return getattr(self, self.number) if self.number else 0

    def with_number(self, number: int) -> Any:
        """The same with another number, where it has one."""
        changed: Any = self
        return replace(changed, **{self.number: like(number, self.known_number)}) if self.number else self

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        """Numbers with which it would say more, the smallest change first; times up to `longest` units.
        `shortest_stay`: as in `Setting`."""
        return ()

    @classmethod
    def missing(cls, setting: Setting, longest: Number) -> Iterator[Tuple[Assumption, Sequence[int]]]:
        """Assumptions of this kind that may be missing, and the numbers that each may have, as `stronger`."""
        return iter(())


class AboutOne(Assumption):
    """An assumption about one agent."""

    agent: Ref

    def binds(self, agent: Agent) -> bool:
        return agent.name == self.agent.name

    def again(self, first: Span) -> Diagnostic:
        message = f"{first.in_words} assumes this of {self.agent.name} already"
        return error("PML253", message, self.span, "keep the one that is meant")

    def check_in(self, setting: Setting) -> Iterator[Diagnostic]:
        for agent in [each for each in setting.agents if each.name == self.agent.name][:1]:
            if agent.controllable:
                message = f"{agent.name} is controlled: what it does is decided, not assumed"
                hint = "write an objective, a rule or a stateDependency, or take controllable away from it"
                yield error("PML250", message, self.agent.span, hint)
            else:
                yield from islice(self.wrong(agent, setting), 1)

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        """What is wrong with it, its agent being one that is not controlled; the first finding is told."""
        raise NotImplementedError

    def never_does(self, agent: Agent, event: Ref) -> Iterator[Diagnostic]:
        """A warning where the agent cannot do the event that it is about."""
        if all(ref.name != event.name for ref in agent.can_do):
            message = f"{self.clause}: {agent.name} cannot do {event.name} anyway"
            hint = f"delete the assumption, or give it to {agent.name}: can_do {event.name}"
            yield warning("PML254", message, event.span, hint)

    def never_comes(self, agent: Agent, place: Ref, setting: Setting) -> Iterator[Diagnostic]:
        """A warning where the agent never comes to the place that it is about."""
        start = agent.starts_text
        if agent.mobile is None and all(ref.name != place.name for ref in agent.starts):
            message = f"{agent.name} is not mobile: it stays in {start} anyway"
            yield warning("PML254", message, self.span, "delete the assumption")
        elif all(place.name not in setting.onward(ref.name, agent.name) for ref in agent.starts):
            message = f"no way leads {agent.name} from {start} to {place.name} anyway"
            yield warning("PML254", message, self.span, "delete the assumption")


class Departure(AboutOne):
    """An assumption about when an agent sets off, counted from when it came to a place or from the start."""

    sets_off = True
    in_rests = True

    @property
    def only_at(self) -> str:
        """The place that it is about; "": each place."""
        return ""

    @property
    def window(self) -> Tuple[Number, Number]:
        """After how many time units it sets off at the earliest, and at the latest."""
        raise NotImplementedError

    def never_away(self, agent: Agent, places: Iterable[str], setting: Setting) -> Iterator[Diagnostic]:
        """Errors where the agent cannot leave one of these places, to which it may come."""
        if agent.mobile is None:
            message = f"{agent.name} is not mobile: it stays in {agent.starts_text}, and cannot leave it"
            yield error("PML252", message, self.span, "make it mobile (mobile 1)")
        for place in places:
            ways = setting.next_to(place, agent.name)
            if not ways:
                yield error("PML252", f"no way leads away from {place}", self.span, f"connect {place} and …")
            elif ways <= never_at(agent, setting):
                message = f"{agent.name} leaves {place} in time, and is assumed never to be where ways lead from there"
                yield error("PML264", message, self.span, "assume one of the two")


def never_at(agent: Agent, setting: Setting) -> AbstractSet[str]:
    """The places to which the agent is assumed never to set off."""
    return {place for each in setting.assumptions if each.binds(agent) for place in each.shunned}


def visited(agent: Agent, setting: Setting) -> Sequence[str]:
    """The places to which the agent may come, as far as ways and assumptions go, the nearest first."""
    found = [ref.name for ref in agent.starts]
    seen = {*found, *never_at(agent, setting)}
    for place in found:
        found += sorted(setting.next_to(place, agent.name) - seen)
        seen.update(found)
    return found


def latest_to(
    place: str, time: Number, ways: Mapping[Tuple[str, str], Number], stay: Number
) -> Dict[str, Number]:
    """When somebody sets off at the latest who is to be at a place by then, from each other place from which these
    ways, with their longest times, lead there: the nearest places first, with `stay` time units at each in between."""
    found: Dict[str, Number] = {}
    pending: Dict[str, Number] = {place: exact(time + stay)}
    while pending:
        here = max(pending, key=lambda place: pending[place])
        found[here] = pending.pop(here)
        for (a, b), longest in ways.items():
            if b == here and a not in found:
                moment = exact(found[here] - stay - longest)
                pending[a] = max(moment, pending.get(a, moment))
    del found[place]
    return found


class Between(AboutOne):
    """An assumption that an agent does something so many time units after something at the earliest, and so many at the
    latest."""

    least: Number
    most: Number
    number = "most"
    nearest = SHORTEST_STAY
    in_rests = True

    @property
    def subject(self) -> str:
        return f"assume: {self.template.written(self, least='…', most='…')}"

    @property
    def least_to_most(self) -> str:
        """Both times, in words."""
        least = units(self.least) if isinstance(self.least, Time) else self.least
        return f"{least} to {units(self.most)}"

    def ill_timed(self, word: str, why: str, setting: Setting) -> Iterator[Diagnostic]:
        """Errors where no time is left between the two numbers behind the word, or the second one is too short."""
        if self.most < setting.shortest_stay:
            message = f"to {written_time(self.most)} is too short: {why}"
            enough = written_time(like(setting.shortest_stay, self.most))
            yield error("PML251", message, self.span, f"write to {enough} or more")
        if self.most < self.least:
            message = f"{word} {window_text(self.least, self.most)}: the second number is smaller than the first one"
            yield error("PML200", message, self.span, f"write {word} {window_text(self.most, self.least)}")

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return whole_below(self.most, max(1, ceil(shortest_stay), ceil(self.least)))


class NotSooner(AboutOne):
    """An assumption that an agent begins an event only so many time units after something, or later."""

    event: Ref
    time: Number
    number = "time"
    nearest = 1

    def wrong(self, agent: Agent, setting: Setting) -> Iterator[Diagnostic]:
        if self.time <= 0:
            message = f"{''.join(self.numbers)} 0 assumes nothing: expected more than 0"
            yield error("PML251", message, self.span, "write the time, or delete the assumption")
        yield from self.never_does(agent, self.event)

    def stronger(self, longest: Number, shortest_stay: Number) -> Sequence[int]:
        return whole_above(self.time, longest)
