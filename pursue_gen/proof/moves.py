"""The checker's own reading of a network: joint moves of a discrete state, with the zone in which each is enabled.

Written from the rules of the game, not from the solver: the two must not share a mistake.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Dict, Iterable, List, Optional, Sequence, Set, Tuple

from pursue_gen.diagnostics import error
from pursue_gen.outcomes import Invalid
from pursue_gen.proof import reasons
from pursue_gen.synthesis.strategy import Command, DiscreteState, Move
from pursue_gen.tga.network import ClockBound, Constraint, Edge, Guard, Location, Network
from pursue_gen.zones.dbm import Dbm, raw

_KEPT = 5_000
"""So many situations of discrete states are kept: those of many automata are large, and a judge of many missions sees
more of them than fit into memory. Not measured."""

State = Tuple[Tuple[str, ...], Tuple[int, ...]]
"""The location of every automaton and the value of every variable, in the network's order."""

Limit = Tuple[int, int, int]
"""`x_i - x_j` within a raw bound."""

Bound = Tuple[int, int, int]
"""An invariant's bound: the number of the automaton, its clock's index, the raw upper bound."""


@dataclass(frozen=True)
class JointMove:
    """Edges that are taken together: the sender's (or tau owner's) first, then the receivers' in system order."""

    owner: int
    moves: Tuple[Move, ...]
    controllable: bool
    target: State
    resets: Tuple[int, ...]
    enabled: Optional[Dbm]
    """Where guard, the source's invariants and (after the resets) the target's invariants hold; None: nowhere."""


@dataclass(frozen=True)
class Situation:
    """All about a discrete state that does not depend on the strategy."""

    invariant: Optional[Dbm]
    bounds: Tuple[Bound, ...]
    moves: Tuple[JointMove, ...]


