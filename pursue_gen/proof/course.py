"""The course of a play without choices: its events, and which of them come before which.

Robots that pass places in an order do the same things whatever the delays are; only robots that do not wait for each
other may do them in another order. Then one set of events with a partial order describes all plays. Every automaton and
every variable has a chain of states, each begun by an event and ended by the next one of the chain. Two states can hold
at the same time if and only if neither ends before the other begins, and several if each two of them can (Winskel,
"Event structures", 1987; Nielsen, Plotkin, Winskel, "Petri nets, event structures and domains", 1981).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Dict, Iterable, Iterator, List, Mapping, Optional, Sequence, Tuple, Union

from pursue_gen.tga.network import Edge, Guard

Value = Union[str, int]
"""The location of an automaton, or what a variable is."""

Stay = Tuple[str, int]
"""An automaton or a variable, and the number of a state in its chain."""

START = -1
"""Begins the first state of each chain."""


@dataclass(frozen=True)
class Event:
    """A joint move: the sender's edge (or one of its own) and those of all that receive it.

    `needs`: the states without which it cannot happen; `ends`: those that it ends, its sender's among them; `resets`:
    clocks; `block`: the number of the block that commands it, None for a move of the environment.
    """

    sender: str
    edge: Edge
    receivers: Tuple[Tuple[str, Edge], ...]
    needs: Mapping[str, int]
    ends: Mapping[str, int]
    resets: Tuple[str, ...]
    block: Optional[int]


class Course:
    """The events so far, each after those that it needs, and the chains of states."""

    def __init__(self, start: Mapping[str, Value]) -> None:
        self.events: List[Event] = []
        self.values: Dict[str, List[Value]] = {name: [value] for name, value in start.items()}
        self._begun: Dict[str, List[int]] = {name: [START] for name in start}
        self._where: Dict[Tuple[str, Value], List[int]] = {(name, value): [0] for name, value in start.items()}
        self._down: List[int] = []

    def now(self, name: str) -> Value:
        """Where an automaton is, or what a variable is, after all events so far."""
        return self.values[name][-1]

    def last(self, name: str) -> int:
        """The number of that state."""
        return len(self.values[name]) - 1

    def holds(self, guard: Guard) -> bool:
        """True if the guard's tests of variables hold after all events so far."""
        return all(any(self.now(test.variable) == test.value for test in clause) for clause in guard.integers)

    def add(self, event: Event, changed: Mapping[str, Value]) -> None:
        """Adds an event; `changed`: what begins with it, for each state that it ends.

        Requires that it is possible now: no state that it needs, or ends, has ended.
        """
        assert all(self.last(name) == state for name, state in event.needs.items())
        number = len(self.events)
        down = 1 << number
        for stay in event.needs.items():
            begin = self.begin(stay)
            down |= self._down[begin] if begin != START else 0
        self.events.append(event)
        self._down.append(down)
        for name, value in changed.items():
            self._where.setdefault((name, value), []).append(len(self.values[name]))
            self.values[name].append(value)
            self._begun[name].append(number)

    def stays(self, name: str, value: Value) -> Sequence[int]:
        """The numbers of the states of this automaton or variable with this value."""
        return self._where.get((name, value), ())

    def begin(self, stay: Stay) -> int:
        """The event that begins a state."""
        return self._begun[stay[0]][stay[1]]

    def end(self, stay: Stay) -> Optional[int]:
        """The event that ends a state; None for the last one. Requires a state of the course."""
        begun = self._begun[stay[0]]
        return begun[stay[1] + 1] if stay[1] + 1 < len(begun) else None

    def is_before(self, one: int, other: int) -> bool:
        """True if `other` cannot happen unless `one` has happened, or is the same event."""
        return one == START or (other != START and bool(self._down[other] >> one & 1))

    def down(self, event: int) -> int:
        """The events without which this one cannot happen, and itself, as the bits of a number."""
        return self._down[event]

    def is_bounded(self, first: int, second: int, last: int) -> bool:
        """True if each event whose number is from `first` on and below `second` is before each one from `last` on that
        happens to the same agents, or to others that have to do with them."""
        moving = {name for event in self.events for name in event.ends}
        group: Dict[str, str] = {name: name for name in moving}

        def root(name: str) -> str:
            while group[name] != name:
                group[name] = group[group[name]]
                name = group[name]
            return name

        for event in self.events:
            for name in moving.intersection((*event.needs, *event.ends)):
                group[root(name)] = root(event.sender)
        before: Dict[str, int] = {}
        for number in range(first, second):
            team = root(self.events[number].sender)
            before[team] = before.get(team, 0) | 1 << number
        later = ((number, root(self.events[number].sender)) for number in range(last, len(self.events)))
        return all(before.get(team, 0) & ~self._down[number] == 0 for number, team in later)

    def may_meet(self, one: Stay, other: Stay) -> bool:
        """True if the two states can hold at the same time."""
        if one[0] == other[0]:
            return one[1] == other[1]
        end, other_end = self.end(one), self.end(other)
        if end is not None and self.is_before(end, self.begin(other)):
            return False
        return other_end is None or not self.is_before(other_end, self.begin(one))

    def may_all_meet(self, stay: Stay, others: Iterable[Stay]) -> bool:
        """True if the state can hold together with each of the others."""
        return all(self.may_meet(stay, other) for other in others)

    def tested(self, guard: Guard) -> List[List[Stay]]:
        """For each clause of a guard the states in which it holds."""
        return [
            [(test.variable, k) for test in clause for k in self.stays(test.variable, test.value)]
            for clause in guard.integers
        ]

    def meetings(self, choices: Sequence[Sequence[Stay]], known: Tuple[Stay, ...] = ()) -> Iterator[Tuple[Stay, ...]]:
        """All choices of one state of each set so that these, and what is known, can hold at the same time."""
        if not choices:
            yield known
            return
        for stay in choices[0]:
            if self.may_all_meet(stay, known):
                yield from self.meetings(choices[1:], (*known, stay))
