"""What the statements of a scenario permit, said without its network: for comparison with what the network permits.

Kept here are where agents are, what they are busy with, states (None: nobody knows), the rest of each rule's round,
counts, what agents carry, and levels of batteries.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from itertools import product
from math import ceil, floor
from typing import Dict, List, Optional, Set, Tuple, Union

from pursue_gen.language.conditions import Condition
from pursue_gen.language.loads import carriers
from pursue_gen.language.numbers import Number
from pursue_gen.language.scenario import (
    Agent,
    Assumption,
    AtMost,
    Connection,
    Event,
    Every,
    InAll,
    Leaves,
    NeverAt,
    NeverHolds,
    NotBefore,
    Pause,
    Poi,
    Reaches,
    Request,
    Scenario,
    Stays,
    ThereBy,
    Waits,
)
from pursue_gen.tools.simulation.meaning import holds
from pursue_runtime.locations import SOMEWHERE, is_movement
from tests.rounds import Rest, after, events_in, whole

NEVER = -1e9


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
    unplaced: bool = False
    """Nobody has said yet where it starts."""

    @property
    def location(self) -> str:
        """The name that the location has everywhere in a mission."""
        if self.unplaced:
            return SOMEWHERE
        if self.to:
            return f"going_{self.place}_to_{self.to}"
        return f"doing_{self.event}_in_{self.place}" if self.event else self.place

    @property
    def is_idle(self) -> bool:
        return not self.to and not self.event and not self.unplaced


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
    states: Dict[str, Optional[bool]] = field(default_factory=dict)
    shown: Dict[str, float] = field(default_factory=dict)
    """The states that are being found out, and since when."""
    rounds: Dict[Tuple[str, str], List[str]] = field(default_factory=dict)
    """What has happened in the present round of each rule, but for what was broken off."""
    begun: Dict[str, int] = field(default_factory=dict)
    parts: Dict[str, int] = field(default_factory=dict)
    """How many parts are done of events in parts."""
    done: Dict[Tuple[str, str], List[Tuple[float, float]]] = field(default_factory=dict)
    """(agent, event) → beginnings and ends"""
    carried: Dict[str, List[str]] = field(default_factory=dict)
    mounted: Dict[str, str] = field(default_factory=dict)
    awaited: Dict[int, float] = field(default_factory=dict)
    """The numbers of assumptions that somebody comes, and when that was called for."""
    happened: List[Tuple[float, str]] = field(default_factory=list)
    """The events that have happened, with their moments; of those that last their ends."""

    def __post_init__(self) -> None:
        self.events = {event.name: event for event in self.scenario.events}
        self.agents = {agent.name: agent for agent in self.scenario.agents}
        self.stays = {a.name: Stay(a.location.name, 0.0, unplaced=bool(a.or_at)) for a in self.scenario.agents}
        self.states = {state.name: state.initially for state in self.scenario.states}
        tools = {event.mounts.name for event in self.scenario.events if event.mounts is not None}
        for agent in self.scenario.agents:
            self.carried[agent.name] = [ref.name for ref in agent.has if ref.name not in tools]
            for ref in (ref for ref in agent.has if ref.name in tools):
                self.mounted[agent.name] = ref.name
        for name, stay in self.stays.items():
            self._sees(name, stay.place)
        self.batteries = {battery.agent.name: battery for battery in self.scenario.batteries}
        self.levels: Dict[str, Number] = {name: battery.capacity for name, battery in self.batteries.items()}

    @property
    def locations(self) -> Dict[str, str]:
        return {name: stay.location for name, stay in self.stays.items()}


    def holds(self, condition: Optional[Condition], agent: str) -> bool:
        """Whether it holds for what the agent is to do: who is controlled has to know that, of others it may be so."""
        values = {f"S{name}": 2 if value is None else int(value) for name, value in self.states.items()}
        for one in carriers(self.scenario):
            has = [*self.carried[one.agent.name], self.mounted.get(one.agent.name, "")]
            values[f"H{one.agent.name}"] = one.loads.index(tuple(has.count(name) for name in one.names))
        whatever = all if self.agents[agent].controllable else any
        return condition is None or holds(condition, self.scenario, self.locations, values, whatever)

    def _sees(self, agent: str, place: str) -> None:
        """A robot is there now."""
        for state in self.scenario.states if self.agents[agent].is_robot else ():
            if state.seen_at is not None and state.seen_at.name == place:
                self._shows(state.name)

    def _shows(self, state: str) -> None:
        """What the state is will be found out, if it is not known."""
        if self.states[state] is None:
            self.shown.setdefault(state, self.now)

    def may_set_off(self, agent: str, a: str, b: str) -> bool:
        """Whether it may set off from a to b, whatever the time."""
        stay = self.stays[agent]
        if not all(is_for(poi, agent) for poi in self.scenario.pois if poi.name in (a, b)):
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
        return stay.is_idle and stay.place == a and moves and any(self.holds(way.only_if, agent) for way in ways)

    def _is_there_by(self, each: Assumption, agent: str) -> bool:
        return isinstance(each, ThereBy) and each.agent.name == agent

    def _comes(self, agent: str = "") -> List[Tuple[int, Reaches]]:
        """What is assumed of when this agent, or any, comes somewhere, with its number."""
        numbered = enumerate(self.scenario.assumptions)
        return [(k, each) for k, each in numbered if isinstance(each, Reaches) and agent in ("", each.agent.name)]

    def _has_happened(self, event: str) -> None:
        """It has: whoever is to come then, and is not there, is awaited from now on; states may be shown."""
        self.happened.append((self.now, event))
        for state in self.scenario.states:
            if any(ref.name == event for ref in state.shown_by):
                self._shows(state.name)
        for number, each in self._comes():
            stay = self.stays[each.agent.name]
            if each.event.name == event and (stay.to or stay.place != each.place.name):
                self.awaited.setdefault(number, self.now)

    def _open_to(self, agent: str, place: str) -> Set[str]:
        """The places from which ways that are always open lead to this one."""
        never = {(each.agent.name, each.place.name) for each in self.scenario.assumptions if isinstance(each, NeverAt)}
        own = [way for way in self.scenario.connections if is_for(way, agent) and way.only_if is None]
        ways = [pair for way in own for pair in way.directions]
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
        values = {f"S{name}": int(value or 0) for name, value in self.states.items()}  # none of these is unknown
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
        if (event.is_shared or event.split) and self._goes_on(name):
            return False
        times = [what for _, what in self.happened].count(name) if event.split else self.begun.get(name, 0)
        if event.at_most is not None and times >= event.at_most:
            return False
        for dependency in self.scenario.dependencies:
            value = self.states[dependency.state.name]
            may_be = value is None and not self.agents[agent].controllable
            if dependency.event.name == name and value is not dependency.value and not may_be:
                return False
        if self._minds_its_load(agent) and self._load_after(agent, event) is None:
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
        turns = self._turns(agent, name)
        return self.holds(event.only_if, agent) and all(after(rest, name) is not None for rest in turns)

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

    def _used_on_way(self, agent: str, a: str, b: str) -> Number:
        battery = self.batteries.get(agent)
        own = [way for way in self.scenario.connections if is_for(way, agent)]
        if battery is None or not any((a, b) in way.directions for way in own):
            return 0
        if battery.driving is not None:
            return battery.driving * next(way.distance for way in self.scenario.connections if {way.a, way.b} == {a, b})
        return ceil(battery.uses * self._window(self.agents[agent], Stay(a, 0.0, to=b))[1])

    def _used_at_work(self, agent: str, event: Event) -> Number:
        battery = self.batteries.get(agent)
        if battery is None or event.duration is None or self._is_docked(agent):
            return 0
        use = battery.uses * self._lasts(event)[1]
        return ceil(use) if battery.driving is None else use

    def _is_docked(self, agent: str) -> bool:
        dock = self.batteries[agent].dock
        return dock is not None and self.stays[agent].place == dock.name

    def _minds_its_load(self, agent: str) -> bool:
        return self.agents[agent].controllable or self.agents[agent].carries is not None

    def _load_after(self, agent: str, event: Event) -> Optional[List[str]]:
        """What it carries when it has done the event; None: that is impossible."""
        load = list(self.carried.get(agent, ()))
        if event.needs is not None and event.needs.name not in (*load, self.mounted.get(agent)):
            return None
        if event.gives is not None:
            if load.count(event.gives.name) < event.given:
                return None
            for _ in range(event.given):
                load.remove(event.gives.name)
        if event.takes is not None:
            load += [event.takes.name] * event.taken
        return load if len(load) <= (self.agents[agent].carries or 1) else None

    def _has_moved(self, agent: str, event: Event) -> None:
        if self._minds_its_load(agent):
            load = self._load_after(agent, event)
            assert load is not None, (agent, event.name)
            self.carried[agent] = load
            if event.mounts is not None:
                self.mounted[agent] = event.mounts.name

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
        rest: Optional[Rest] = whole(rule.body, self.events)
        for symbol in self.rounds.get(key, ()):
            rest = after(rest or "", symbol)
        assert rest is not None, key
        return rest

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
        if agent in self.states:
            self.find(agent, word.endswith("_is_true"))
            return
        stay = self.stays[agent]
        if stay.unplaced:
            self.place(agent, target)
        elif stay.to and target == stay.to:
            self.arrive(agent)
        elif stay.event and word == f"{stay.event}STOP":
            self.stop(agent)
        elif stay.event:
            self.end(agent, word)
        elif is_movement(target) and not stay.to:
            self.set_off(agent, stay.place, target.rpartition("_to_")[2])
        else:
            self.begin(agent, word)

    def place(self, agent: str, poi: str) -> None:
        """It is said where the agent starts."""
        assert poi in [ref.name for ref in self.agents[agent].starts]
        assert self.now <= float(self.scenario.rest) / 2 + 1e-9, "it is to be said sooner"
        self.stays[agent] = Stay(poi, self.now, rested=self.now, came=self.now)

    def find(self, state: str, value: bool) -> None:
        """It is found out what a state is."""
        assert self.now - self.shown.pop(state) <= 1 + 1e-9, "it is to be found out sooner"
        assert self.states[state] is None, "it is known"
        self.states[state] = value

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
        self._sees(agent, stay.to)

    def _window(self, agent: Agent, stay: Stay) -> Tuple[float, float]:
        """Between which times a movement ends."""
        for travel in self.scenario.travels:
            if (travel.agent.name, travel.a.name, travel.b.name) == (agent.name, stay.place, stay.to):
                return travel.earliest, travel.earliest + 1 if travel.latest is None else travel.latest
        own = [way for way in self.scenario.connections if is_for(way, agent.name)]
        lengths = [way.distance for way in own if (stay.place, stay.to) in way.directions]
        low = lengths[0] * (agent.mobile or 0)
        return low, low + 1

    def begin(self, agent: str, name: str) -> None:
        """It does the event, or begins it."""
        event, stay = self.events[name], self.stays[agent]
        assert stay.to or self.now - stay.rested > float(self.scenario.rest) - 1e-9, "it has to rest"
        for each in self.scenario.assumptions:
            if isinstance(each, Waits) and (each.agent.name, (each.then or each.event).name) == (agent, name):
                ends = [end for _, end in self.done.get((agent, each.event.name), ())]
                assert self.now - max(ends, default=NEVER) >= each.time - 1e-9, "it is assumed to wait longer"
            if isinstance(each, Every) and (each.agent.name, each.event.name) == (agent, name):
                last = max((begun for begun, _ in self.done.get((agent, name), ())), default=0.0)
                assert each.least - 1e-9 <= self.now - last <= each.most + 1e-9, "it is assumed to come so often"
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
            self._has_moved(agent, event)
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
        found = [NEVER]
        for (who, what), some in self.done.items():
            goes_on = self.stays[who].event == event and self.stays[who].doer
            found += [end for _, end in some[: len(some) - goes_on] if what == event]
        return max(found)

    def _lasts(self, event: Event) -> Tuple[Fraction, Fraction]:
        """Between which times it ends: of what is in parts each."""
        low, parts = Fraction(event.duration or 0), event.split or 1
        high = low + 1 if event.latest is None else Fraction(event.latest)
        if all(1000 % Fraction(end / parts).denominator == 0 for end in (low, high)):
            return low / parts, high / parts
        return Fraction(floor(low * 10 / parts), 10), Fraction(ceil(high * 10 / parts), 10)

    def end(self, agent: str, word: str) -> None:
        """It has done what it was busy with, or a part of it."""
        stay = self.stays[agent]
        event = self.events[stay.event]
        low, high = self._lasts(event)
        assert low - 1e-9 < self.now - stay.since <= high + 1e-9, (agent, stay, self.now)
        done = (self.parts.get(event.name, 0) + 1) % (event.split or 1)
        assert (word == f"{event.name}PART") == (done > 0), "the last part ends all of it"
        self.parts[event.name] = done
        if not done:
            self._advance(agent, event.name, f"{event.name}DONE")
        if agent in self.levels and self._is_docked(agent):
            battery = self.batteries[agent]
            gain = battery.recharges * low
            gain = floor(gain) if battery.driving is None else gain
            self.levels[agent] = min(battery.capacity, self.levels[agent] + gain)
        if done:
            self._leave(agent)
            return
        self._has_moved(agent, event)
        self._has_happened(event.name)
        beginning, _ = self.done[agent, event.name][-1]
        self.done[agent, event.name][-1] = (beginning, self.now)
        for who, other in list(self.stays.items()):
            takes_part = event.is_shared and other.event == event.name and other.place == stay.place
            if who == agent or takes_part:
                came = other.came if who == agent else self.now
                self.stays[who] = Stay(other.place, self.now, rested=self.now, came=came)

    def may_stop(self, agent: str, name: str) -> bool:
        """Whether it is busy with the event and may break it off."""
        return self.stays[agent].event == name and self.stays[agent].doer and self.events[name].may_stop

    def stop(self, agent: str) -> None:
        """It breaks off what it is busy with: that has begun, and not happened."""
        stay = self.stays[agent]
        assert self.events[stay.event].may_stop and self.now - stay.since > float(self.scenario.rest) - 1e-9
        self._leave(agent)

    def _leave(self, agent: str) -> None:
        """It is busy no more with what has not happened."""
        stay = self.stays[agent]
        beginning, _ = self.done[agent, stay.event][-1]
        self.done[agent, stay.event][-1] = (beginning, NEVER)
        for key in self._bound(agent, stay.event):
            self.rounds[key].remove(stay.event)  # a rule names it once
        self.stays[agent] = Stay(stay.place, self.now, rested=self.now, came=stay.came)

    def _advance(self, agent: str, event: str, symbol: str) -> None:
        for key in self._bound(agent, event):
            rest = after(self._rest(key), symbol)
            assert rest is not None, (key, symbol)
            self.rounds[key] = [*self.rounds.get(key, ()), symbol] if rest else []

    def _set_states(self, event: str) -> None:
        for state in self.scenario.states:
            for value, refs in ((True, state.true_if), (False, state.false_if)):
                if event in {ref.name for ref in refs}:
                    self.states[state.name] = value
                    self.shown.pop(state.name, None)
