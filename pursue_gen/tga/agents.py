"""Agents: where they can be, how they move, what they do."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import FrozenSet, Iterable, Iterator, Mapping, Optional, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.clauses import Value
from pursue_gen.language.numbers import Number, exact
from pursue_gen.language.scenario import Agent, Event, Scenario, Window
from pursue_gen.language.symbols import Symbol
from pursue_gen.tga.conditions import Conditions
from pursue_gen.tga.network import Automaton, Clause, ClockBound, Edge, Guard, Location, Sync, Test
from pursue_gen.tga.positions import Positions
from pursue_gen.tga.rules import Turns

Assign = Tuple[Tuple[str, int], ...]
"""Variables with the values that an edge gives them."""


@dataclass(frozen=True)
class Surroundings:
    """What an agent's guards read: the scenario, its position numbers, each rule's variable with its turns, conditions.
    """

    scenario: Scenario
    positions: Positions
    rules: Tuple[Tuple[str, Turns], ...]
    conditions: Conditions
    awaited: FrozenSet[Tuple[str, str]] = frozenset()
    """Agents with the POIs to whose arrival there an objective listens."""

    def event(self, name: str) -> Event:
        """The event of that name. Raises KeyError."""
        for event in self.scenario.events:
            if event.name == name:
                return event
        raise KeyError(name)

    def turn(self, channel: str) -> Tuple[Clause, ...]:
        """It is the channel's turn in every rule that names it."""
        return tuple(
            tuple(Test(variable, number) for number in turns[channel])
            for variable, turns in self.rules
            if channel in turns
        )

    def dependencies(self, event: str, agent: str) -> Tuple[Clause, ...]:
        """Every state that the event depends on has the value it needs, for this agent."""
        return tuple(
            self.conditions.having(dependency.state.name, dependency.value, agent)
            for dependency in self.scenario.dependencies
            if dependency.event.name == event
        )

    def company(self, event: Event, doer: str, position: int) -> Tuple[Clause, ...]:
        """Someone else who reacts to a collaborative event is at that position; no condition for other events."""
        if not event.collaborative:
            return ()
        return (tuple(Test(names.agent_position(other), position) for other in self.others(event, doer)),)

    def can_ever_do(self, agent: Agent, event: Event) -> bool:
        """False for a collaborative event that nobody but the agent reacts to: its guard could never be true."""
        return not event.collaborative or bool(self.others(event, agent.name))

    def others(self, event: Event, doer: str) -> Tuple[str, ...]:
        """The agents but the doer who react to an event."""
        reacting = (a for a in self.scenario.agents if any(ref.name == event.name for ref in a.reacts_to))
        return tuple(agent.name for agent in reacting if agent.name != doer)

    def doers(self, event: Event) -> Tuple[Agent, ...]:
        """The agents who can do an event."""
        return tuple(agent for agent in self.scenario.doers(event.name) if self.can_ever_do(agent, event))

    def is_contested(self, event: Event) -> bool:
        """True for an event that several agents can do, and that partners share or that is done in parts.

        The end of one must not be taken for that of another one, nor a part done twice: it happens once at a time.
        """
        return (event.is_shared or event.split is not None) and len(self.doers(event)) > 1

    def pois(self, agent: Agent) -> Tuple[Symbol, ...]:
        """The locations at the POIs at which an agent can ever be, as far as being mobile goes."""
        if agent.mobile is None:
            return tuple(names.at(ref.name) for ref in agent.starts)
        return tuple(names.at(poi.name) for poi in self.scenario.pois if poi.admits(agent.name))


