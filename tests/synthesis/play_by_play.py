"""Strategies played point by point, with steps at quarter time units: whatever breaks here is a real play that breaks.

A deliberately naive reading of the same rules, to hold against the symbolic checker.
"""

from __future__ import annotations

import functools
import itertools
import operator
from fractions import Fraction
from typing import Callable, Dict, Iterator, List, Mapping, Optional, Tuple, Union

from pursue_gen.synthesis.strategy import Block, Command, Strategy, Zone
from pursue_gen.tga.network import Automaton, ClockBound, Edge, Kind, Location, Network, Objective

UNIT, STEP, HALFWAY = 8, 2, 1
"""A time unit, a step and half of one, in eighths of a unit, in which all times are counted.

Bounds are multiples of a step, so between two of them a zone holds all along or not at all, and one look halfway tells:
a zone may lie between them, and a player who acts in it never sees the later one.
"""

Values = Dict[str, int]
Entry = Tuple[Tuple[str, ...], Tuple[int, ...], Tuple[int, ...]]
Move = Tuple[Tuple[str, Edge], ...]


class Broken(Exception):
    """The play fails, and why."""


COMPARED: Dict[str, Callable[[int, int], bool]] = {
    "<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge, "==": operator.eq,
}


def holds(bound: ClockBound, clocks: Values) -> bool:
    """The bound, looked up."""
    return COMPARED[bound.op](clocks[bound.clock], UNIT * bound.bound)


def inside(zone: Zone, clocks: Mapping[str, Union[int, Fraction]], unit: int = 1) -> bool:
    """True if the valuation is in the strategy's zone; `unit` is how much of the clocks is one time unit."""
    for c in zone:
        difference = (clocks[c.left] if c.left else 0) - (clocks[c.right] if c.right else 0)
        bound = unit * c.bound
        if difference > bound or (c.strict and difference == bound):
            return False
    return True


