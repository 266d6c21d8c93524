"""The value of the translation stage: a network of timed game automata over broadcast channels, and an objective.

Clocks start at 0, unless the network says otherwise, and count time units. Integer variables carry what guards read.
See the design of the game: one sending (or channel-less) edge moves, and with it every automaton that has an enabled
receiving edge on that channel.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from functools import cached_property
from typing import AbstractSet, Callable, Dict, FrozenSet, Iterable, List, Mapping, Optional, Sequence, Set, Tuple

from pursue_gen.language.numbers import Number
from pursue_gen.language.symbols import UNDER_WAY, Role, role_of


@dataclass(frozen=True)
class ClockBound:
    """`clock op bound`, op one of < <= > >= ==, bound in time units; a whole one is an int."""

    clock: str
    op: str
    bound: Number


@dataclass(frozen=True)
class Constraint:
    """`left - right < bound` (strict) or `<= bound`, exact, in time units; left or right None is the constant 0 (never
    both).

    So `C <= 5` is (C, None, 5, False) and `1 < C` is (None, C, -1, True).
    """

    left: Optional[str]
    right: Optional[str]
    bound: Fraction
    strict: bool


@dataclass(frozen=True)
class Test:
    """`variable == value`."""

    variable: str
    value: int

    __test__ = False  # not a test case, whatever pytest thinks of the name


Clause = Tuple[Test, ...]
"""Any of these tests."""


@dataclass(frozen=True)
class Guard:
    """All of the clock bounds, and of each clause at least one test. The empty guard is true."""

    clocks: Tuple[ClockBound, ...] = ()
    integers: Tuple[Clause, ...] = ()

    def holds(self, values: Mapping[str, object]) -> bool:
        """True if the tests hold of these values of variables, whatever the clocks are."""
        return all(any(values.get(test.variable) == test.value for test in clause) for clause in self.integers)

    def may_hold(self, values: Mapping[str, object]) -> bool:
        """True if the tests may hold where the other variables can have any value."""
        return all(any(values.get(test.variable, test.value) == test.value for test in some) for some in self.integers)

    @property
    def since(self) -> Number:
        """The largest lower bound of a clock: how long it makes one wait at most; 0 for none."""
        return max((bound.bound for bound in self.clocks if bound.op in (">", ">=")), default=0)


@dataclass(frozen=True)
class Sync:
    """`channel!` (sends) or `channel?`.

    `heard`: a sender's move that changes nothing but where the sender is, and its clocks, is no move at all.
    """

    channel: str
    sends: bool
    heard: bool = False


@dataclass(frozen=True)
class Edge:
    """An edge of an automaton; `assign` sets integer variables, `resets` sets clocks to 0.

    `sync` None is a step of its own (tau).
    """

    source: str
    target: str
    guard: Guard = Guard()
    sync: Optional[Sync] = None
    assign: Tuple[Tuple[str, int], ...] = ()
    resets: Tuple[str, ...] = ()
    controllable: bool = True

    def __hash__(self) -> int:
        return self._hash  # sets of edges are looked up very often

    def __getstate__(self) -> Dict[str, object]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # texts hash otherwise in each process

    @cached_property
    def _hash(self) -> int:
        return hash((self.source, self.target, self.guard, self.sync, self.assign, self.resets, self.controllable))

    @property
    def leaves(self) -> Role:
        """The role of its source."""
        return role_of(self.source)

    @property
    def enters(self) -> Role:
        """The role of its target."""
        return role_of(self.target)

    @property
    def is_end(self) -> bool:
        """True for the end of a movement or an action; not for breaking one off, which is decided."""
        return self.leaves in UNDER_WAY and self.source != self.target and not self.breaks_off

    @property
    def breaks_off(self) -> bool:
        """True where an action ends before it is done."""
        return self.leaves is Role.WORK and self.channel is not None and role_of(self.channel) is Role.BROKEN_OFF

    @property
    def sets_off(self) -> bool:
        """True for the beginning of a movement."""
        return self.enters is Role.WAY and self.source != self.target

    def plus(
        self,
        *tests: Clause,
        bounds: Tuple[ClockBound, ...] = (),
        assign: Tuple[Tuple[str, int], ...] = (),
        resets: Tuple[str, ...] = (),
    ) -> Edge:
        """The edge with these tests, bounds, assignments and resets behind its own."""
        guard = Guard((*self.guard.clocks, *bounds), (*self.guard.integers, *tests))
        return replace(self, guard=guard, assign=(*self.assign, *assign), resets=(*self.resets, *resets))

    @cached_property
    def channel(self) -> Optional[str]:
        """The channel on which it sends or receives; None for a step of its own."""
        return None if self.sync is None else self.sync.channel

    @cached_property
    def sent(self) -> Optional[str]:
        """The channel on which it sends; None where it does not."""
        return self.channel if self.sync is not None and self.sync.sends else None

    @cached_property
    def received(self) -> Optional[str]:
        """The channel on which it receives; None where it begins a move itself."""
        return None if self.sync is None or self.sync.sends else self.channel

    @property
    def is_command(self) -> bool:
        """True for the beginning of a move in the controller's hands, as far as those who receive leave it there."""
        return self.controllable and self.received is None

    @cached_property
    def tested(self) -> Tuple[str, ...]:
        """The variables that it tests, each once."""
        return tuple(dict.fromkeys(test.variable for clause in self.guard.integers for test in clause))

    @cached_property
    def variables(self) -> Tuple[str, ...]:
        """The variables that it tests or sets, each once."""
        return tuple(dict.fromkeys((*self.tested, *(name for name, _ in self.assign))))


