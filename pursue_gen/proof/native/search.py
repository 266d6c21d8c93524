"""The searches through a closed loop in C++ (search.hpp), for what its numbers hold; the others are done in Python."""

from __future__ import annotations

from typing import Any, Dict, List, Optional, Sequence, Tuple

from pursue_gen.proof import reasons
from pursue_gen.proof.closed_loop import ClosedLoop, in_words
from pursue_gen.proof.moves import State
from pursue_gen.proof.native.tables import MOST_DELAY, MOST_FACTOR, MOST_RANK, NotHeld, Tables, tables_of
from pursue_gen.proof.search import Depth, Failure, Found, Latest, Left, Searches
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Move
from pursue_gen.zones.dbm import INF, Dbm

_UNBOUNDED = 1 << 62
"""How module.cpp writes no bound."""

_REASONS = (
    reasons.BAD,
    reasons.NO_BLOCK,
    reasons.NO_PROGRESS,
    reasons.NOT_COVERED,
    reasons.BLOCKED,
    reasons.NO_END,
    reasons.WAITS_FOR_EVER,
    reasons.NOT_ENABLED,
    reasons.TOO_LATE,
    reasons.CONTRADICTION,
    reasons.NOT_CONTROLLABLE,
    reasons.NO_JOINT_MOVE,
    reasons.FOR_EVER,
    reasons.LIMIT,
)
"""In the order of the enumeration in delays.hpp."""


class NativeSearches(Searches):
    """The same searches with the same outcomes. Raises NotHeld where the native checker cannot do any of them."""

    def __init__(self, loop: ClosedLoop) -> None:
        super().__init__(loop)
        tables = tables_of(loop.arena.network, loop.strategy)
        rules, ranks = loop.rules, loop.ranks
        factor = loop.arena.scale // tables.scale
        if factor > MOST_FACTOR or max(rules.reaction, rules.instant) > MOST_DELAY:
            raise NotHeld
        if ranks is not None and any(abs(rank) >= MOST_RANK for rank in ranks.values()):
            raise NotHeld
        if any(_UNBOUNDED <= abs(bound) < INF for bound in loop.arena.start.m):
            raise NotHeld
        self._tables = tables
        settings: Dict[str, Any] = {
            "factor": factor,
            "reaction": rules.reaction,
            "must_end": rules.must_end,
            "instant": rules.instant,
            "goal": _numbered(tables, loop.goal),
            "bad": _numbered(tables, loop.bad),
            "start": [min(bound, _UNBOUNDED) for bound in loop.arena.start.m],
            "ranks": None if ranks is None else tables.numbers(ranks, 0),
        }
        self._native = tables.loop(settings)

    def everything(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """All that is reachable."""
        return self._found("all", depth, monitor) or super().everything(depth, monitor)

    def ends(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """Every play to its end, which has to be the goal."""
        return self._found("ends", depth, monitor) or super().ends(depth, monitor)

    def covered(self, monitor: LimitMonitor) -> Optional[Found]:
        """All that a safety strategy covers, at once (see `invariant`); None where plays may leave it."""
        result = self._searched("invariant", Depth(False, False, 0), monitor)
        if result is None:
            return super().covered(monitor)
        return None if result["number"] is None else Found(result["number"], self._used(result), None)

    def latest(
        self, clock: int, limit: int, monitor: LimitMonitor, left: Optional[Left] = None, many: int = 0
    ) -> Latest:
        """When the goal is reached at the latest, or `left` is, with at most so many symbolic states; `many` as in
        Depth."""
        result = self._searched("latest", Depth(self.loop.rules.prompt, False, limit, many), monitor, clock, left)
        if result is None:
            return super().latest(clock, limit, monitor, left, many)
        return Latest(result["number"], fails=result["fault"] >= 0)

    def _found(self, search: str, depth: Depth, monitor: LimitMonitor) -> Optional[Found]:
        result = self._searched(search, depth, monitor)
        if result is None:
            return None
        failure = None
        if result["fault"] >= 0:
            reason = _REASONS[result["fault"]]
            if reason == reasons.NO_PROGRESS:
                reason = reason.format(in_words(self._moves(result["step"])))
            elif reason == reasons.LIMIT:
                reason = reason.format(depth.limit)
            zone = Dbm(self.loop.arena.dim, tuple(INF if b >= _UNBOUNDED else b for b in result["zone"]))
            failure = Failure(reason, tuple(map(self._moves, result["steps"])), self._state(result["state"]), zone)
        return Found(result["states"], self._used(result), failure)

    def _searched(
        self, search: str, depth: Depth, monitor: LimitMonitor, clock: int = 0, left: Optional[Left] = None
    ) -> Optional[Dict[str, Any]]:
        """The result of a native search; None where the times that come up are too large for it."""
        task = {
            "search": search,
            "prompt": depth.prompt,
            "exact": depth.exact,
            "limit": depth.limit,
            "many": depth.many,
            "clock": clock,
            "left": _numbered(self._tables, () if left is None else (left,)),
        }
        try:
            return self._native.search(task, monitor.check)
        except OverflowError:
            return None

    def _used(self, result: Dict[str, Any]) -> Any:
        return frozenset(self._tables.keys(result["used"]))

    def _moves(self, edges: Sequence[int]) -> Tuple[Move, ...]:
        return tuple(self._tables.edges[k] for k in edges)

    def _state(self, numbers: List[int]) -> State:
        automata = self.loop.arena.network.automata
        places = tuple(automaton.locations[n].name for automaton, n in zip(automata, numbers))
        return places, tuple(numbers[len(automata) :])


def searches_of(loop: ClosedLoop) -> Searches:
    """The searches through the loop: native ones where they can be done."""
    try:
        return NativeSearches(loop)
    except NotHeld:
        return Searches(loop)


def _numbered(tables: Tables, places: Sequence[Tuple[int, str]]) -> List[Tuple[int, int]]:
    found: List[Tuple[int, int]] = []
    for k, name in places:
        names = [location.name for location in tables.network.automata[k].locations]
        found.append((k, len(names) - 1 - names[::-1].index(name)))
    return found
