"""What agents carry, and which tool they have mounted: events take things and give them, mount tools, and need both.

Nobody gives what it has not taken. Whoever is controllable carries one thing at a time where nothing else is said; of
others nothing is known unless it is said, and they may take and give at any time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import comb
from typing import Container, Iterable, Iterator, Optional, Set, Tuple

from pursue_gen.diagnostics import Diagnostic, error, listed, warning
from pursue_gen.language.scenario import Agent, Event, Ref, Scenario

MOST_LOADS = 60
"""The most loads that an agent can have: each multiplies the states of the game, as the levels of a battery do."""

Load = Tuple[int, ...]
"""How many of each thing an agent carries, then of each tool whether it is mounted, in the order of its things and
tools."""


@dataclass(frozen=True)
class Carrier:
    """An agent whose load is known. `events`: those of its events that name a thing; `things`, `tools`: those that it
    can take, and mount, in the order of their declaration.
    """

    agent: Agent
    events: Tuple[Event, ...]
    things: Tuple[str, ...]
    tools: Tuple[str, ...] = ()

    @property
    def names(self) -> Tuple[str, ...]:
        """Its things and tools, as loads list them."""
        return (*self.things, *self.tools)

    @property
    def first(self) -> Load:
        """What it carries and has mounted at the start."""
        return tuple(sum(ref.name == name for ref in self.agent.has) for name in self.names)

    @property
    def room(self) -> int:
        """How many things it carries at one time at most: no less than at the start."""
        return max(self.held, 1 if self.agent.carries is None else self.agent.carries)

    @property
    def held(self) -> int:
        """How many things it carries at the start."""
        return sum(ref.name in self.things for ref in self.agent.has)

    @property
    def count(self) -> int:
        """How many loads it can have."""
        return comb(self.room + len(self.things), self.room) * (len(self.tools) + 1)

    @property
    def loads(self) -> Tuple[Load, ...]:
        """All that it can carry and have mounted, in order of how many things that is; nothing first."""
        carried = (load for load in product(range(self.room + 1), repeat=len(self.things)) if sum(load) <= self.room)
        ordered = sorted(carried, key=lambda load: (sum(load), tuple(-count for count in load)))
        mounted = [tuple(int(k == one) for k in range(len(self.tools))) for one in range(-1, len(self.tools))]
        return tuple((*load, *tool) for tool in mounted for load in ordered)

    def after(self, event: Event, load: Load) -> Optional[Load]:
        """What it carries and has mounted when the event has ended that it begins with a load; None: it cannot."""
        names, then, first = self.names, list(load), len(self.things)
        for ref, count in ((event.needs, 1), (event.gives, event.given)):
            if ref is not None and dict(zip(names, load)).get(ref.name, 0) < count:
                return None
        if event.gives is not None:
            then[names.index(event.gives.name)] -= event.given
        if event.takes is not None:
            then[names.index(event.takes.name)] += event.taken
        if event.mounts is not None:
            then[first:] = [int(tool == event.mounts.name) for tool in self.tools]
        return tuple(then) if sum(then[:first]) <= self.room else None


def carriers(scenario: Scenario) -> Iterator[Carrier]:
    """The agents whose loads are known."""
    naming = [event for event in scenario.events if event.load_words]
    for agent in scenario.agents if naming else ():
        able = {ref.name for ref in agent.can_do}
        events = tuple(event for event in naming if event.name in able)
        if events and (agent.controllable or agent.carries is not None):
            tools = _named(event.mounts for event in events)
            carried = _named((*agent.has, *(event.takes for event in events))) - tools
            known = [thing.name for thing in scenario.things]
            yield Carrier(agent, events, *(tuple(name for name in known if name in some) for some in (carried, tools)))


def _named(refs: Iterable[Optional[Ref]]) -> Set[str]:
    return {ref.name for ref in refs if ref is not None}


def load_words(scenario: Scenario, carrier: Carrier, load: Load) -> str:
    """A load in words, as in `2 of box, 1 of letter and brush mounted`."""
    carried = [f"{count} of {scenario.shown(thing)}" for thing, count in zip(carrier.things, load) if count]
    mounted = zip(carrier.tools, load[len(carrier.things) :])
    found = [*carried, *(f"{scenario.shown(tool)} mounted" for tool, is_mounted in mounted if is_mounted)]
    return listed(found) if found else "nothing"


def check_loads(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about things whose names are declared, and about who carries them."""
    taken, mounted = (_named(getattr(e, word) for e in scenario.events) for word in ("takes", "mounts"))
    there = _named(ref for agent in scenario.agents for ref in agent.has)
    for thing in scenario.things:
        if thing.name not in taken | mounted | there:
            hint = f"let an event take it: takes {thing.name} behind its duration, or delete this line"
            yield warning("PML344", f"nothing takes or mounts {thing.name}", thing.span, hint)
    for event in scenario.events:
        yield from _event(event, taken)
    known = {carrier.agent.name: carrier for carrier in carriers(scenario)}
    for agent in scenario.agents:
        problems = [*_number(agent, known.get(agent.name))] or [*_without(agent, known)]
        yield from problems or (_carrier(known[agent.name]) if agent.name in known else ())