@dataclass(frozen=True)
class Location:
    """A location; `invariant` holds upper bounds. `named` False: UPPAAL gets an id but no name (and prints `_id`)."""

    name: str
    invariant: Tuple[ClockBound, ...] = ()
    named: bool = True

    @property
    def role(self) -> Role:
        """What being there means."""
        return role_of(self.name)


@dataclass(frozen=True)
class Automaton:
    """One automaton (an agent, a rule, the states or an objective).

    `home` is its location before anything has begun, "" for the initial one: a network may start in the middle of a
    play. It only guides searches, and changes no verdict.
    """

    name: str
    locations: Tuple[Location, ...]
    initial: str
    edges: Tuple[Edge, ...]
    home: str = ""

    @cached_property
    def bounds(self) -> Tuple[ClockBound, ...]:
        """What its invariants and its guards compare clocks with."""
        stays = (bound for location in self.locations for bound in location.invariant)
        return (*stays, *(bound for edge in self.edges for bound in edge.guard.clocks))

    @cached_property
    def clocks(self) -> FrozenSet[str]:
        """The clocks that it tests or resets."""
        return frozenset({bound.clock for bound in self.bounds}.union(*(edge.resets for edge in self.edges)))

    @cached_property
    def stays(self) -> Mapping[str, Tuple[ClockBound, ...]]:
        """By location the bounds of a stay there, of those that have any."""
        return {location.name: location.invariant for location in self.locations if location.invariant}

    @cached_property
    def longest(self) -> Mapping[str, Number]:
        """By location how long a stay there lasts at most, of those that have bounds."""
        return {name: max(bound.bound for bound in bounds) for name, bounds in self.stays.items()}

    @property
    def lasting(self) -> List[str]:
        """The locations in which it may stay for ever, as far as their invariants go."""
        return [location.name for location in self.locations if not location.invariant]

    @cached_property
    def assigned(self) -> Tuple[str, ...]:
        """The variables that it sets, each once."""
        return tuple(dict.fromkeys(name for edge in self.edges for name, _ in edge.assign))

    @cached_property
    def channels(self) -> FrozenSet[str]:
        """The channels on which it sends or receives."""
        return frozenset(edge.channel for edge in self.edges if edge.channel is not None)

    def with_locations(self, changed: Callable[[Location], Location]) -> Automaton:
        """The automaton with what this makes of each of its locations."""
        return replace(self, locations=tuple(map(changed, self.locations)))

    def with_edges(self, edges: Iterable[Edge]) -> Automaton:
        """The automaton with these edges in place of its own; itself where they are the same."""
        some = tuple(edges)
        return self if some == self.edges else replace(self, edges=some)

    def with_each(self, changed: Callable[[Edge], Iterable[Edge]]) -> Automaton:
        """The automaton with what this makes of each of its edges; itself where nothing changes."""
        return self.with_edges(new for edge in self.edges for new in changed(edge))


ByChannel = Mapping[Optional[str], Sequence[Tuple[str, Edge]]]
"""By channel some edges, each with the name of its automaton; the None of steps of their own is never in it."""


