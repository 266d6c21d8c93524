"""Rules: from nested `before`, `or` and `and` to a cyclic automaton that listens to its events.

Names as the original has them. A part of a rule is known by its way down from the top, f(irst) or s(econd) at each
level: `fs` is the second part of the first part. A `before` has one location between its two parts, called
`<rule><depth><way>`; an event that lasts has one while it is done, called after the part that it belongs to. Locations
are listed, and numbered, in the order in which the rule text passes them.

The original has no `and`. Its automaton is the product of those of its two parts, each of which goes on by itself:
the location in which the first one has passed i of its locations and the second one j is called
`<rule><depth><way>_<i>_<j>`.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from types import MappingProxyType
from typing import AbstractSet, Dict, Iterable, List, Mapping, Tuple

from pursue_gen.language import network_names as names
from pursue_gen.language.scenario import Both, Choice, Event, Ref, Rule, RuleBody, Sequence
from pursue_gen.tga.network import Automaton, Edge, Location, Sync

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