class Arena:
    """The discrete states of a network, worked out when they are asked for; constants are multiplied by `scale`, with
    which all times of the network are whole.

    A move that changes no location, variable or clock is none, unless `idle_moves` is set: nothing has happened,
    however often it is made. Raises PursueError where the rules of the game do not cover the network.
    """

    def __init__(self, network: Network, scale: int, idle_moves: bool = False) -> None:
        self.network, self.scale, self._idle_moves = network, scale, idle_moves
        self.dim = len(network.clocks) + 1
        self.clock = {name: k + 1 for k, name in enumerate(network.clocks)}
        self.variable = {name: k for k, (name, _) in enumerate(network.variables)}
        self.initial: State = (tuple(a.initial for a in network.automata), tuple(v for _, v in network.variables))
        self.start = self._start()
        self._located = [
            {location.name: self._bounds_of(k, location) for location in automaton.locations}
            for k, automaton in enumerate(network.automata)
        ]
        self._edges: Dict[Tuple[int, str], List[Edge]] = {}
        self._receiving: Dict[Tuple[int, str, str], List[Edge]] = {}  # with their channel
        for k, automaton in enumerate(network.automata):
            for edge in automaton.edges:
                self._edges.setdefault((k, edge.source), []).append(edge)
                if edge.received is not None:
                    self._receiving.setdefault((k, edge.source, edge.received), []).append(edge)
        self._situations: Dict[State, Situation] = {}
        self._refuse()

    def _start(self) -> Dbm:
        """The clocks at the start: 0, or what the network says."""
        if not self.network.start:
            return Dbm.zero(self.dim)
        zone: Optional[Dbm] = Dbm.universe(self.dim)
        for c in self.network.start:
            i, j = (0 if name is None else self.clock.get(name, -1) for name in (c.left, c.right))
            zone = None if zone is None or min(i, j) < 0 else zone.constrained(i, j, self._raw(c))
        if zone is None:
            hint = f"give bounds that the clocks {', '.join(self.clock)} can have together, all of them 0 or more"
            raise Invalid([error("SYN106", "no values of the clocks satisfy the bounds at the start", hint=hint)])
        return zone

    def _raw(self, constraint: Constraint) -> int:
        return raw(int(constraint.bound * self.scale), constraint.strict)

    def _refuse(self) -> None:
        for automaton in self.network.automata:
            for edge in automaton.edges:
                if edge.sync is not None and not edge.sync.sends and edge.guard.clocks:
                    raise Invalid([error(
                        "SYN101",
                        f"the receiving edge {edge.source} -> {edge.target} of {automaton.name} has a guard on a clock",
                        hint="only senders may test clocks: move the guard to the sending edge",
                    )])
            for location in automaton.locations:
                if any(bound.op not in ("<", "<=") for bound in location.invariant):
                    raise Invalid([error(
                        "SYN102",
                        f"the invariant of {automaton.name}.{location.name} is not an upper bound",
                        hint="an invariant may only say that a clock is < or <= a constant",
                    )])

    def state_of(self, state: DiscreteState) -> Optional[State]:
        """A strategy's discrete state as the checker has it; None if it is not one of this network."""
        if tuple(name for name, _ in state.locations) != tuple(a.name for a in self.network.automata):
            return None
        if tuple(name for name, _ in state.values) != tuple(name for name, _ in self.network.variables):
            return None
        return tuple(location for _, location in state.locations), tuple(value for _, value in state.values)

    def situation(self, state: State) -> Situation:
        """The invariant and the joint moves of a discrete state."""
        found = self._situations.get(state)
        if found is None:
            if len(self._situations) >= _KEPT:
                self._situations.clear()
            found = self._situations[state] = self._worked_out(state)
        return found

    def limits(self, bounds: Iterable[ClockBound]) -> Iterable[Limit]:
        """The bounds of a guard or an invariant as limits on differences, with scaled constants. Requires clocks of the
        network, and that the constants are whole then."""
        for bound in bounds:
            x, c = self.clock[bound.clock], int(bound.bound * self.scale)
            assert c == bound.bound * self.scale
            if bound.op in ("<", "<=", "=="):
                yield x, 0, raw(c, bound.op == "<")
            if bound.op in (">", ">=", "=="):
                yield 0, x, raw(-c, bound.op == ">")

    def _bounds_of(self, k: int, location: Location) -> Tuple[Bound, ...]:
        return tuple((k, i, bound) for i, _, bound in self.limits(location.invariant))

    def _bounds(self, state: State) -> Tuple[Bound, ...]:
        return tuple(bound for located, name in zip(self._located, state[0]) for bound in located[name])

    def _worked_out(self, state: State) -> Situation:
        bounds = self._bounds(state)
        invariant = Dbm.of(self.dim, [(i, 0, bound) for _, i, bound in bounds])
        moves: List[JointMove] = []
        for k, location in enumerate(state[0]):
            for edge in self._edges.get((k, location), ()):
                if (edge.sync is None or edge.sync.sends) and self._integers_hold(edge.guard, state[1]):
                    moves += [self._joint(state, invariant, k, edge, r) for r in self._receivers(state, k, edge)]
        if not self._idle_moves:
            moves = [move for move in moves if move.resets or move.target != state]
        return Situation(invariant, bounds, tuple(moves))

    def _integers_hold(self, guard: Guard, values: Tuple[int, ...]) -> bool:
        return all(any(values[self.variable[t.variable]] == t.value for t in clause) for clause in guard.integers)

    def _receivers(self, state: State, sender: int, edge: Edge) -> Iterable[Tuple[Tuple[int, Edge], ...]]:
        """Every way in which all others that can receive take part."""
        if edge.sync is None:
            return [()]
        choices: List[List[Tuple[int, Edge]]] = []
        for k, location in enumerate(state[0]):
            hearing = self._receiving.get((k, location, edge.sync.channel), ()) if k != sender else ()
            able = [(k, other) for other in hearing if self._integers_hold(other.guard, state[1])]
            if able:
                choices.append(able)
        return product(*choices)

    def _joint(
        self, state: State, invariant: Optional[Dbm], owner: int, edge: Edge, receivers: Tuple[Tuple[int, Edge], ...]
    ) -> JointMove:
        parts = ((owner, edge),) + receivers
        locations, values = list(state[0]), list(state[1])
        resets: Set[int] = set()
        for k, part in parts:
            locations[k] = part.target
            for name, value in part.assign:
                values[self.variable[name]] = value
            resets.update(self.clock[name] for name in part.resets)
        target = (tuple(locations), tuple(values))
        enabled = None if invariant is None else invariant.constrained_all(self.limits(edge.guard.clocks))
        for _, i, bound in self._bounds(target):
            if enabled is not None and i not in resets:
                enabled = enabled.constrained(i, 0, bound)
            elif bound < raw(0, strict=False):
                enabled = None
        names = self.network.automata
        return JointMove(
            owner,
            tuple(Move(names[k].name, part) for k, part in parts),
            all(part.controllable for _, part in parts),
            target,
            tuple(sorted(resets)),
            enabled,
        )


def joint_move(command: Command, situation: Situation) -> Tuple[Optional[JointMove], str]:
    """The joint move that a command names, or None and why there is none."""
    for move in situation.moves:
        if move.moves[:1] == command.moves[:1] and _same(move.moves[1:], command.moves[1:]):
            if move.controllable:
                return move, ""
            return None, reasons.NOT_CONTROLLABLE
    return None, reasons.NO_JOINT_MOVE


def _same(some: Sequence[object], others: Sequence[object]) -> bool:
    return len(some) == len(others) and all(one in others for one in some)


def in_words(moves: Sequence[Move]) -> str:
    """The moves that are made together, as a step of a play: who, the event, the edges."""
    who = "controller" if all(move.edge.controllable for move in moves) else "environment"
    sync = moves[0].edge.sync
    event = "tau" if sync is None else sync.channel
    edges = (f"{m.automaton}.{m.edge.source} -> {m.automaton}.{m.edge.target}" for m in moves)
    return f"{who}: {event} ({', '.join(edges)})"
