"""Rules: from nested `before` and `or` to a cyclic automaton that listens to its events.

Names as the original has them. A part of a rule is known by its way down from the top, f(irst) or s(econd) at each
level: `fs` is the second part of the first part. A `before` has one location between its two parts, called
`<rule><depth><way>`; an event that lasts has one while it is done, called after the part that it belongs to. Locations
are listed, and numbered, in the order in which the rule text passes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import AbstractSet, Dict, List, Mapping, Tuple

from pursue_gen.language.scenario import Choice, Ref, Rule, RuleBody, Sequence
from pursue_gen.tga.names import done, rule_turn
from pursue_gen.tga.network import Automaton, Edge, Location, Sync

Turns = Mapping[str, Tuple[int, ...]]
"""For each channel that a rule names: the numbers of the locations at which it is that channel's turn."""

_Step = Tuple[str, str, str]
"""Source, target, channel."""


def rule_automaton(rule: Rule, lasting: AbstractSet[str]) -> Tuple[Automaton, Turns]:
    """The automaton of a rule, and whose turn is when. `lasting` holds the events that have a duration."""
    initial = f"{rule.name}_initial_location"
    layout = _Layout(rule.name, lasting, [initial], [])
    layout.lay(rule.body, "", initial, initial)
    numbers = {name: number for number, name in enumerate(layout.locations)}
    edges = tuple(
        Edge(source, target, sync=Sync(channel, sends=False), assign=((rule_turn(rule.name), numbers[target]),))
        for source, target, channel in layout.steps
    )
    turns: Dict[str, List[int]] = {}
    for source, _, channel in layout.steps:
        numbers_of_turn = turns.setdefault(channel, [])
        if numbers[source] not in numbers_of_turn:
            numbers_of_turn.append(numbers[source])
    locations = tuple(Location(name, named=False) for name in layout.locations)
    automaton = Automaton(rule.name, locations, initial, edges)
    return automaton, {channel: tuple(sorted(numbers)) for channel, numbers in turns.items()}


@dataclass
class _Layout:
    """The locations and steps of a rule, in the order of its text."""

    rule: str
    lasting: AbstractSet[str]
    locations: List[str]
    steps: List[_Step]

    def lay(self, body: RuleBody, way: str, source: str, target: str) -> None:
        """Adds what leads from source to target through that part of the rule."""
        if isinstance(body, Ref):
            self._event(body.name, way, source, target)
        elif isinstance(body, Choice):
            self.lay(body.first, way + "f", source, target)
            self.lay(body.second, way + "s", source, target)
        else:
            self._sequence(body, way, source, target)

    def _sequence(self, body: Sequence, way: str, source: str, target: str) -> None:
        between = self._part(way)
        self.lay(body.first, way + "f", source, between)
        self.locations.append(between)
        self.lay(body.second, way + "s", between, target)

    def _event(self, event: str, way: str, source: str, target: str) -> None:
        if event not in self.lasting:
            self.steps.append((source, target, event))
            return
        while_doing = f"{self._leaf(way)}_doing_{event}"
        self.locations.append(while_doing)
        self.steps += [(source, while_doing, event), (while_doing, target, done(event))]

    def _part(self, way: str) -> str:
        return f"{self.rule}{len(way)}{way}"

    def _leaf(self, way: str) -> str:
        """An event's place in the part above it: `0f`, `0s` under the top, `…_fir`, `…_sec` under any other."""
        if len(way) < 2:
            return f"{self.rule}0{way}"
        return f"{self._part(way[:-1])}_{'fir' if way[-1] == 'f' else 'sec'}"
