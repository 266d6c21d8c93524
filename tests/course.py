"""What the statements of a scenario permit, said without its network: for comparison with what the network permits.

Kept here are where agents are, what they are busy with, states, the rest of each rule's round, counts, and levels of
batteries. Rules are expressions of which each symbol takes away the first part (a derivative), not automata.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import product
from math import ceil, floor
from typing import Dict, List, Optional, Set, Tuple, Union

from pursue_gen.language.conditions import Condition
from pursue_gen.language.scenario import (
    Agent,
    Assumption,
    AtMost,
    Both,
    Choice,
    Connection,
    Event,
    InAll,
    Leaves,
    NeverAt,
    NeverHolds,
    NotBefore,
    Pause,
    Poi,
    Reaches,
    Ref,
    Request,
    RuleBody,
    Scenario,
    Sequence,
    Stays,
    ThereBy,
    Waits,
)
from pursue_gen.tools.simulation.meaning import holds
from pursue_runtime.locations import is_movement

Rest = Union[str, Tuple[str, "Rest", "Rest"]]
"""The rest of a round: a symbol, or ("then" | "or" | "and", first, second); "" when it is over."""


@dataclass
class Stay:
    """Where an agent is, since when, and what it is busy with: a movement `to` a place, or an `event`.

    `doer`: False for one that takes part in what another one does.
    """

    place: str
    since: float
    to: str = ""
    event: str = ""
    doer: bool = True
    rested: float = 0.0
    """The moment from which it rests before it may begin something: the end of its last action or movement."""
    came: float = 0.0
    """When it came to the place; whoever has taken part in something there counts as having come with its end."""

    @property
    def location(self) -> str:
        """The name that the location has everywhere in a mission."""
        if self.to:
            return f"going_{self.place}_to_{self.to}"
        return f"doing_{self.event}_in_{self.place}" if self.event else self.place

    @property
    def is_idle(self) -> bool:
        return not self.to and not self.event


def is_for(part: Union[Poi, Connection], agent: str) -> bool:
    """Whether an agent may be there, or set off there, as far as names go."""
    named = {ref.name for ref in part.only_for} or {agent}
    return agent in named - {ref.name for ref in part.not_for}


@dataclass
class Course:
    """One play of a scenario; times are time units from its start."""

    scenario: Scenario
    now: float = 0.0
    stays: Dict[str, Stay] = field(default_factory=dict)
    states: Dict[str, bool] = field(default_factory=dict)
    rests: Dict[Tuple[str, str], Rest] = field(default_factory=dict)
    begun: Dict[str, int] = field(default_factory=dict)
    done: Dict[Tuple[str, str], List[Tuple[float, float]]] = field(default_factory=dict)
    """(agent, event) → beginnings and ends"""
    awaited: Dict[int, float] = field(default_factory=dict)
    """The numbers of assumptions that somebody comes, and when that was called for."""
    happened: List[Tuple[float, str]] = field(default_factory=list)
    """The events that have happened, with their moments; of those that last their ends."""

    def __post_init__(self) -> None:
        self.events = {event.name: event for event in self.scenario.events}
        self.agents = {agent.name: agent for agent in self.scenario.agents}
        self.stays = {agent.name: Stay(agent.location.name, 0.0) for agent in self.scenario.agents}
        self.states = {state.name: state.initially for state in self.scenario.states}
        self.batteries = {battery.agent.name: battery for battery in self.scenario.batteries}
        self.levels = {name: battery.capacity for name, battery in self.batteries.items()}

    @property
    def locations(self) -> Dict[str, str]:
        return {name: stay.location for name, stay in self.stays.items()}

    # What may begin -------------------------------------------------------------------------------------------------

    def holds(self, condition: Optional[Condition]) -> bool:
        values = {f"S{name}": int(value) for name, value in self.states.items()}
        return condition is None or holds(condition, self.scenario, self.locations, values)

    def may_set_off(self, agent: str, a: str, b: str) -> bool:
        """Whether it may set off from a to b, whatever the time."""
        stay = self.stays[agent]
        here_for = [poi for poi in self.scenario.pois if poi.name in (a, b)]
        if not all(is_for(part, agent) for part in here_for):
            return False
        ways = [way for way in self.scenario.connections if (a, b) == (way.a, way.b)]
        ways += [way for way in self.scenario.connections if (a, b) == (way.b, way.a) and not way.one_way]
        never = (each for each in self.scenario.assumptions if isinstance(each, NeverAt))
        if any((each.agent.name, each.place.name) == (agent, b) for each in never):
            return False
        there = [each.place.name for each in self.scenario.assumptions if self._is_there_by(each, agent)]
        there += [each.place.name for number, each in self._comes(agent) if number in self.awaited]
        if any(b not in self._open_to(agent, place) for place in there):
            return False
        if not self._keeps(agent, Stay(a, self.now, to=b)):
            return False
        moves = self.agents[agent].mobile is not None
        if moves and self.levels.get(agent, 0) < self._used_on_way(agent, a, b):
            return False
        ways = [way for way in ways if is_for(way, agent)]
        return stay.is_idle and stay.place == a and moves and any(self.holds(way.only_if) for way in ways)

    def _is_there_by(self, each: Assumption, agent: str) -> bool:
        return isinstance(each, ThereBy) and each.agent.name == agent

    def _comes(self, agent: str = "") -> List[Tuple[int, Reaches]]:
        """What is assumed of when this agent, or any, comes somewhere, with its number."""
        numbered = enumerate(self.scenario.assumptions)
        return [(k, each) for k, each in numbered if isinstance(each, Reaches) and agent in ("", each.agent.name)]

    def _has_happened(self, event: str) -> None:
        """It has: whoever is to come then, and is not there, is awaited from now on."""
        self.happened.append((self.now, event))
        for number, each in self._comes():
            stay = self.stays[each.agent.name]
            if each.event.name == event and (stay.to or stay.place != each.place.name):
                self.awaited.setdefault(number, self.now)

    def _open_to(self, agent: str, place: str) -> Set[str]:
        """The places from which ways that are always open lead to this one."""
        never = {(each.agent.name, each.place.name) for each in self.scenario.assumptions if isinstance(each, NeverAt)}
        ways = [pair for way in self.scenario.connections if way.only_if is None for pair in way.directions]
        found = {place}
        for _ in ways:
            found |= {a for a, b in ways if b in found and (agent, b) not in never}
        return found

    def _keeps(self, agent: str, stay: Stay) -> bool:
        """Whether conditions that are assumed never to hold cannot hold with the agent there, nor when it has come."""
        never = [each.condition for each in self.scenario.assumptions if isinstance(each, NeverHolds)]
        if self.agents[agent].controllable or not never:
            return True
        under_way = {**self.stays, agent: stay}
        ahead = [(each.location, each.to or each.place) for each in under_way.values()]
        values = {f"S{name}": int(value) for name, value in self.states.items()}
        for chosen in product(*ahead):
            places = dict(zip(under_way, chosen))
            if any(holds(condition, self.scenario, places, values) for condition in never):
                return False
        return True

    def may_begin(self, agent: str, name: str) -> bool:
        """Whether it may do the event, or begin it, whatever the time."""
        event, stay = self.events[name], self.stays[agent]
        if stay.event or (stay.to and (event.duration is not None or event.location is not None)):
            return False
        if event.location is not None and event.location.name != stay.place:
            return False
        if event.collaborative and not self.partners(agent, event):
            return False
        if event.duration is not None and not self._keeps(agent, Stay(stay.place, self.now, event=name)):
            return False
        if self.levels.get(agent, 0) < self._used_at_work(agent, event):
            return False
        if event.is_shared and self._goes_on(name):
            return False
        if event.at_most is not None and self.begun.get(name, 0) >= event.at_most:
            return False
        for dependency in self.scenario.dependencies:
            if dependency.event.name == name and self.states[dependency.state.name] is not dependency.value:
                return False
        times = len(self.done.get((agent, name), ()))
        limits = [each for each in self.scenario.assumptions if isinstance(each, AtMost)]
        if any((each.agent.name, each.event.name) == (agent, name) and times >= each.times for each in limits):
            return False
        if not self.agents[agent].controllable and any(self._is_over(each, name) for each in self.scenario.assumptions):
            return False
        asked = [each for each in self.scenario.safety if isinstance(each, Request) and each.trigger.name == name]
        if any(len(self.open(each)) >= each.most for each in asked):
            return False
        return self.holds(event.only_if) and all(after(rest, name) is not None for rest in self._turns(agent, name))

    def _is_over(self, each: Assumption, event: str) -> bool:
        """Whether others have done all of these that they are assumed to do."""
        events = {ref.name for ref in each.events} if isinstance(each, InAll) else set()
        if not isinstance(each, InAll) or event not in events:
            return False
        others = {name for name, agent in self.agents.items() if not agent.controllable}
        return (
            sum(len(some) for (who, what), some in self.done.items() if who in others and what in events) >= each.times
        )

    def open(self, request: Request) -> List[float]:
        """When those have come that wait for their answer, the oldest first."""
        waiting: List[float] = []
        for moment, event in self.happened:
            if event == request.trigger.name:
                waiting.append(moment)
            elif event == request.response.name:
                del waiting[:1]
        return waiting

    def partners(self, agent: str, event: Event) -> List[str]:
        """Those who can take part now: idle at the same place, or on the same way in the other direction."""
        stay = self.stays[agent]
        reacting = (other for other in self.scenario.agents if any(ref.name == event.name for ref in other.reacts_to))
        others = [(other.name, self.stays[other.name]) for other in reacting if other.name != agent]
        if stay.to:
            return [name for name, other in others if (other.place, other.to) == (stay.to, stay.place)]
        return [name for name, other in others if other.is_idle and other.place == stay.place]

    def _used_on_way(self, agent: str, a: str, b: str) -> int:
        battery = self.batteries.get(agent)
        ways = [{way.a, way.b} for way in self.scenario.connections]
        if battery is None or {a, b} not in ways:
            return 0
        return ceil(battery.uses * self._window(self.agents[agent], Stay(a, 0.0, to=b))[1])

    def _used_at_work(self, agent: str, event: Event) -> int:
        battery = self.batteries.get(agent)
        if battery is None or event.duration is None or self._is_docked(agent):
            return 0
        return ceil(battery.uses * (event.duration + 1 if event.latest is None else event.latest))

    def _is_docked(self, agent: str) -> bool:
        dock = self.batteries[agent].dock
        return dock is not None and self.stays[agent].place == dock.name

    def _goes_on(self, event: str) -> bool:
        several = sum(any(ref.name == event for ref in agent.can_do) for agent in self.scenario.agents) > 1
        return several and any(stay.event == event for stay in self.stays.values())

    def _turns(self, agent: str, event: str) -> List[Rest]:
        """The rests of the rounds of all rules that name the event and bind the agent."""
        return [self._rest(key) for key in self._bound(agent, event)]

    def _bound(self, agent: str, event: str) -> List[Tuple[str, str]]:
        found = []
        for rule in self.scenario.rules:
            bound = rule.each == "" or self.agents[agent].is_robot or rule.each == "agent"
            if event in events_in(rule.body) and bound:
                found.append((rule.name, agent if rule.each else ""))
        return found

    def _rest(self, key: Tuple[str, str]) -> Rest:
        rule = next(rule for rule in self.scenario.rules if rule.name == key[0])
        return self.rests.get(key) or whole(rule.body, self.events)

    # What happens ---------------------------------------------------------------------------------------------------

    def set_off(self, agent: str, a: str, b: str) -> None:
        stay = self.stays[agent]
        assert self.now - stay.rested > float(self.scenario.rest) - 1e-9, "it has to rest"
        for each in self.scenario.assumptions:
            if isinstance(each, Leaves) and (each.agent.name, each.place.name) == (agent, a):
                assert self.now - stay.came <= each.time + 1e-9, "it is assumed to leave sooner"
            if isinstance(each, Stays) and each.agent.name == agent:
                assert each.least - 1e-9 <= self.now - stay.came <= each.most + 1e-9, "it is assumed to stay so long"
            if isinstance(each, ThereBy) and each.agent.name == agent:
                assert self.now <= each.time + 1e-9, "it is assumed to stay where it is"
        if agent in self.levels:
            self.levels[agent] -= self._used_on_way(agent, a, b)
        self.stays[agent] = Stay(a, self.now, to=b)

    def take(self, agent: str, word: str, target: str) -> None:
        """The agent does what leads it to this location; `word` is the event, where it is one."""
        stay = self.stays[agent]
        if stay.to and target == stay.to:
            self.arrive(agent)
        elif stay.event:
            self.end(agent)
        elif is_movement(target) and not stay.to:
            self.set_off(agent, stay.place, target.rpartition("_to_")[2])
        else:
            self.begin(agent, word)

    def arrive(self, agent: str) -> None:
        stay = self.stays[agent]
        low, high = self._window(self.agents[agent], stay)
        for each in self.scenario.assumptions:
            if isinstance(each, ThereBy) and (each.agent.name, each.place.name) != (agent, stay.to):
                assert each.agent.name != agent or self.now <= each.time + 1e-9, "it is assumed to be there by then"
        assert low - 1e-9 < self.now - stay.since <= high + 1e-9, (agent, stay, self.now)
        for number, reach in self._comes(agent):
            since = self.awaited.get(number, self.now)
            assert self.now - since <= reach.time + 1e-9, "it is assumed to be there sooner"
            if reach.place.name == stay.to:
                self.awaited.pop(number, None)
        self.stays[agent] = Stay(stay.to, self.now, rested=self.now, came=self.now)

    def _window(self, agent: Agent, stay: Stay) -> Tuple[float, float]:
        """Between which times a movement ends."""
        for travel in self.scenario.travels:
            if (travel.agent.name, travel.a.name, travel.b.name) == (agent.name, stay.place, stay.to):
                return travel.earliest, travel.earliest + 1 if travel.latest is None else travel.latest
        lengths = [w.distance for w in self.scenario.connections if {w.a, w.b} == {stay.place, stay.to}]
        low = lengths[0] * (agent.mobile or 0)
        return low, low + 1

    def begin(self, agent: str, name: str) -> None:
        """It does the event, or begins it."""
        event, stay = self.events[name], self.stays[agent]
        assert stay.to or self.now - stay.rested > float(self.scenario.rest) - 1e-9, "it has to rest"
        for each in self.scenario.assumptions:
            if isinstance(each, Waits) and (each.agent.name, (each.then or each.event).name) == (agent, name):
                ends = [end for _, end in self.done.get((agent, each.event.name), ())]
                assert not ends or self.now - ends[-1] >= each.time - 1e-9, "it is assumed to wait longer"
            if isinstance(each, NotBefore) and (each.agent.name, each.event.name) == (agent, name):
                assert self.now > each.time - 1e-9, "it is assumed to begin later"
        for pause in (each for each in self.scenario.safety if isinstance(each, Pause)):
            if (pause.then or pause.event).name == name and self.agents[agent].controllable:
                assert self.now - self._ended(pause.event.name) >= pause.time - 1e-9, "the pause is not over"
        partners = self.partners(agent, event) if event.collaborative else []
        self._advance(agent, name, name)
        self.begun[name] = self.begun.get(name, 0) + 1
        self.done.setdefault((agent, name), []).append((self.now, self.now))
        self._set_states(name)
        if event.duration is None:
            self._has_happened(name)
            stay.rested = stay.rested if stay.to else self.now
            return
        if agent in self.levels:
            self.levels[agent] -= self._used_at_work(agent, event)
        for who in (agent, *(partners if event.is_shared else ())):
            here = self.stays[who]
            self.stays[who] = Stay(here.place, self.now, event=name, doer=who == agent, came=here.came)

    def _ended(self, event: str) -> float:
        """When the event has ended last."""
        found = [-1e9]
        for (who, what), some in self.done.items():
            goes_on = self.stays[who].event == event and self.stays[who].doer
            found += [end for _, end in some[: len(some) - goes_on] if what == event]
        return max(found)

    def end(self, agent: str) -> None:
        """It has done what it was busy with."""
        stay = self.stays[agent]
        event = self.events[stay.event]
        low = event.duration or 0
        high = low + 1 if event.latest is None else event.latest
        assert low - 1e-9 < self.now - stay.since <= high + 1e-9, (agent, stay, self.now)
        self._advance(agent, event.name, f"{event.name}DONE")
        if agent in self.levels and self._is_docked(agent):
            battery = self.batteries[agent]
            self.levels[agent] = min(battery.capacity, self.levels[agent] + floor(battery.recharges * low))
        self._has_happened(event.name)
        beginning, _ = self.done[agent, event.name][-1]
        self.done[agent, event.name][-1] = (beginning, self.now)
        for who, other in list(self.stays.items()):
            takes_part = event.is_shared and other.event == event.name and other.place == stay.place
            if who == agent or takes_part:
                came = other.came if who == agent else self.now
                self.stays[who] = Stay(other.place, self.now, rested=self.now, came=came)

    def _advance(self, agent: str, event: str, symbol: str) -> None:
        for key in self._bound(agent, event):
            rest = after(self._rest(key), symbol)
            assert rest is not None, (key, symbol)
            self.rests[key] = rest

    def _set_states(self, event: str) -> None:
        for state in self.scenario.states:
            if event in {ref.name for ref in state.true_if}:
                self.states[state.name] = True
            if event in {ref.name for ref in state.false_if}:
                self.states[state.name] = False


def events_in(body: RuleBody) -> List[str]:
    """The events that a rule names."""
    return [body.name] if isinstance(body, Ref) else [*events_in(body.first), *events_in(body.second)]


def whole(body: RuleBody, events: Dict[str, Event]) -> Rest:
    """A round as an expression over symbols: an event without duration is one, a lasting one its beginning and end."""
    if isinstance(body, Ref):
        return body.name if events[body.name].duration is None else ("then", body.name, f"{body.name}DONE")
    word = {Sequence: "then", Choice: "or", Both: "and"}[type(body)]
    return word, whole(body.first, events), whole(body.second, events)


def after(rest: Rest, symbol: str) -> Optional[Rest]:
    """The rest behind a symbol; None where it is not the symbol's turn."""
    if isinstance(rest, str):
        return "" if rest == symbol else None
    word, first, second = rest
    left, right = after(first, symbol), after(second, symbol)
    if word == "or":
        return left if left is not None else right
    if word == "then":
        return None if left is None else second if left == "" else (word, left, second)
    if left is not None:
        return second if left == "" else (word, left, second)
    return None if right is None else first if right == "" else (word, first, right)
