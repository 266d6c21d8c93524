"""What agents carry: events take things and give them, and nobody gives what it has not taken.

Whoever is controllable carries one thing at a time where nothing else is said; of others nothing is known unless it is
said, and they may take and give at any time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from math import comb
from typing import Container, Iterator, Optional, Tuple

from pursue_gen.diagnostics import Diagnostic, error, listed, warning
from pursue_gen.language.scenario import Agent, Event, Scenario

MOST_LOADS = 60
"""The most loads that an agent can have: each multiplies the states of the game, as the levels of a battery do."""

Load = Tuple[int, ...]
"""How many of each thing an agent carries, in the order of its things."""


@dataclass(frozen=True)
class Carrier:
    """An agent whose load is known. `events`: those of its events that take or give something; `things`: those that
    it can take, in the order of their declaration.
    """

    agent: Agent
    events: Tuple[Event, ...]
    things: Tuple[str, ...]

    @property
    def room(self) -> int:
        """How many things it carries at one time at most."""
        return 1 if self.agent.carries is None else self.agent.carries

    @property
    def count(self) -> int:
        """How many loads it can have."""
        return comb(self.room + len(self.things), self.room)

    @property
    def loads(self) -> Tuple[Load, ...]:
        """All that it can carry, in order of how many things that is; nothing at first."""
        found = (load for load in product(range(self.room + 1), repeat=len(self.things)) if sum(load) <= self.room)
        return tuple(sorted(found, key=lambda load: (sum(load), tuple(-count for count in load))))

    def after(self, event: Event, load: Load) -> Optional[Load]:
        """What it carries when the event has ended that it begins with a load; None: it cannot begin it."""
        then = list(load)
        for ref, more in ((event.gives, -1), (event.takes, 1)):
            if ref is not None and ref.name in self.things:
                then[self.things.index(ref.name)] += more
            elif ref is not None:
                return None  # it never has that
        return tuple(then) if min(then, default=0) >= 0 and sum(then) <= self.room else None


def carriers(scenario: Scenario) -> Iterator[Carrier]:
    """The agents whose loads are known."""
    moving = [event for event in scenario.events if event.takes is not None or event.gives is not None]
    for agent in scenario.agents if moving else ():
        able = {ref.name for ref in agent.can_do}
        events = tuple(event for event in moving if event.name in able)
        if events and (agent.controllable or agent.carries is not None):
            taken = {event.takes.name for event in events if event.takes is not None}
            yield Carrier(agent, events, tuple(thing.name for thing in scenario.things if thing.name in taken))


def load_words(scenario: Scenario, carrier: Carrier, load: Load) -> str:
    """A load in words, as in `2 of box, 1 of letter`."""
    counts = [f"{count} of {scenario.shown(thing)}" for thing, count in zip(carrier.things, load) if count]
    return listed(counts) if counts else "nothing"


def check_loads(scenario: Scenario) -> Iterator[Diagnostic]:
    """Findings about things whose names are declared, and about who carries them."""
    taken = {event.takes.name for event in scenario.events if event.takes is not None}
    for thing in scenario.things:
        if thing.name not in taken:
            hint = f"let an event take it: takes {thing.name} behind its duration, or delete this line"
            yield warning("PML344", f"nothing takes {thing.name}", thing.span, hint)
    for event in scenario.events:
        if event.takes is not None and event.gives is not None and event.takes.name == event.gives.name:
            message = f"{event.name} takes {event.takes.name} and gives it: nothing would change"
            yield error("PML342", message, event.span, "write two events, one that takes it and one that gives it")
    known = {carrier.agent.name: carrier for carrier in carriers(scenario)}
    for agent in scenario.agents:
        problem = _number(agent) or _without(agent, known)
        if problem is not None:
            yield problem
        elif agent.name in known:
            yield from _carrier(known[agent.name])


def _number(agent: Agent) -> Optional[Diagnostic]:
    if agent.carries is None or 1 <= agent.carries < MOST_LOADS:
        return None
    message = f"{agent.name} carries {agent.carries} things: expected 1 to {MOST_LOADS - 1}"
    hint = "write a number in these limits, or delete carries" + (": then it carries one" if agent.is_robot else "")
    return error("PML340", message, agent.span, hint)


def _without(agent: Agent, known: Container[str]) -> Optional[Diagnostic]:
    """A number of things of who takes and gives none."""
    if agent.carries is None or agent.name in known:
        return None
    message = f"{agent.name} carries {agent.carries}, but does nothing that takes a thing"
    hint = 'let it: event "load" … takes box, and can_do load; or delete carries'
    return warning("PML344", message, agent.span, hint)


def _carrier(carrier: Carrier) -> Iterator[Diagnostic]:
    name, refs = carrier.agent.name, {ref.name: ref for ref in carrier.agent.can_do}
    given = {event.gives.name for event in carrier.events if event.gives is not None}
    for event in carrier.events:
        if event.gives is not None and event.gives.name not in carrier.things:
            thing = event.gives.name
            message = f"{name} can never do {event.name}: it gives {thing}, and {name} does nothing that takes {thing}"
            hint = f"add an event that takes {thing} behind its can_do, or take {event.name} away from it"
            yield error("PML341", message, refs[event.name].span, hint)
    for event in carrier.events:
        if event.takes is not None and event.takes.name not in given:
            thing, room = event.takes.name, carrier.room
            message = f"{name} never gives {thing} away: when it carries {room} it can do {event.name} no more"
            hint = f"add an event that gives {thing}, if it is to go on"
            yield warning("PML343", message, refs[event.name].span, hint)
    if carrier.count > MOST_LOADS:
        message = f"{name} can carry {carrier.count:,} loads, and multiplies the states of the game by as many"
        hint = f"at most {MOST_LOADS} are possible: let it carry less than {carrier.room}, or tell fewer things apart"
        yield error("PML345", message, carrier.agent.span, hint)