def agent_automaton(agent: Agent, around: Surroundings) -> Automaton:
    """The automaton of an agent. Edges of an agent that is not controllable are the environment's."""
    shape = _Shape(agent, around)
    ways = shape.ways()
    locations = [Location(poi) for poi in shape.pois()]
    locations += [Location(names.going(*way), (shape.within(window),)) for way, window in ways.items()]
    edges = [edge for (a, b), window in ways.items() for edge in shape.movement(a, b, window)]
    for name in dict.fromkeys(ref.name for ref in agent.can_do):
        event = around.event(name)
        if not around.can_ever_do(agent, event):
            continue
        window = event.part_window
        if window is None:
            edges += shape.instantaneous(event, ways)
        else:
            locations += [Location(names.doing(name, poi), (shape.within(window),)) for poi in shape.places(event)]
            edges += [edge for poi in shape.places(event) for edge in shape.lasting(event, window, poi)]
    for name in dict.fromkeys(ref.name for ref in agent.reacts_to):
        event = around.event(name)
        places = shape.shared_places(event) if event.is_shared else ()
        locations += [Location(names.doing(name, poi)) for poi in places]
        edges += [edge for poi in places for edge in shape.sharing(event, poi)]
    first = names.at(agent.location.name)
    if agent.is_somewhere:
        first = names.SOMEWHERE
        locations.append(Location(first, (ClockBound(shape.clock, "<=", exact(Fraction(shape.rest) / 2)),)))
        edges += [shape.start(names.at(ref.name)) for ref in agent.starts]
    return Automaton(names.agent(agent.name), tuple(locations), first, tuple(edges))


