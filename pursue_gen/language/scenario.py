"""The value of the language stage: a scenario, as its author wrote it, each part with its place in the text."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, Callable, Collection, Dict, FrozenSet, Iterator, Optional, Tuple, Union

from pursue_gen.diagnostics import Span
from pursue_gen.language import assumptions as kinds_of_assumptions
from pursue_gen.language import objectives as kinds_of_objectives
from pursue_gen.language.assumptions import *
from pursue_gen.language.assumptions.base import Assumption
from pursue_gen.language.assumptions.most_open import MostOpen
from pursue_gen.language.conditions import AllOf, AnyOf, At, AtMostOf, Condition, Doing, Has, Holds, Not, OnWay, Who
from pursue_gen.language.measures import Length
from pursue_gen.language.numbers import Number, Window, exact
from pursue_gen.language.objectives import *
from pursue_gen.language.objectives import Endurance, GivenUp, Patrol, Reach, Safety, StatedObjective, WhyGivenUp
from pursue_gen.language.objectives.endurance import batteries_in
from pursue_gen.language.objectives.patrol import patrols_in
from pursue_gen.language.objectives.request import requests_in
from pursue_gen.language.poses import Pose, Spot
from pursue_gen.language.refs import Ref
from pursue_gen.language.statements.agent import Agent
from pursue_gen.language.statements.base import Labelled
from pursue_gen.language.statements.battery import Battery
from pursue_gen.language.statements.connect import Connection
from pursue_gen.language.statements.door import Door
from pursue_gen.language.statements.event import Event
from pursue_gen.language.statements.lift import Lift
from pursue_gen.language.statements.mission import MissionEnd
from pursue_gen.language.statements.poi import Poi
from pursue_gen.language.statements.rest import Rest
from pursue_gen.language.statements.rule import Both, Choice, Rule, RuleBody, Sequence
from pursue_gen.language.statements.state import Dependency, State
from pursue_gen.language.statements.thing import Thing
from pursue_gen.language.statements.travel import Travel
from pursue_gen.language.statements.unit import Unit
from pursue_gen.language.times import like

__all__ = [
    "Agent", "AllOf", "AnyOf", "At", "AtMostOf", "Battery", "Both", "Choice", "Condition", "Connection", "Dependency",
    "Doing", "Door", "Event", "Has", "Holds", "Lift", "MissionEnd", "Not", "OnWay", "Poi", "Pose", "Ref", "Rest",
    "Rule", "RuleBody", "Scenario", "Sequence", "Spot", "State", "Thing", "Travel", "Unit", "Who", "Window",
]
__all__ += kinds_of_assumptions.__all__
__all__ += kinds_of_objectives.__all__
"""All parts of a scenario: whoever works with scenarios imports them from here."""


@dataclass(frozen=True)
class Scenario:
    """A whole scenario. `name` is the file's stem, `text` the source; parts are in the order of their declaration.

    One that is built in Python has neither file nor text before `writer.written` gives it both.

    All of `safety` has to hold until all of `reach` is reached; for ever where there is none. `given_up` are optional
    objectives that are in neither of them: what is not promised together with the rest.
    """

    name: str
    file: str = ""
    text: str = ""
    pois: Tuple[Poi, ...] = ()
    connections: Tuple[Connection, ...] = ()
    events: Tuple[Event, ...] = ()
    rules: Tuple[Rule, ...] = ()
    states: Tuple[State, ...] = ()
    dependencies: Tuple[Dependency, ...] = ()
    agents: Tuple[Agent, ...] = ()
    safety: Tuple[Safety, ...] = ()
    reach: Tuple[Reach, ...] = ()
    travels: Tuple[Travel, ...] = ()
    assumptions: Tuple[Assumption, ...] = ()
    given_up: Tuple[GivenUp, ...] = ()
    batteries: Tuple[Battery, ...] = ()
    units: Tuple[Unit, ...] = ()
    rests: Tuple[Rest, ...] = ()
    ends: Tuple[MissionEnd, ...] = ()
    things: Tuple[Thing, ...] = ()
    doors: Tuple[Door, ...] = ()
    lifts: Tuple[Lift, ...] = ()

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        """Show it in a notebook."""
        printer.text(self.text or repr(self))

    @property
    def unit(self) -> Optional[Number]:
        """The seconds of a time unit; None: it does not say."""
        return self.units[0].seconds if self.units else None

    @property
    def in_metres(self) -> bool:
        """True where distances are metres: one has a unit, or an agent a speed."""
        lengths = any(isinstance(way.distance, Length) for way in self.connections)
        return lengths or any(agent.speed is not None for agent in self.agents)

    def as_distance(self, number: Number) -> Number:
        """A distance as one would write it beside those that it has."""
        return like(number, next((way.distance for way in self.connections if isinstance(way.distance, Length)), None))

    @property
    def rest(self) -> Number:
        """The time units that an agent rests at a place after an action or a movement, before it can begin the next."""
        return exact(self.rests[0].time) if self.rests else 1

    @property
    def optional(self) -> Tuple[int, ...]:
        """The numbers behind `optional` among its objectives, the one that is to be kept longest first."""
        return tuple(sorted({objective.optional for objective in self.objectives} - {0}))

    def giving_up(self, numbers: Collection[int], why: WhyGivenUp = WhyGivenUp.IMPOSSIBLE) -> Scenario:
        """The scenario with these of its optional objectives given up."""
        given_up = (GivenUp(each, why) for each in self.objectives if each.optional in numbers)
        in_order = tuple(sorted((*self.given_up, *given_up), key=lambda each: each.objective.optional))
        kept = self.with_each(lambda each: None if each.optional in numbers else each)
        return replace(kept, given_up=in_order)

    def with_each(self, changed: Callable[[Any], Optional[StatedObjective]]) -> Scenario:
        """The scenario with what `changed` makes of each objective; without it where that is None."""
        safety: Tuple[Any, ...] = tuple(new for new in map(changed, self.safety) if new is not None)
        reach: Tuple[Any, ...] = tuple(new for new in map(changed, self.reach) if new is not None)
        return replace(self, safety=safety, reach=reach)

    def with_instead(self, old: object, new: object) -> Scenario:
        """The scenario with another part in place of one of its parts."""
        known = {field.name: getattr(self, field.name) for field in fields(self)}
        parts = {kind: several for kind, several in known.items() if isinstance(several, tuple) and old in several}
        changed: Any = {kind: tuple(new if each == old else each for each in parts[kind]) for kind in parts}
        return replace(self, **changed)

    @property
    def objectives(self) -> Tuple[StatedObjective, ...]:
        """All objectives: those that always hold, then those that are reached once."""
        return (*self.safety, *self.reach)

    @cached_property
    def labels(self) -> Dict[str, str]:
        """Name → what people read instead, of all places, events, agents, things, doors and lifts with a label."""
        parts: Tuple[Labelled, ...] = (*self.pois, *self.events, *self.agents, *self.things, *self.doors, *self.lifts)
        return {part.name: part.label for part in reversed(parts) if part.label}

    def shown(self, name: str) -> str:
        """What people read for a name: its label, or the name itself."""
        return self.labels.get(name, name)

    @property
    def facts(self) -> Tuple[str, ...]:
        """The states that are not known at first: the world says what they are, as it says what agents do."""
        return tuple(state.name for state in self.states if state.is_found_out)

    @property
    def orders(self) -> Tuple[Event, ...]:
        """The events that people order during a mission."""
        return tuple(event for event in self.events if event.on_order)

    def bound_by(self, rule: Rule) -> Tuple[Agent, ...]:
        """The agents that have a turn of their own in a rule for each of them; none where all have one turn."""
        named = {ref.name for ref in rule.events} if rule.each else set()
        able = (agent for agent in self.agents if any(ref.name in named for ref in agent.can_do))
        return tuple(agent for agent in able if agent.is_robot or rule.each == "agent")

    @cached_property
    def assumed(self) -> Tuple[Assumption, ...]:
        """All that is assumed, which has numbers in this order: the statements, then what stands behind objectives."""
        return (*self.assumptions, *(MostOpen.of(each) for _, each in requests_in(self.safety)))

    @cached_property
    def patrols(self) -> Tuple[Patrol, ...]:
        """The patrols among its objectives, one for each place."""
        return patrols_in(self.safety)

    @property
    def powered(self) -> Tuple[Union[Battery, Endurance], ...]:
        """The batteries of robots, by levels and by time."""
        return (*self.batteries, *(each for _, each in batteries_in(self.safety)))

    @property
    def statements(self) -> Tuple[Tuple[StatedObjective, ...], ...]:
        """All objectives, those in one part that have a meaning together only: the places of a patrol in order."""
        found: Dict[object, Tuple[StatedObjective, ...]] = {}
        for number, each in enumerate(self.objectives):
            key = each.span if each.order else number
            found[key] = (*found.get(key, ()), each)
        return tuple(found.values())

    def conditions(self) -> Iterator[Tuple[Condition, Span]]:
        """Every condition, with the place of the statement that it stands in."""
        for part in (*self.connections, *self.events, *self.safety, *self.assumptions):
            yield from ((condition, part.span) for condition in part.conditions)

    def on_patrol(self, patrol: Patrol) -> Tuple[Agent, ...]:
        """The agents of whom one has to be at the place."""
        named = {ref.name for ref in patrol.who.named}
        return tuple(agent for agent in self.agents if (agent.name in named if named else agent.is_robot))

    def doers(self, event: str) -> Tuple[Agent, ...]:
        """The agents that can do an event."""
        return tuple(agent for agent in self.agents if any(ref.name == event for ref in agent.can_do))

    @cached_property
    def for_some(self) -> Tuple[Union[Poi, Connection], ...]:
        """The places and ways that are not for all agents."""
        return (*self._places_for_some, *(way for way in self.connections if way.only_for or way.not_for))

    @cached_property
    def _places_for_some(self) -> Tuple[Poi, ...]:
        return tuple(poi for poi in self.pois if poi.only_for or poi.not_for)

    @cached_property
    def _several(self) -> FrozenSet[Tuple[str, str]]:
        """From and to of what has more than one way."""
        ends = Counter(direction for way in self.connections for direction in way.directions)
        return frozenset(direction for direction, number in ends.items() if number > 1)

    def is_lane(self, way: Connection) -> bool:
        """True for a way of some agents beside which others have one of their own."""
        return not self._several.isdisjoint(way.directions)

    def closed_to(self, agent: str) -> Tuple[Union[Poi, Connection], ...]:
        """The places and ways that are not for the agent of this name."""
        return tuple(part for part in self.for_some if not part.admits(agent))

    def closed_places(self, agent: str) -> FrozenSet[str]:
        """The names of those of them that are places."""
        return frozenset(poi.name for poi in self._places_for_some if not poi.admits(agent))

    def ways_of(self, agent: str) -> Tuple[Connection, ...]:
        """The ways that the agent of this name may take: those that are for it and have both ends where it may be."""
        closed = self.closed_places(agent)
        return tuple(way for way in self.connections if way.admits(agent) and not closed & {way.a, way.b})

    def movements(self, agent: Agent) -> Dict[Tuple[str, str], Window]:
        """From and to of each movement that the agent can make, and between which times it arrives."""
        if agent.mobile is None:
            return {}
        own = {travel.way: travel.window for travel in self.travels if travel.agent.name == agent.name}
        found = {}
        for connection in self.ways_of(agent.name):
            least, most = self.waiting(connection)
            for way in connection.directions:
                earliest, latest = own.get(way) or agent.window_on(connection.distance)
                found[way] = exact(earliest + least) if least else earliest, exact(latest + most) if most else latest
        return found

    def waiting(self, way: Connection) -> Window:
        """The time units for which whoever sets off on a way does not drive: least and most. Its doors are all asked at
        once; its lift comes, and then takes its time."""
        opening = max((door.opens_within for door in self.doors_on(way)), default=0)
        lift = self.lift_on(way)
        return (0, opening) if lift is None else (lift.ride[0], opening + lift.comes_within + lift.ride[1])

    def doors_on(self, way: Connection) -> Tuple[Door, ...]:
        """The doors of a way, in the order in which they are declared."""
        return tuple(door for door in self.doors if any(ref.name == door.name for ref in way.through))

    def lift_on(self, way: Connection) -> Optional[Lift]:
        """The lift that a way goes by; None: it goes by none."""
        return next((lift for lift in self.lifts if way.by is not None and way.by.name == lift.name), None)

    def words_on(self, way: Connection) -> Tuple[str, ...]:
        """What people read of the doors and the lift of a way, as in `through d1 (opens within 8 s)`."""
        lift = self.lift_on(way)
        return (*(door.in_words for door in self.doors_on(way)), *(() if lift is None else (lift.in_words,)))
