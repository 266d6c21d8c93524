"""Rules: from nested `before`, `or` and `and` to a cyclic automaton that listens to its events.

Names as the original has them. A part of a rule is known by its way down from the top, f(irst) or s(econd) at each
level: `fs` is the second part of the first part. A `before` has one location between its two parts, called
`<rule><depth><way>`; an event that lasts has one while it is done, called after the part that it belongs to. Locations
are listed, and numbered, in the order in which the rule text passes them.

The original has no `and`. Its automaton is the product of those of its two parts, each of which goes on by itself:
the location in which the first one has passed i of its locations and the second one j is called
`<rule><depth><way>_<i>_<j>`.

Events that can happen a limited number of times, and those in parts, are counted by automata like a rule's. In a rule
for each robot every agent has a turn of its own: a channel does not say who sends on it, so the agent's own edges test
and set the number of its turn, an edge for each turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import product
from types import MappingProxyType
from typing import AbstractSet, Dict, Iterable, Iterator, List, Mapping, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Both, Choice, Event, Ref, Rule, RuleBody, Scenario, Sequence
from pursue_gen.tga.network import Automaton, Edge, Location, Sync, Test

Turns = Mapping[str, Tuple[int, ...]]
"""For each channel that a rule names: the numbers of the locations at which it is that channel's turn."""

_Step = Tuple[str, str, str]
"""Source, target, channel."""


def rule_of(rule: Rule, events: Iterable[Event]) -> Tuple[Automaton, Turns]:
    """The automaton of a rule about some of these events, and whose turn is when."""
    lasting = {event.name: names.leaves_off(event) for event in events if event.duration is not None}
    return rule_automaton(rule, lasting.keys(), lasting)


def rule_automaton(
    rule: Rule, lasting: AbstractSet[str], back: Mapping[str, Iterable[str]] = MappingProxyType({})
) -> Tuple[Automaton, Turns]:
    """The automaton of a rule, and whose turn is when. `lasting` holds the events that have a duration; `back` by event
    the channels on which it ends and has not happened: they lead back to where it has begun."""
    initial = f"{rule.name}_initial_location"
    layout = _Layout(rule.name, lasting, back, [initial], [])
    layout.lay(rule.body, "", initial, initial)
    numbers = {name: number for number, name in enumerate(layout.locations)}
    edges = tuple(
        Edge(source, target, sync=Sync(channel, sends=False), assign=((names.rule_turn(rule.name), numbers[target]),))
        for source, target, channel in layout.steps
    )
    turns: Dict[str, List[int]] = {}
    for source, _, channel in layout.steps:
        numbers_of_turn = turns.setdefault(channel, [])
        if numbers[source] not in numbers_of_turn:
            numbers_of_turn.append(numbers[source])
    locations = tuple(Location(name, named=False) for name in layout.locations)
    automaton = Automaton(names.rule(rule.name), locations, initial, edges)
    return automaton, {channel: tuple(sorted(numbers)) for channel, numbers in turns.items()}


@dataclass
class _Layout:
    """The locations and steps of a rule, in the order of its text."""

    rule: str
    lasting: AbstractSet[str]
    back: Mapping[str, Iterable[str]]
    locations: List[str]
    steps: List[_Step]

    def lay(self, body: RuleBody, way: str, source: str, target: str) -> None:
        """Adds what leads from source to target through that part of the rule."""
        if isinstance(body, Ref):
            self._event(body.name, way, source, target)
        elif isinstance(body, Choice):
            self.lay(body.first, way + "f", source, target)
            self.lay(body.second, way + "s", source, target)
        elif isinstance(body, Both):
            self._both(body, way, source, target)
        else:
            self._sequence(body, way, source, target)

    def _sequence(self, body: Sequence, way: str, source: str, target: str) -> None:
        between = self._part(way)
        self.lay(body.first, way + "f", source, between)
        self.locations.append(between)
        self.lay(body.second, way + "s", between, target)

    def _both(self, body: Both, way: str, source: str, target: str) -> None:
        first, second = (self._apart(part, way + side) for part, side in ((body.first, "f"), (body.second, "s")))
        last = len(first.locations) - 1, len(second.locations) - 1
        corners = {(0, 0): source, last: target}

        def at(i: int, j: int) -> str:
            return corners.get((i, j), f"{self._part(way)}_{i}_{j}")

        places = list(product(range(last[0] + 1), range(last[1] + 1)))
        self.locations += [at(*place) for place in places if place not in corners]
        rows, columns = first.onward(), second.onward()
        for i, j in places:
            self.steps += [(at(i, j), at(k, j), channel) for k, channel in rows[i]]
            self.steps += [(at(i, j), at(i, k), channel) for k, channel in columns[j]]

    def _apart(self, body: RuleBody, way: str) -> _Layout:
        """That part of the rule alone: its first location is the first one of its list, its last one the last one."""
        source, target = f"{self._part(way)}_first", f"{self._part(way)}_last"
        part = _Layout(self.rule, self.lasting, self.back, [source], [])
        part.lay(body, way, source, target)
        part.locations.append(target)
        return part

    def onward(self) -> List[List[Tuple[int, str]]]:
        """For each location, by number, where it leads and on which channel."""
        numbers = {name: number for number, name in enumerate(self.locations)}
        result: List[List[Tuple[int, str]]] = [[] for _ in self.locations]
        for source, target, channel in self.steps:
            result[numbers[source]].append((numbers[target], channel))
        return result

    def _event(self, event: str, way: str, source: str, target: str) -> None:
        if event not in self.lasting:
            self.steps.append((source, target, names.event(event)))
            return
        while_doing = f"{self._leaf(way)}_doing_{event}"
        self.locations.append(while_doing)
        self.steps += [(source, while_doing, names.event(event)), (while_doing, target, names.done(event))]
        self.steps += [(while_doing, source, channel) for channel in self.back.get(event, ())]

    def _part(self, way: str) -> str:
        return f"{self.rule}{len(way)}{way}"

    def _leaf(self, way: str) -> str:
        """An event's place in the part above it: `0f`, `0s` under the top, `…_fir`, `…_sec` under any other."""
        if len(way) < 2:
            return f"{self.rule}0{way}"
        return f"{self._part(way[:-1])}_{'fir' if way[-1] == 'f' else 'sec'}"