@dataclass(frozen=True)
class _Shape:
    """One agent's parts."""

    agent: Agent
    around: Surroundings

    @property
    def clock(self) -> str:
        return names.agent_clock(self.agent.name)

    def pois(self) -> Tuple[Symbol, ...]:
        """The POIs at which the agent can ever be."""
        return self.around.pois(self.agent)

    def ways(self) -> Mapping[Tuple[str, str], Window]:
        """From and to of each movement, and when it may end."""
        return self.around.scenario.movements(self.agent)

    def places(self, event: Event) -> Tuple[Symbol, ...]:
        """The POIs at which the agent can do an event, or take part in it."""
        return tuple(poi for poi in self.pois() if event.location is None or event.location.name == poi)

    def shared_places(self, event: Event) -> Tuple[Symbol, ...]:
        """The POIs at which the agent can take part in an event of another one."""
        others = [doer for doer in self.around.doers(event) if doer is not self.agent]
        theirs = {poi for doer in others for poi in self.around.pois(doer)}
        return tuple(poi for poi in self.places(event) if poi in theirs)

    @property
    def rest(self) -> Number:
        """So long the agent rests at a place before its next step."""
        return self.around.scenario.rest

    def within(self, window: Window) -> ClockBound:
        """The invariant of something that ends in that window."""
        return ClockBound(self.clock, "<=", window[1])

    def start(self, poi: Symbol) -> Edge:
        """It is said that it starts at a POI: before anybody has rested, so that nothing has begun."""
        sync = Sync(names.starts(self.agent.name, poi), sends=True)
        assign = ((names.agent_position(self.agent.name), self.around.positions.at(poi)),)
        return Edge(names.SOMEWHERE, poi, Guard(), sync, assign, (self.clock,), controllable=False)

    def movement(self, a: str, b: str, window: Window) -> Tuple[Edge, ...]:
        """Setting off from a, as far as it ever can, and arriving at b."""
        codes, on_the_way, name = self.around.positions, names.going(a, b), self.agent.name
        channel = names.arrival(name, a, b) if (name, b) in self.around.awaited else None
        end = self._edge(on_the_way, names.at(b), channel, window[0], (), codes.at(b))
        condition = self.around.conditions.setting_off(name, a, b)
        if condition is None:
            return (end,)
        begin = self._edge(names.at(a), on_the_way, names.movement(name, a, b), self.rest, condition, codes.going(a, b))
        return begin, end

    def lasting(self, event: Event, window: Window, poi: str) -> Tuple[Edge, ...]:
        """Beginning an event at a POI, as far as the agent ever can; ending it, or a part of it; breaking it off."""
        codes, at_work, working = self.around.positions, names.doing(event.name, poi), self.around.conditions
        ends = [(names.done(event.name), window[0])]
        conditions = self._conditions(event, codes.at(poi), Value("at", poi))
        if conditions is not None:
            ends += [(names.broken_off(event.name), self.rest)] if event.may_stop else []
            ends += [(names.part_done(event.name), window[0])] if event.split else []
        ending = tuple(
            self._edge(at_work, poi, end, after, self.around.turn(end), codes.at(poi)).plus(
                assign=working.ends(self.agent.name)
            )
            for end, after in ends
        )
        if conditions is None:
            return ending
        start = self._edge(poi, at_work, names.event(event.name), self.rest, conditions, codes.doing(poi))
        start = start.plus(assign=working.begins(self.agent.name, event.name, poi))
        if not self.around.is_contested(event):
            return (start, *ending)
        busy = names.busy(event.name)
        return start.plus((Test(busy, 0),), assign=((busy, 1),)), *(end.plus(assign=((busy, 0),)) for end in ending)

    def sharing(self, event: Event, poi: str) -> Tuple[Edge, Edge]:
        """Taking part in an event of another agent at a POI, from its beginning to its end.

        When it may begin and end is said by the one who does it: receivers have no clock guards (UPPAAL allows none),
        and are controllable, so that a command stays one.
        """
        codes, at_work = self.around.positions, names.doing(event.name, poi)
        doers = self.around.doers(event)
        # With several of them the event has a place, at which they are.
        here = (Test(names.agent_position(doers[0].name), codes.at(poi)),) if event.location is None else ()

        def edge(source: str, target: str, channel: str, where: Clause, position: int, work: Assign) -> Edge:
            assign = ((names.agent_position(self.agent.name), position), *work)
            guard = Guard(integers=(where,) if where else ())
            return Edge(source, target, guard, Sync(channel, sends=False), assign, (self.clock,))

        working, name = self.around.conditions, self.agent.name
        begins = working.begins(name, event.name, poi)
        start = edge(poi, at_work, names.event(event.name), here, codes.doing(poi), begins)
        return start, edge(at_work, poi, names.done(event.name), (), codes.at(poi), working.ends(name))

    def instantaneous(self, event: Event, ways: Iterable[Tuple[str, str]]) -> Iterator[Edge]:
        """Doing an event at POIs, and on the way where it has no location (company is then met head-on)."""
        codes = self.around.positions
        for poi in self.places(event):
            conditions = self._conditions(event, codes.at(poi), Value("at", poi))
            if conditions is not None:
                yield self._edge(poi, poi, names.event(event.name), self.rest, conditions, None)
        if event.location is None:
            for a, b in ways:
                here = names.going(a, b)
                conditions = self._conditions(event, codes.going(b, a), Value("way", a, b))
                if conditions is not None:
                    guard = Guard((ClockBound(self.clock, ">", 0),), conditions)
                    does = Sync(names.event(event.name), sends=True)
                    yield Edge(here, here, guard, does, controllable=self.agent.controllable)

    def _conditions(self, event: Event, company_at: int, where: Value) -> Optional[Tuple[Clause, ...]]:
        """What has to hold when the agent, which is there, does the event; None: that it cannot."""
        around = self.around
        condition = around.conditions.beginning(event.name, self.agent.name, where)
        if condition is None:
            return None
        company = around.company(event, self.agent.name, company_at)
        return company + around.turn(event.name) + around.dependencies(event.name, self.agent.name) + condition

    def _edge(
        self,
        source: str,
        target: str,
        channel: Optional[str],
        after: Number,
        conditions: Tuple[Clause, ...],
        position: Optional[int],
    ) -> Edge:
        """An edge that needs the clock to be past `after`, resets it and, with a position, says where the agent is."""
        return Edge(
            source,
            target,
            Guard((ClockBound(self.clock, ">", after),), conditions),
            None if channel is None else Sync(channel, sends=True),
            () if position is None else ((names.agent_position(self.agent.name), position),),
            (self.clock,),
            self.agent.controllable,
        )
