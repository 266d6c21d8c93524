"""The forward half of the reference engine: discrete states, their moves, one zone that bounds what is reached in each.

The zone of a state is the convex hull of all that is forward reachable there, extrapolated. It may hold more than that:
a position's value depends on its successors only, so bounding with too much changes no verdict.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import Callable, Deque, Dict, Iterable, List, Optional, Sequence, Set, Tuple

from pursue_gen.synthesis.game import (
    Game,
    JointMove,
    State,
    initial_state,
    invariant,
    is_bad,
    is_goal,
    joint_moves,
    start_zone,
)
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.zones.dbm import Dbm, complement, constant
from pursue_gen.zones.federation import Federation
from tests.oracle.zones import before_reset, extrapolated, hull, reset

Chooser = Callable[[State, Sequence[JointMove]], Sequence[JointMove]]
"""Of a state and its moves that the controller can take, those that a search is to follow at first."""


class Monitor(LimitMonitor):
    """A monitor that knows the limit of discrete states, which the engine in C++ keeps itself."""

    def admit(self, states: int, waiting: int) -> None:
        """Raises PursueError (exit status 5) where one more discrete state would be too many."""
        if 0 < self._limits.states <= states:
            self._states, self._waiting = states, waiting
            raise self._stopped_now("states")


@dataclass
class Transition:
    """A joint move and the node it leads to; -1: nothing that is reached so far can take it."""

    joint: JointMove
    target: int = -1


@dataclass
class Node:
    """A discrete state in the making: what is reached in it, its moves (`omitted`: not followed yet), its sources."""

    state: State
    within: Dbm
    reach: Dbm
    controllable: List[Transition] = field(default_factory=list)
    uncontrollable: List[Transition] = field(default_factory=list)
    omitted: List[Transition] = field(default_factory=list)
    sources: Set[int] = field(default_factory=set)
    expanded: bool = False


class ZoneGraph:
    """The part of the game that is explored; it grows by `explore` and `widen`. Node 0 is where the game starts.

    There is none where an invariant does not hold at the start.
    """

    def __init__(self, game: Game, monitor: Monitor, choose: Optional[Chooser] = None) -> None:
        self.game = game
        self.monitor = monitor
        self.nodes: List[Node] = []
        self._choose = choose
        self._index: Dict[State, int] = {}
        self._waiting: Deque[int] = deque()
        self._queued: Set[int] = set()
        self.start = start_zone(game)
        self._max_constants = max_constants(game)
        within = Dbm.universe(game.dim).constrained_all(invariant(game, initial_state(game)))
        if within is not None and within.includes(self.start):
            self._enter(initial_state(game), self.start)

    def explore(self) -> Set[int]:
        """Follow the moves until nothing new is reached; returns the nodes in which more is reached than before."""
        changed: Set[int] = set()
        while self._waiting:
            number = self._waiting.popleft()
            self._queued.discard(number)
            changed.add(number)
            node = self.nodes[number]
            if not node.expanded:
                self._expand(node)
            moves = node.controllable + node.uncontrollable
            self.monitor.check(len(self.nodes), len(self._waiting), 1 + len(moves))
            self._follow(number, moves)
        return changed

    def widen(self, number: int) -> None:
        """Follow all moves of the node from now on."""
        node = self.nodes[number]
        added, node.omitted = node.omitted, []
        node.controllable += added
        self._follow(number, added)

    def guard(self, number: int, move: Transition) -> Optional[Dbm]:
        """Where in the node the move's guard holds; None: nowhere."""
        return self.nodes[number].reach.constrained_all(move.joint.bounds)

    def pre(self, number: int, move: Transition, targets: Federation) -> Federation:
        """The positions of the node from which the move leads into the targets (zones of the move's target node)."""
        guard = self.guard(number, move) if targets else None
        if guard is None:
            return Federation()
        before = (before_reset(zone, move.joint.resets) for zone in targets.zones)
        return Federation(tuple(zone for zone in before if zone is not None)).intersect_zone(guard)

    def at_bound(self, number: int, owner: int) -> Federation:
        """Where the owner's invariant is at its bound, so that time cannot pass."""
        node = self.nodes[number]
        bounds = self.game.automata[owner].invariants[node.state.locations[owner]]
        faces = (node.reach.constrained(0, clock, complement(bound - 1)) for clock, bound in bounds)
        return Federation(tuple(face for face in faces if face is not None))

    def own_moves(self, number: int, owner: int) -> Federation:
        """Where an uncontrollable move that the owner sends (or makes by itself) is enabled.

        Of an owner that matters an unseen one is none; whatever one that cannot matter does is unseen, and its bounds
        oblige it alone.
        """
        matters = owner not in self.game.unseen
        moves = [m for m in self.nodes[number].uncontrollable if m.joint.owner == owner]
        moves = [move for move in moves if not (matters and move.joint.is_unseen)]
        enabled = Federation()
        for move in (m for m in moves if m.target >= 0):
            enabled = enabled.union(self.pre(number, move, Federation((self.nodes[move.target].within,))))
        return enabled

    def limited(self, number: int) -> Iterable[int]:
        """The automata whose location has an invariant."""
        locations = self.nodes[number].state.locations
        return (k for k, automaton in enumerate(self.game.automata) if automaton.invariants[locations[k]])

    def _expand(self, node: Node) -> None:
        # At the goal and at what is to be avoided the game is decided.
        decided = is_goal(self.game, node.state) or is_bad(self.game, node.state)
        all_moves = () if decided else joint_moves(self.game, node.state)
        moves = [joint for joint in all_moves if not joint.changes_nothing]
        commands = [joint for joint in moves if joint.controllable]
        chosen = commands if self._choose is None else self._choose(node.state, commands)
        node.controllable = [Transition(joint) for joint in commands if joint in chosen]
        node.omitted = [Transition(joint) for joint in commands if joint not in chosen]
        node.uncontrollable = [Transition(joint) for joint in moves if not joint.controllable]
        node.expanded = True

    def _follow(self, number: int, moves: Iterable[Transition]) -> None:
        for move in moves:
            guard = self.guard(number, move)
            if guard is not None:
                target = self._enter(move.joint.target, reset(guard, move.joint.resets))
                if target is not None:
                    move.target = target
                    self.nodes[target].sources.add(number)

    def _enter(self, state: State, zone: Dbm) -> Optional[int]:
        """The node of the state, with this zone (as far as the invariant holds) and its future in what is reached."""
        number = self._index.get(state)
        if number is None:
            within = Dbm.universe(self.game.dim).constrained_all(invariant(self.game, state))
            entered = zone.intersect(within) if within is not None else None
            if within is None or entered is None:
                return None
            number = len(self.nodes)
            self.monitor.admit(number, len(self._waiting))
            self._index[state] = number
            self.nodes.append(Node(state, within, self._closed(entered, within)))
            self._enqueue(number)
            return number
        node = self.nodes[number]
        inside = zone.intersect(node.within)
        if inside is None:
            return None
        if not node.reach.includes(inside):
            node.reach = self._closed(hull(node.reach, inside), node.within)
            self._enqueue(number)
        return number

    def _enqueue(self, number: int) -> None:
        if number not in self._queued:
            self._queued.add(number)
            self._waiting.append(number)

    def _closed(self, zone: Dbm, within: Dbm) -> Dbm:
        """The zone and its future within the invariant, extrapolated."""
        future = _common(zone.up(), within)
        return _common(extrapolated(future, self._max_constants).up(), within)


def max_constants(game: Game) -> Tuple[int, ...]:
    """The largest scaled constant that each clock is compared with, for extrapolation; 0 for the constant 0."""
    largest = [0] * game.dim
    compared = [(i or j, bound) for edge in game.edges for i, j, bound in edge.bounds]
    compared += [pair for automaton in game.automata for invariant in automaton.invariants for pair in invariant]
    for clock, bound in compared:
        largest[clock] = max(largest[clock], abs(constant(bound)))
    return tuple(largest)


def _common(a: Dbm, b: Dbm) -> Dbm:
    common = a.intersect(b)
    assert common is not None, "a zone that was entered has a future within its invariant"
    return common
