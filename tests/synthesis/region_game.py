"""The rules of the game once more, by brute force on regions, for networks with few clocks and small constants.

A region is kept as one of its points: whole parts (capped above the largest constant) and equally spaced fractions.
Time takes a region through a finite sequence of regions, so the timed predecessor is a walk along it.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Dict, Iterator, List, Optional, Set, Tuple

from pursue_gen.synthesis.game import (
    Bound,
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
from pursue_gen.tga.network import Kind
from pursue_gen.zones.dbm import constant
from tests.oracle.zone_graph import max_constants

Region = Tuple[Fraction, ...]
Position = Tuple[State, Region]
Afters = Dict[Tuple[int, ...], Tuple[JointMove, Position]]
"""Where the moves that are enabled lead to, by their edges."""


class RegionGame:
    """All reachable positions of a game, and who wins in each."""

    def __init__(self, game: Game) -> None:
        self.game = game
        self._beyond = max(max_constants(game)) + game.delta + 1
        self._moves: Dict[State, List[JointMove]] = {}
        self._paths: Dict[Position, Tuple[Position, ...]] = {}
        self._afters: Dict[Position, Afters] = {}
        self.starts = self._starts()
        self.positions = self._reachable()

    def won(self, winning: Set[Position]) -> bool:
        """True if the controller wins wherever the game starts."""
        bounds = invariant(self.game, initial_state(self.game))
        return all(start in winning and self._holds(start[1], bounds) for start in self.starts)

    def winning(self) -> Set[Position]:
        """The positions from which the controller wins."""
        won: Set[Position] = set() if self.game.kind is not Kind.SAFETY else set(self.positions)
        step = self._safe if self.game.kind is Kind.SAFETY else self._wins
        while True:
            after = {position for position in self.positions if step(position, won)}
            if after == won:
                return won
            won = after

    def _wins(self, position: Position, won: Set[Position]) -> bool:
        if is_goal(self.game, position[0]):
            return True
        if is_bad(self.game, position[0]):
            return False
        for later in self.path(position):
            if self._spoils(later, won):
                return False
            forced = any(self._own(later, owner) for owner in self._expiring(later))
            if later in won or self._can_command(later, won) or forced:
                return True
        return False

    def _safe(self, position: Position, safe: Set[Position]) -> bool:
        if is_bad(self.game, position[0]):
            return False
        for later in self.path(position):
            command = self._can_command(later, safe)
            stuck = not command and any(not self._own(later, owner) for owner in self._expiring(later))
            if later not in safe or self._spoils(later, safe) or stuck:
                return False
            if command:
                return True
        return True

    def path(self, position: Position) -> Tuple[Position, ...]:
        """The positions that time leads to, as long as the invariants hold, the given one first."""
        if position not in self._paths:
            self._paths[position] = tuple(self._path(position))
        return self._paths[position]

    def _path(self, position: Position) -> Iterator[Position]:
        state, region = position
        bounds = invariant(self.game, state)
        while self._holds(region, bounds):
            yield state, region
            after = self._next(region)
            if after == region:
                return
            region = after

    def _can_command(self, position: Position, targets: Set[Position]) -> bool:
        moves = (move for move, _ in self.afters(position).values() if move.controllable)
        return any(self.usable(position, move, targets) for move in moves)

    def usable(self, position: Position, move: JointMove, targets: Set[Position]) -> bool:
        """True if the move leads into the targets at every time of the delay and nothing spoils it meanwhile."""
        last = self._representative(tuple(x + self.game.delta for x in position[1]))
        delay = self.game.delta
        for later in self.path(position):
            after = self.afters(later).get(move.edges)
            if after is None or after[1] not in targets or (delay and self._spoils(later, targets)):
                return False
            if later[1] == last:
                return True
        return False

    def _spoils(self, position: Position, good: Set[Position]) -> bool:
        return any(after not in good for move, after in self.afters(position).values() if not move.controllable)

    def _own(self, position: Position, owner: int) -> bool:
        moves = (move for move, _ in self.afters(position).values())
        return any(not move.controllable and move.owner == owner for move in moves)

    def _expiring(self, position: Position) -> List[int]:
        state, region = position
        return [
            k
            for k, automaton in enumerate(self.game.automata)
            if any(region[clock - 1] == bound >> 1 for clock, bound in automaton.invariants[state.locations[k]])
        ]

    def _after(self, position: Position, move: JointMove) -> Optional[Position]:
        if not self._holds(position[1], move.bounds):
            return None
        reset = tuple(Fraction(0) if k + 1 in move.resets else x for k, x in enumerate(position[1]))
        if not self._holds(reset, invariant(self.game, move.target)):
            return None
        return move.target, self._representative(reset)

    def afters(self, position: Position) -> Afters:
        """Where the moves that are enabled in this position lead to, by their edges."""
        if position not in self._afters:
            afters = ((move, self._after(position, move)) for move in self.moves(position[0]))
            self._afters[position] = {move.edges: (move, after) for move, after in afters if after is not None}
        return self._afters[position]

    def moves(self, state: State) -> List[JointMove]:
        """The joint moves of the state, but for moves after which nothing has changed."""
        if state not in self._moves:
            moves = joint_moves(self.game, state)
            self._moves[state] = [m for m in moves if m.resets or m.target != state]
        return self._moves[state]

    def _holds(self, region: Region, bounds: Tuple[Bound, ...]) -> bool:
        values = (Fraction(0), *region)
        return all(
            values[i] - values[j] < bound >> 1 or (bound & 1 == 1 and values[i] - values[j] == bound >> 1)
            for i, j, bound in bounds
        )

    def _representative(self, point: Region) -> Region:
        """The same point for all points of a region: fractions 1/(n+1), 2/(n+1), … in their order."""
        fractions = sorted({x % 1 for x in point if x < self._beyond and x % 1})
        rank = {f: Fraction(k + 1, len(point) + 1) for k, f in enumerate(fractions)}
        return tuple(
            Fraction(self._beyond) if x >= self._beyond else Fraction(x // 1) + rank.get(x % 1, 0) for x in point
        )

    def _next(self, region: Region) -> Region:
        """The next region in time; the same if all clocks are beyond the constants."""
        live = [x for x in region if x < self._beyond]
        if not live:
            return region
        largest = max(x % 1 for x in live)
        if any(x % 1 == 0 for x in live):
            return self._representative(self._shift(region, (1 - largest) / 2))
        return self._representative(self._shift(region, 1 - largest))

    def _shift(self, region: Region, time: Fraction) -> Region:
        return tuple(x if x >= self._beyond else x + time for x in region)

    def _starts(self) -> List[Position]:
        """Where the game starts: of all regions those in the zone."""
        zone, count = start_zone(self.game), len(self.game.clocks)
        if not self.game.start:
            return [(initial_state(self.game), (Fraction(0),) * count)]
        # Beyond all constants the zone may still tell values apart: two more units, and all above is alike.
        largest = 2 + max([self._beyond, *(abs(constant(bound)) for _, _, bound in self.game.start)])
        values = [Fraction(k, count + 1) for k in range((count + 1) * largest + 1)]
        points = (point for point in product(values, repeat=count) if zone.contains(point))
        return [(initial_state(self.game), region) for region in sorted({self._representative(p) for p in points})]

    def _reachable(self) -> Set[Position]:
        met: Set[Position] = set(self.starts)
        waiting = list(self.starts)
        while waiting:
            position = waiting.pop()
            followers = list(self.path(position))
            if not (is_goal(self.game, position[0]) or is_bad(self.game, position[0])):
                followers += [after for _, after in self.afters(position).values()]
            for follower in followers:
                if follower not in met:
                    met.add(follower)
                    waiting.append(follower)
        return met