@dataclass(frozen=True)
class Network:
    """Automata in system order; clocks, variables (with first values) and broadcast channels as declared.

    `start`: what is known of the clocks at the start; those that it does not name are anything >= 0. Empty: all are 0.
    An objective is met only if it is met from every valuation in there.
    """

    clocks: Tuple[str, ...]
    variables: Tuple[Tuple[str, int], ...]
    channels: Tuple[str, ...]
    automata: Tuple[Automaton, ...]
    start: Tuple[Constraint, ...] = ()

    @cached_property
    def times(self) -> FrozenSet[Number]:
        """All times that clocks are compared with."""
        bounds = (bound.bound for automaton in self.automata for bound in automaton.bounds)
        return frozenset((*bounds, *(constraint.bound for constraint in self.start)))

    @cached_property
    def largest(self) -> Mapping[str, Number]:
        """By clock the largest time that automata compare it with; 0 for none."""
        found: Dict[str, Number] = {clock: 0 for clock in self.clocks}
        for bound in (bound for automaton in self.automata for bound in automaton.bounds):
            found[bound.clock] = max(found[bound.clock], bound.bound)
        return found

    @cached_property
    def names(self) -> FrozenSet[str]:
        """The names of its automata, clocks, variables and channels: of one space, in which each stands for one."""
        variables = (name for name, _ in self.variables)
        return frozenset((*(a.name for a in self.automata), *self.clocks, *variables, *self.channels))

    @cached_property
    def edges(self) -> Tuple[Tuple[str, Edge], ...]:
        """All edges, in order, each with the name of its automaton."""
        return tuple((automaton.name, edge) for automaton in self.automata for edge in automaton.edges)

    @cached_property
    def senders(self) -> ByChannel:
        """By channel the edges that send on it, in order; channels on which nobody sends are not in it."""
        return _by_channel((edge.sent, name, edge) for name, edge in self.edges)

    @cached_property
    def receivers(self) -> ByChannel:
        """By channel the edges that receive on it, likewise."""
        return _by_channel((edge.received, name, edge) for name, edge in self.edges)

    @cached_property
    def taken_over(self) -> AbstractSet[str]:
        """The channels whose moves are the environment's because of one who receives."""
        return {edge.received for _, edge in self.edges if edge.received is not None and not edge.controllable}

    @cached_property
    def setters(self) -> Mapping[str, AbstractSet[str]]:
        """For each variable the automata that set it."""
        found: Dict[str, Set[str]] = {name: set() for name, _ in self.variables}
        for automaton in self.automata:
            for name in automaton.assigned:
                found.setdefault(name, set()).add(automaton.name)
        return found

    def with_each(self, changed: Callable[[Automaton], Automaton]) -> Network:
        """The network with what this makes of each of its automata; itself where nothing changes."""
        some = tuple(map(changed, self.automata))
        return self if some == self.automata else replace(self, automata=some)

    @cached_property
    def places(self) -> Mapping[Tuple[str, str], str]:
        """By automaton and text the name of each location, which knows its role: for those who have the text alone."""
        return {(a.name, place.name): place.name for a in self.automata for place in a.locations}

    def automaton(self, name: str) -> Automaton:
        """The automaton of that name. Raises KeyError."""
        for automaton in self.automata:
            if automaton.name == name:
                return automaton
        raise KeyError(name)


def _by_channel(edges: Iterable[Tuple[Optional[str], str, Edge]]) -> ByChannel:
    found: Dict[Optional[str], List[Tuple[str, Edge]]] = {}
    for channel, name, edge in edges:
        if channel is not None:
            found.setdefault(channel, []).append((name, edge))
    return found


class Kind(enum.Enum):
    """What the controller wants."""

    REACH = "reach"
    SAFETY = "safety"
    REACH_WHILE_SAFE = "reach-while-safe"


@dataclass(frozen=True)
class Objective:
    """`A<> goal`, `A[] not bad` or `A[ not bad U goal ]`; goal and bad are pairs (automaton, location).

    The goal is reached where all of its pairs hold at once; what is bad happens where any of its pairs holds.
    """

    kind: Kind
    goal: Tuple[Tuple[str, str], ...] = ()
    bad: Tuple[Tuple[str, str], ...] = ()

    @staticmethod
    def of(goal: Sequence[Tuple[str, str]], bad: Sequence[Tuple[str, str]]) -> Objective:
        """To reach the goal, if there is one, and to avoid what is bad, if there is anything."""
        kind = Kind.SAFETY if not goal else Kind.REACH_WHILE_SAFE if bad else Kind.REACH
        return Objective(kind, tuple(goal), tuple(bad))

    @property
    def reaches(self) -> bool:
        """True if there is a goal to reach; else what is bad is to be kept from for ever."""
        return self.kind is not Kind.SAFETY

    @property
    def avoids(self) -> bool:
        """True if there is something bad."""
        return self.kind is not Kind.REACH


def with_controllability(edge: Edge, controllable: bool) -> Edge:
    """The edge with another owner."""
    return edge if edge.controllable == controllable else replace(edge, controllable=controllable)