def counted(scenario: Scenario) -> Iterator[Tuple[Event, int]]:
    """The events with a limit, and the limit."""
    return ((event, event.at_most) for event in scenario.events if event.at_most is not None)


def split(scenario: Scenario) -> Iterator[Tuple[Event, int]]:
    """The events in parts, and in how many."""
    return ((event, event.split) for event in scenario.events if event.split is not None)


def count_automaton(event: Event, most: int) -> Tuple[Automaton, Turns]:
    """The automaton that counts an event, and at which counts it can happen; like a rule that has no next round."""
    name = names.count(event.name)
    places = [f"{name}_{number}" for number in range(most + 1)]
    happens = names.has_happened(event) if event.split else names.event(event.name)  # a part that begins is no time
    counts, times = Sync(happens, sends=False), names.times(event.name)
    edges = tuple(
        Edge(before, after, sync=counts, assign=((times, number),))
        for number, (before, after) in enumerate(zip(places, places[1:]), start=1)
    )
    locations = tuple(Location(place, named=False) for place in places)
    return Automaton(name, locations, places[0], edges), {event.name: tuple(range(most))}


def parts_automaton(event: Event, parts: int) -> Tuple[Automaton, Turns]:
    """The automaton that counts the parts of an event that are done, and which of its ends is next at which number."""
    name, variable = names.parts(event.name), names.parts_done(event.name)
    places = [f"{name}_{number}" for number in range(parts)]
    part, last = names.part_done(event.name), names.done(event.name)
    edges = [
        Edge(before, after, sync=Sync(part, sends=False), assign=((variable, number),))
        for number, (before, after) in enumerate(zip(places, places[1:]), start=1)
    ]
    edges.append(Edge(places[-1], places[0], sync=Sync(last, sends=False), assign=((variable, 0),)))
    locations = tuple(Location(place, named=False) for place in places)
    turns: Turns = {part: tuple(range(parts - 1)), last: (parts - 1,)}
    return Automaton(name, locations, places[0], tuple(edges)), turns


@dataclass(frozen=True)
class OwnTurn:
    """An agent's turn in a rule. `variable` holds the number of a location of `order`, which is no automaton of the
    network: it says what leads from one number to the next. `shown`: what people read for the agent.
    """

    rule: Rule
    agent: str
    shown: str
    variable: str
    order: Automaton

    @property
    def name(self) -> str:
        """What people call it."""
        return f"{self.rule.name} of {self.shown}"


def own_turns(scenario: Scenario) -> Iterator[OwnTurn]:
    """The turns of all agents in rules for each of them, in the order of the rules."""
    for rule in scenario.rules:
        for agent in scenario.bound_by(rule):
            order, _ = rule_of(rule, scenario.events)
            yield OwnTurn(rule, agent.name, agent.shown, names.own_turn(rule.name, agent.name), order)


def bound(automaton: Automaton, turns: Tuple[OwnTurn, ...]) -> Automaton:
    """The automaton of an agent that keeps to its turns; those of other agents change nothing."""
    for turn in (turn for turn in turns if turn.agent == automaton.name):
        automaton = automaton.with_each(partial(_in_turn, turn))
    return automaton


def _in_turn(turn: OwnTurn, edge: Edge) -> List[Edge]:
    """The edge, once for each number at which it is its turn; alone where the rule does not name what it does."""
    steps = [] if edge.sent is None else _steps(turn, edge.sent)
    return [edge.plus((Test(turn.variable, now),), assign=((turn.variable, then),)) for now, then in steps] or [edge]


def _steps(turn: OwnTurn, channel: str) -> List[Tuple[int, int]]:
    """From which number to which one the channel leads."""
    numbers = {location.name: number for number, location in enumerate(turn.order.locations)}
    steps = (edge for edge in turn.order.edges if edge.channel == channel)
    return [(numbers[step.source], numbers[step.target]) for step in steps]