class PlayByPlay:
    """All plays of a strategy whose delays are multiples of a quarter, as far as `entries` reach."""

    def __init__(self, network: Network, objective: Objective, strategy: Strategy, reaction: Fraction) -> None:
        self.network, self.objective, self.reaction = network, objective, reaction
        # A strategy may name a part of the network only: its blocks hold whatever the rest is.
        first = strategy.blocks[0].state if strategy.blocks else None
        self.named = {name for name, _ in first.locations} if first else {a.name for a in network.automata}
        values = {name for name, _ in first.values} if first else {name for name, _ in network.variables}
        self._clocks_named = {c for a in network.automata if a.name in self.named for c in a.clocks}
        self._left_out = frozenset(strategy.left_out_clocks)
        self._clocks_named -= self._left_out
        self._places = [k for k, automaton in enumerate(network.automata) if automaton.name in self.named]
        self._values = [k for k, (name, _) in enumerate(network.variables) if name in values]
        self.blocks: Dict[Tuple[Tuple[str, ...], Tuple[int, ...]], Block] = {
            (tuple(p for _, p in b.state.locations), tuple(v for _, v in b.state.values)): b for b in strategy.blocks
        }
        bounds = [b.bound for a in network.automata for e in a.edges for b in e.guard.clocks]
        bounds += [b.bound for a in network.automata for loc in a.locations for b in loc.invariant]
        self.longest = UNIT * (2 * max([3, *bounds]) + 3)
        self._moves: Dict[Entry, Tuple[Move, ...]] = {}
        self._of_environment: Dict[Tuple[Entry, bool], Tuple[Entry, ...]] = {}
        self._invariants: Dict[Tuple[str, ...], List[Tuple[Automaton, ClockBound]]] = {}
        self._automaton = {automaton.name: k for k, automaton in enumerate(network.automata)}
        self._variable = {name: k for k, (name, _) in enumerate(network.variables)}
        self._clock = {name: k for k, name in enumerate(network.clocks)}
        self._leaving = {
            (a.name, loc.name): [e for e in a.edges if e.source == loc.name]
            for a in network.automata
            for loc in a.locations
        }

    def broken(self, entries: int = 400) -> Optional[str]:
        """Why a play fails, or None if none is found within so many entries."""
        start: Entry = (
            tuple(a.initial for a in self.network.automata),
            tuple(v for _, v in self.network.variables),
            (0,) * len(self.network.clocks),
        )
        after: Dict[Entry, List[Entry]] = {}
        pending = [start]
        try:
            while pending and len(after) < entries:
                entry = pending.pop(0)
                if entry not in after:
                    after[entry] = sorted(set(self.followers(entry)))
                    pending += after[entry]
        except Broken as broken:
            return str(broken)
        return "cycle" if self.objective.kind is not Kind.SAFETY and _has_cycle(after) else None

    def at(self, entry: Entry, place: Tuple[str, str]) -> bool:
        """True if the automaton is at that location."""
        return place in zip((a.name for a in self.network.automata), entry[0])

    def won(self, entry: Entry) -> bool:
        """True where the goal is reached: at all of its locations."""
        goal = () if self.objective.kind is Kind.SAFETY else self.objective.goal
        return bool(goal) and not [place for place in goal if not self.at(entry, place)]

    def lost(self, entry: Entry) -> bool:
        """True where something is to be avoided: at any of its locations."""
        bad = () if self.objective.kind is Kind.REACH else self.objective.bad
        return bool([place for place in bad if self.at(entry, place)])

    def followers(self, entry: Entry) -> Iterator[Entry]:
        """The entries after one step. Raises Broken."""
        if self.won(entry):
            return
        if self.lost(entry):
            raise Broken("bad")
        block = self.blocks.get((tuple(entry[0][k] for k in self._places), tuple(entry[1][k] for k in self._values)))
        if block is None:
            raise Broken("no block")
        entered: Optional[List[Tuple[Command, Zone]]] = None
        for n in itertools.count():
            now, between = self.later(entry, n * HALFWAY), n % 2 == 1
            clocks = self.clocks(now)
            ready = [(c, z) for c in block.commands for z in c.zones if inside(z, clocks, UNIT)]
            waits = any(inside(z, clocks, UNIT) for z in block.wait)
            entered = ready if entered is None and ready else entered
            if entered is not None:
                entered = [one for one in entered if one in ready]
                if not entered:
                    return
            yield from () if between else self.environment(now)
            if entered is not None:
                if waits:
                    raise Broken("contradiction")
                for command, _ in () if between else entered:
                    yield from self.act(now, command)
            elif not waits:
                raise Broken("not covered")
            if not self.lasts(self.later(now, HALFWAY)):
                if entered is None:
                    self.check_obliged(now)
                return
            if n * HALFWAY > self.longest:
                waits_on = entered is None and not self.invariants(now)
                if waits_on and self.objective.kind is not Kind.SAFETY:
                    raise Broken("waits for ever")
                return

    def act(self, now: Entry, command: Command) -> Iterator[Entry]:
        """The command takes effect at any time within the reaction."""
        commanded = {(x.automaton, x.edge) for x in command.moves}
        for n in range(int(self.reaction * UNIT / STEP) + 1):
            then = self.later(now, n * STEP)
            if not self.lasts(then):  # time is blocked before the command comes: someone else has to move
                self.check_obliged(self.later(now, (n - 1) * STEP))
                return
            moves = [m for m in self.moves(then) if commanded == {(a, e) for a, e in m if a in self.named}]
            if not moves or not all(edge.controllable for _, edge in moves[0]):
                raise Broken("not enabled")
            after = self.after(then, moves[0])
            if not self._changes(then, after, moves[0]):
                raise Broken("changes nothing")
            yield after
            yield from self.environment(then, in_flight=True)

    def _changes(self, now: Entry, after: Entry, move: Move) -> bool:
        """True if a command does something to what the strategy names."""
        places = any(now[0][k] != after[0][k] for k in self._places)
        values = any(now[1][k] != after[1][k] for k in self._values)
        return places or values or any(edge.resets for name, edge in move if name in self.named)

    def environment(self, now: Entry, in_flight: bool = False) -> Tuple[Entry, ...]:
        """What the environment may make of this point; of a command `in_flight` what makes it stale."""
        if (now, in_flight) not in self._of_environment:
            self._of_environment[now, in_flight] = tuple(self._environment(now, in_flight))
        return self._of_environment[now, in_flight]

    def _environment(self, now: Entry, in_flight: bool) -> Iterator[Entry]:
        for move in self.moves(now):
            if not all(edge.controllable for _, edge in move):
                if in_flight and not self._is_seen(now, move):
                    continue
                after = self.after(now, move)
                if after[:2] != now[:2] or self._resets(move) or after != now:  # else nothing has happened
                    yield after

    def _resets(self, move: Move) -> bool:
        """True if the move resets a clock that is not left out: it is one even where the clock is 0 already."""
        return any(clock not in self._left_out for _, edge in move for clock in edge.resets)

    def _is_seen(self, now: Entry, move: Move) -> bool:
        """True if the move changes something of what the strategy names: else a command on its way stands."""
        resets = {clock for _, edge in move for clock in edge.resets}
        return self._changes(now, self.after(now, move), ()) or not resets.isdisjoint(self._clocks_named)

    def moves(self, now: Entry) -> Tuple[Move, ...]:
        """The joint moves that are enabled at a point."""
        if now not in self._moves:
            self._moves[now] = tuple(self._enabled(now))
        return self._moves[now]

    def _enabled(self, now: Entry) -> Iterator[Move]:
        if not self.lasts(now):
            return
        clocks = self.clocks(now)
        values = dict(zip((name for name, _ in self.network.variables), now[1]))

        def open_to(edge: Edge) -> bool:
            fits = all(any(values[t.variable] == t.value for t in clause) for clause in edge.guard.integers)
            return fits and all(holds(b, clocks) for b in edge.guard.clocks)

        for automaton, place in zip(self.network.automata, now[0]):
            for edge in self._leaving[automaton.name, place]:
                if (edge.sync and not edge.sync.sends) or not open_to(edge):
                    continue
                choices = []
                for other, there in zip(self.network.automata, now[0]) if edge.sync else ():
                    hears = [
                        (other.name, e)
                        for e in self._leaving[other.name, there]
                        if other is not automaton and edge.sync and e.sync and not e.sync.sends
                        and e.sync.channel == edge.sync.channel and open_to(e)
                    ]
                    choices += [hears] if hears else []
                for receivers in itertools.product(*choices):
                    move = ((automaton.name, edge), *receivers)
                    if self.lasts(self.after(now, move)):
                        yield move

    def after(self, now: Entry, move: Move) -> Entry:
        """The point after a joint move."""
        places, values, clocks = map(list, now)
        for name, edge in move:
            places[self._automaton[name]] = edge.target
            for variable, value in edge.assign:
                values[self._variable[variable]] = value
            for clock in edge.resets:
                clocks[self._clock[clock]] = 0
        return tuple(places), tuple(values), tuple(clocks)

    def clocks(self, now: Entry) -> Values:
        """The clocks by name."""
        return dict(zip(self.network.clocks, now[2]))

    @staticmethod
    def later(now: Entry, time: int) -> Entry:
        """The point after that time."""
        return now[0], now[1], tuple(x + time for x in now[2])

    def invariants(self, now: Entry) -> List[Tuple[Automaton, ClockBound]]:
        """The bounds of the locations."""
        if now[0] not in self._invariants:
            here: List[Tuple[Automaton, Location]] = [
                (a, loc) for a, place in zip(self.network.automata, now[0]) for loc in a.locations if loc.name == place
            ]
            self._invariants[now[0]] = [(a, b) for a, loc in here for b in loc.invariant]
        return self._invariants[now[0]]

    def lasts(self, now: Entry) -> bool:
        """True within all invariants."""
        bounds = self.invariants(now)
        clocks = self.clocks(now) if bounds else {}
        return all(holds(b, clocks) for _, b in bounds)

    def check_obliged(self, now: Entry) -> None:
        """At the end of an invariant while waiting. Raises Broken unless someone is obliged to move."""
        at_bound = {a.name for a, b in self.invariants(now) if self.clocks(now)[b.clock] == UNIT * b.bound}
        able = {
            m[0][0]
            for m in self.moves(now)
            if not all(e.controllable for _, e in m)
            and (self.after(now, m)[:2] != now[:2] or any(e.resets for _, e in m))
        }
        if not (at_bound <= able if self.objective.kind is Kind.SAFETY else at_bound & able):
            raise Broken("time is blocked")


@functools.lru_cache(maxsize=None)
def broken(network: Network, objective: Objective, strategy: Strategy, reaction: Fraction) -> Optional[str]:
    """Why a play fails, or None; played once, however many checkers are held against it."""
    return PlayByPlay(network, objective, strategy, reaction).broken()


def _has_cycle(after: Dict[Entry, List[Entry]]) -> bool:
    """True if entries follow each other round; the rest, which nothing cyclic follows, is taken away first."""
    left = {entry: {e for e in following if e in after} for entry, following in after.items()}
    while True:
        ends = {entry for entry, following in left.items() if not following & left.keys()}
        if not ends:
            return bool(left)
        left = {entry: following for entry, following in left.items() if entry not in ends}