def _event(event: Event, taken: Container[str]) -> Iterator[Diagnostic]:
    """Things that one event both takes and gives, or of which one is carried and mounted."""
    for word, count in (("takes", event.taken), ("gives", event.given)):
        if count < 1:
            hint = f"write a number from 1 on, or delete {word}"
            yield error("PML340", f"{event.name} {word} {count} things: expected 1 or more", event.span, hint)
    if event.takes is not None and event.gives is not None and event.takes.name == event.gives.name:
        message = f"{event.name} takes {event.takes.name} and gives it: nothing would change"
        yield error("PML342", message, event.span, "write two events, one that takes it and one that gives it")
    if event.mounts is not None and event.mounts.name in taken:
        message = f"{event.name} mounts {event.mounts.name}, which another event takes: it is carried, or it is a tool"
        yield error("PML342", message, event.mounts.span, "declare two things, one to be carried and one as a tool")


def _number(agent: Agent, carrier: Optional[Carrier]) -> Iterator[Diagnostic]:
    """A number that nobody can carry, or more at the start than there is room for."""
    tools = [] if carrier is None else [ref for ref in agent.has if ref.name in carrier.tools]
    room = 1 if agent.carries is None else agent.carries
    if not 1 <= room < MOST_LOADS:
        message = f"{agent.name} carries {room} things: expected 1 to {MOST_LOADS - 1}"
        hint = "write a number in these limits, or delete carries" + (": then it carries one" if agent.is_robot else "")
        yield error("PML340", message, agent.span, hint)
    elif len(tools) > 1:
        message = f"{agent.name} has {tools[0].name} and {tools[1].name} mounted at the start: expected one tool"
        yield error("PML340", message, tools[1].span, "delete one of them: another one is mounted by an event")
    elif carrier is not None and carrier.held > room:
        message = f"{agent.name} has {carrier.held} things at the start and room for {room}"
        yield error("PML340", message, agent.span, f"write carries {carrier.held}, or delete some behind has")


def _without(agent: Agent, known: Container[str]) -> Iterator[Diagnostic]:
    """A number of things of who takes and gives none."""
    word = "has" if agent.carries is None else "carries"
    if (agent.carries is not None or agent.has) and agent.name not in known:
        what = ", ".join(ref.name for ref in agent.has) if agent.carries is None else agent.carries
        message = f"{agent.name} {word} {what}, but does nothing that takes a thing"
        hint = f'let it: event "load" … takes box, and can_do load; or delete {word}'
        yield warning("PML344", message, agent.span, hint)


def _carrier(carrier: Carrier) -> Iterator[Diagnostic]:
    name, refs = carrier.agent.name, {ref.name: ref for ref in carrier.agent.can_do}
    given = {event.gives.name for event in carrier.events if event.gives is not None}
    for event in carrier.events:
        had = (("gives", event.gives, carrier.things), ("needs", event.needs, carrier.names))
        for word, thing in ((word, ref.name) for word, ref, there in had if ref is not None and ref.name not in there):
            how = "takes" if word == "gives" else "takes or mounts"
            message = f"{name} can never do {event.name}: it {word} {thing}, and {name} does nothing that {how} {thing}"
            hint = f"add an event that {how} {thing} behind its can_do, or take {event.name} away from it"
            yield error("PML341", message, refs[event.name].span, hint)
    for event in carrier.events:
        most = max(event.taken, event.given)
        if most > carrier.room:
            message = f"{name} can never do {event.name}: it {event.load_words}, and {name} has room for {carrier.room}"
            hint = f"let {name} carry more: carries {most}; or take {event.name} away from it"
            yield error("PML341", message, refs[event.name].span, hint)
        elif event.takes is not None and event.takes.name not in given:
            thing, room = event.takes.name, carrier.room
            message = f"{name} never gives {thing} away: when it carries {room} it can do {event.name} no more"
            hint = f"add an event that gives {thing}, if it is to go on"
            yield warning("PML343", message, refs[event.name].span, hint)
    if carrier.count > MOST_LOADS:
        message = f"{name} can carry {carrier.count:,} loads, and multiplies the states of the game by as many"
        hint = f"at most {MOST_LOADS} are possible: let it carry less than {carrier.room}, or tell fewer things apart"
        yield error("PML345", message, carrier.agent.span, hint)
