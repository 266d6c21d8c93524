"""Duties: places that some robot must be able to reach in time, because the environment can require it at any moment.

A duty of a promise is what some robot must do within a time from a moment that the environment chooses: an answer to
somebody who may call, or to be at a place before a person who walks there. A robot covers the duty from where it is in
time in the worst case, each movement and action taking as long as it may. In all else robots are better off here than
in the game: they know at once what is required, and need no rest before they set off. So where the duties cannot all be
covered, something is lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import product
from typing import AbstractSet, Collection, Dict, FrozenSet, List, Mapping, Optional, Sequence, Set, Tuple, Union

from pursue_gen.language.numbers import Number
from pursue_gen.solving.distances import distances_to, times_to
from pursue_gen.synthesis.strategy import Place
from pursue_gen.tga.ends import has_to_come, is_agent, is_nobodys
from pursue_gen.tga.network import Automaton, Edge, Network, Test

Standing = Mapping[str, str]
"""Of each agent whom nobody controls the place at which it is."""

_NOW = "now"
"""Where a way ends in `_soonest`."""


@dataclass(frozen=True)
class Duty:
    """A promise's requirement that some robot is near. `times`: for each robot, from each of its locations, how long it
    takes at least in the worst case; `within`: how long it may take; `ends`: the channels of what meets it."""

    promise: Place
    within: Number
    times: Mapping[str, Mapping[str, Number]]
    ends: FrozenSet[str] = frozenset()

    def covered_from(self, robot: str, location: str) -> bool:
        """True if the robot may be in time from there."""
        return self.times.get(robot, {}).get(location, math.inf) <= self.within


class Duties:
    """The duties of some promises, places to be avoided, for robots whose ends the environment chooses."""

    def __init__(self, network: Network, bad: Collection[Place], robots: Sequence[str]) -> None:
        self._found: List[Union[_Answers, _Presence]] = []
        for place in bad:
            watched = _watched(network.automaton(place[0]), place)
            if watched is not None:
                found = _answers(network, watched, robots) or _presence(network, watched, robots)
                self._found += [] if found is None else [found]

    def at(self, standing: Standing) -> List[Duty]:
        """The duties while those whom nobody controls are where they stand."""
        return [duty for duty in (each.at(standing) for each in self._found) if duty is not None]


def can_be_covered(duties: Sequence[Duty], robots: Mapping[str, Sequence[str]]) -> bool:
    """True if each of the robots can be at one of these locations of its own so that all duties are covered."""
    options = {
        robot: _largest(
            {frozenset(k for k, duty in enumerate(duties) if duty.covered_from(robot, at)) for at in places}
        )
        for robot, places in robots.items()
    }
    return _covers(frozenset(range(len(duties))), options)


def are_reported(network: Network, robots: Sequence[str]) -> bool:
    """True if the environment chooses when what these robots do ends."""
    return not any(edge.is_end and edge.controllable for name in robots for edge in network.automaton(name).edges)


def at_home(network: Network) -> Dict[str, str]:
    """The agents whom nobody controls that may be for ever where they begin, and these places."""
    agents = (each for each in network.automata if is_nobodys(each) and not has_to_come(each))
    return {agent.name: agent.initial for agent in agents if agent.initial not in agent.stays}


def begins(automaton: Automaton, channels: AbstractSet[str]) -> List[Edge]:
    """The commands by which a robot begins a movement or action that ends on one of these channels."""
    doing = {edge.source for edge in automaton.edges if edge.sent in channels}
    return [edge for edge in automaton.edges if edge.target in doing and edge.source not in doing]


def _largest(sets: Set[FrozenSet[int]]) -> List[FrozenSet[int]]:
    return [some for some in sets if not any(some < other for other in sets)]


def _covers(wanted: FrozenSet[int], options: Mapping[str, Sequence[FrozenSet[int]]]) -> bool:
    if not wanted:
        return True
    first = min(wanted)
    return any(
        _covers(wanted - some, {name: sets for name, sets in options.items() if name != robot})
        for robot, choices in options.items()
        for some in choices
        if first in some
    )


@dataclass(frozen=True)
class _Watched:
    """What watches a promise: it is `calm` until one of the `entries`, and then has to leave by one of the `exits`
    within a time."""

    promise: Place
    calm: FrozenSet[str]
    within: Number
    entries: Sequence[Edge]
    exits: Sequence[Edge]


def _watched(automaton: Automaton, promise: Place) -> Optional[_Watched]:
    bounds = automaton.stays
    if len(bounds) > 1 or any(len(some) > 1 for some in bounds.values()):
        return None
    urgent = next(iter(bounds), promise[1])
    ends = (urgent, promise[1])
    calm = frozenset(place.name for place in automaton.locations if place.name not in ends)
    entries = [edge for edge in automaton.edges if edge.source in calm and edge.target == urgent]
    clock = {bound.clock for some in bounds.values() for bound in some}
    others = (edge for edge in automaton.edges if edge not in entries and not clock.isdisjoint(edge.resets))
    starts = {edge.source for edge in entries} == calm and all(clock.issubset(edge.resets) for edge in entries)
    if not starts or any(edge.guard.clocks for edge in entries) or any(edge.target in ends for edge in others):
        return None
    exits = [edge for edge in automaton.edges if edge.source == urgent and edge.target not in ends]
    return _Watched(promise, calm, bounds[urgent][0].bound if bounds else 0, entries, exits)


@dataclass(frozen=True)
class _Answers:
    """Somebody may call, and has to be answered. `rests`: of who may call where, how long it rests before."""

    duty: Duty
    rests: Mapping[Tuple[str, str], Number]

    def at(self, standing: Standing) -> Optional[Duty]:
        """The duty where somebody who stands there may call."""
        some = [rest for caller, rest in self.rests.items() if caller in standing.items()]
        return replace(self.duty, within=self.duty.within + min(some)) if some else None


def _answers(network: Network, watched: _Watched, robots: Sequence[str]) -> Optional[_Answers]:
    called = {edge.channel or "" for edge in watched.entries}
    ends = frozenset(edge.channel or "" for edge in watched.exits)
    watching = network.automaton(watched.promise[0])
    hearing = [edge for edge in watching.edges if edge.channel in called]
    if len(called) > 1 or called & ends or "" in ends:
        return None
    if any(e.source in watched.calm and (e not in watched.entries or e.guard.integers) for e in hearing):
        return None
    heard = [(name, edge) for name, edge in network.edges if edge.channel in ends]
    if any((edge.sent is not None) != (name in robots) for name, edge in heard if edge.sent or name in robots):
        return None  # others have a part in it
    doing = {robot: {edge.source for name, edge in heard if name == robot} for robot in robots}
    times = {robot: _times(network.automaton(robot), some, True) for robot, some in doing.items()}
    rests = _callers(network, watched, called)
    return _Answers(Duty(watched.promise, watched.within, times, ends), rests) if rests else None


def _callers(network: Network, watched: _Watched, called: Collection[str]) -> Dict[Tuple[str, str], Number]:
    """Who may call where, whenever nobody waits, and how long they rest before."""
    found: Dict[Tuple[str, str], Number] = {}
    for name, edge in network.edges:
        free = is_free(replace(edge, guard=replace(edge.guard, integers=())))
        calls = edge.source == edge.target and edge.sent in called
        if free and calls and all(_holds_while_calm(network, watched, clause) for clause in edge.guard.integers):
            found[name, edge.source] = edge.guard.since
    return found


def _holds_while_calm(network: Network, watched: _Watched, clause: Sequence[Test]) -> bool:
    """True if the clause, about the turns of one rule, holds whenever nobody waits for what the promise is about."""
    names = {test.variable for test in clause}
    rules = [automaton for automaton in network.automata if not names.isdisjoint(automaton.assigned)]
    if len(names) != 1 or len(rules) != 1 or any(edge.received is None for edge in rules[0].edges):
        return False
    (name,), (rule,), watching = names, rules, network.automaton(watched.promise[0])
    values = {rule.initial: dict(network.variables)[name]}
    values.update((edge.target, dict(edge.assign)[name]) for edge in rule.edges)
    sending: Dict[Optional[str], Set[int]] = {}
    for channel, some in network.senders.items():
        for _, edge in some:
            about = [{t.value for t in c} for c in edge.guard.integers if all(t.variable == name for t in c)]
            sending.setdefault(channel, set()).update(set(values.values()).intersection(*about))
    start = (watching.initial, rule.initial)
    met, left = {start}, [start]
    while left:
        here = left.pop()
        if here[0] in watched.calm and values[here[1]] not in {test.value for test in clause}:
            return False
        for channel, turns in sending.items():
            if values[here[1]] in turns:
                steps = product(_after(watching, here[0], channel), _after(rule, here[1], channel))
                new = [there for there in steps if there not in met]
                met.update(new)
                left += new
    return True


def _after(automaton: Automaton, place: str, channel: Optional[str]) -> List[str]:
    """Where an automaton may be after somebody sent on the channel."""
    heard = [e for e in automaton.edges if e.source == place and e.channel == channel]
    sure = any(not edge.guard.integers and not edge.guard.clocks for edge in heard)
    return [*(edge.target for edge in heard), *(() if sure else (place,))]


@dataclass(frozen=True)
class _Presence:
    """Somebody may come to a place, and a robot has to be there by then, or soon after. `walks`: for each person, how
    soon it comes from where it stands, and the duty that follows."""

    walks: Sequence[Tuple[str, Mapping[str, Number], Duty]]

    def at(self, standing: Standing) -> Optional[Duty]:
        """The duty to be there before the first of those who can come from where they stand."""
        walks = [(walk[standing[name]], duty) for name, walk, duty in self.walks if standing.get(name) in walk]
        if not walks:
            return None
        soonest, duty = min(walks, key=lambda each: each[0])
        return replace(duty, within=soonest + duty.within)


def _presence(network: Network, watched: _Watched, robots: Sequence[str]) -> Optional[_Presence]:
    if len(watched.calm) != 1 or any(edge.sync is not None or edge.controllable for edge in watched.entries):
        return None
    found = []
    for person in (a for a in network.automata if a.name not in robots and is_agent(a)):
        for entry in watched.entries:
            about = [c for c in entry.guard.integers if any(test.variable in person.assigned for test in c)]
            there = _present(network, robots, [clause for clause in entry.guard.integers if clause not in about])
            if len(about) == 1 and there is not None and _ends_there(network, watched.exits, there):
                times = {robot: _times(network.automaton(robot), some, False) for robot, some in there.items()}
                found.append((person.name, _soonest(person, about[0]), Duty(watched.promise, watched.within, times)))
    return _Presence(found) if found else None


def _soonest(person: Automaton, wanted: Sequence[Test]) -> Dict[str, Number]:
    """How soon somebody who has just come to a place can make one of the tests hold, from where that can be."""
    goals = {(test.variable, test.value) for test in wanted}
    back: Dict[str, List[Tuple[str, Number]]] = {}
    for edge in person.edges:
        there = bool(goals.intersection(edge.assign))
        if there:
            back.setdefault(_NOW, []).append((edge.target, 0))
        if is_free(edge):
            back.setdefault(_NOW if there else edge.target, []).append((edge.source, edge.guard.since))
    return distances_to([_NOW], back)


def is_free(edge: Edge) -> bool:
    """True if nobody can keep an agent whom nobody controls from the edge, and it need not be in time for it."""
    late = all(bound.op in (">", ">=") for bound in edge.guard.clocks)
    return late and not edge.controllable and not edge.guard.integers and edge.received is None


def _present(
    network: Network, robots: Sequence[str], clauses: Sequence[Sequence[Test]]
) -> Optional[Dict[str, AbstractSet[str]]]:
    """Of each robot the locations at which one of the clauses does not hold; None where others matter as well."""
    found: Dict[str, AbstractSet[str]] = {}
    for clause in clauses:
        values = {(test.variable, test.value) for test in clause}
        names = {variable for variable, _ in values}
        owner = next((r for r in robots if not names.isdisjoint(network.automaton(r).assigned)), None)
        if len(names) != 1 or owner is None or owner in found:
            return None
        edges = network.automaton(owner).edges
        found[owner] = {e.target for e in edges for each in e.assign if each[0] in names and each not in values}
    return found


def _ends_there(network: Network, exits: Sequence[Edge], there: Mapping[str, AbstractSet[str]]) -> bool:
    """True if nothing ends what is urgent but that one of these robots is there."""
    elsewhere = {e.sent for name, e in network.edges if e.sent is not None and e.target not in there.get(name, ())}
    present = {each for name, e in network.edges if e.target in there.get(name, ()) for each in e.assign}

    def is_there(edge: Edge) -> bool:
        clauses = ({(test.variable, test.value) for test in clause} for clause in edge.guard.integers)
        return any(clause <= present for clause in clauses)

    return all(e.sync is not None and (e.sync.channel not in elsewhere or is_there(e)) for e in exits)


def _times(automaton: Automaton, goals: AbstractSet[str], to_the_end: bool) -> Dict[str, Number]:
    """How long a robot takes at most to be at one of these locations, or to their ends, from each location into which
    it has just come; from where it may stay it sets off at once."""
    found: Dict[str, Number] = {}
    for goal in goals:
        last: Number = automaton.longest.get(goal, 0) if to_the_end else 0
        for location, takes in times_to([goal], automaton).items():
            found[location] = min(found.get(location, takes + last), takes + last)
    rested = {
        place: min((found[e.target] for e in automaton.edges if e.source == place and e.target in found), default=None)
        for place in automaton.lasting
    }
    here = {place: 0 for place in automaton.lasting if place in goals and not to_the_end}
    return {**found, **{place: takes for place, takes in rested.items() if takes is not None}, **here}
