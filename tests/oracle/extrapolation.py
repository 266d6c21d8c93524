"""The largest constants that the rest of a play compares each clock with, by which the checker extrapolates zones.

Per discrete state the largest constant that a clock is compared with before its next reset (Behrmann, Bouyer, Fleury
and Larsen, TACAS 2003, with the strategy's zones as further guards). Extrapolation only adds points, so it hides no
failure.
"""

from __future__ import annotations

from collections import deque
from typing import Callable, Deque, Dict, Iterable, List, Sequence, Set, Tuple

from pursue_gen.proof.moves import Arena, JointMove, State
from pursue_gen.zones.dbm import Dbm
from tests.oracle.zones import before_reset, extrapolated, reset

NEVER = -1
"""The largest constant of a clock that is not compared before its next reset."""

Described = Tuple[Sequence[JointMove], Iterable[Tuple[int, int]]]
"""The joint moves that may happen in a state, and the (clock, constant) pairs that the strategy compares there."""


class MaxConstants:
    """The largest constants of every discrete state that the moves lead to from the initial one.

    `late` is how long after its decision a command may take effect, in scaled time units.
    """

    def __init__(self, arena: Arena, described: Callable[[State], Described], late: int) -> None:
        self._arena, self._late = arena, late
        self._largest: Dict[State, List[int]] = {}
        self._before: Dict[State, Set[Tuple[State, Tuple[int, ...]]]] = {}
        self._explore(described)
        self._spread()

    def extrapolate(self, zone: Dbm, state: State) -> Dbm:
        """The zone and all points that the rest of the play cannot tell from it, within the state's invariant."""
        largest = self._largest[state]
        never = [x for x in range(1, zone.dim) if largest[x] == NEVER]
        larger = zone
        if never:
            freed = before_reset(reset(zone, never), never)
            larger = zone if freed is None else freed
        larger = extrapolated(larger, [0] + [max(0, c) for c in largest[1:]])
        invariant = self._arena.situation(state).invariant
        within = None if invariant is None else larger.intersect(invariant)
        return zone if within is None else within

    def _explore(self, described: Callable[[State], Described]) -> None:
        pending: Deque[State] = deque([self._arena.initial])
        self._largest[self._arena.initial] = [NEVER] * self._arena.dim
        while pending:
            state = pending.popleft()
            here = self._largest[state]
            moves, compared = described(state)
            for x, c in [*compared, *self._guards(state, moves)]:
                here[x] = max(here[x], c + self._late)
            for move in moves:
                if move.target not in self._largest:
                    self._largest[move.target] = [NEVER] * self._arena.dim
                    pending.append(move.target)
                self._before.setdefault(move.target, set()).add((state, move.resets))

    def _guards(self, state: State, moves: Sequence[JointMove]) -> Iterable[Tuple[int, int]]:
        for _, clock, bound in self._arena.situation(state).bounds:
            yield clock, bound >> 1
        for move in moves:
            for clock_bound in move.moves[0].edge.guard.clocks:
                yield self._arena.clock[clock_bound.clock], int(clock_bound.bound * self._arena.scale)

    def _spread(self) -> None:
        """What a clock is compared with in a state counts before it, but for clocks that the step into it resets."""
        pending = deque(self._largest)
        queued = set(pending)
        while pending:
            state = pending.popleft()
            queued.discard(state)
            here = self._largest[state]
            for earlier, resets in self._before.get(state, ()):
                there, changed = self._largest[earlier], False
                for x in range(1, self._arena.dim):
                    if here[x] > there[x] and x not in resets:
                        there[x], changed = here[x], True
                if changed and earlier not in queued:
                    queued.add(earlier)
                    pending.append(earlier)
