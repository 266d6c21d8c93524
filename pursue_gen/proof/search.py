"""What the checker searches the closed loop for, and the searches in Python (the native ones: `native.search`)."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from functools import reduce
from typing import Deque, Dict, FrozenSet, List, Optional, Sequence, Tuple

from pursue_gen.proof import reasons
from pursue_gen.proof.closed_loop import ClosedLoop, Entry
from pursue_gen.proof.delays import Broken
from pursue_gen.proof.extrapolation import MaxConstants
from pursue_gen.proof.invariant import is_invariant
from pursue_gen.proof.moves import JointMove, State
from pursue_gen.proof.zones import with_neighbours
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.synthesis.strategy import Move, ZoneKey
from pursue_gen.zones.dbm import INF, Dbm, constant

_OFTEN = 8
"""A discrete state so often on one play of a reach game is searched for a loop that clocks hide. Not measured."""


@dataclass(frozen=True)
class Failure:
    """Why a strategy fails, the moves of the play that leads there, the discrete state, and the points of it."""

    reason: str
    play: Tuple[Tuple[Move, ...], ...]
    state: State
    zone: Dbm


@dataclass(frozen=True)
class Found:
    """The outcome of a search: so many symbolic states, the zones of the strategy that plays reach, the failure."""

    states: int
    used: FrozenSet[ZoneKey]
    failure: Optional[Failure]


@dataclass(frozen=True)
class Depth:
    """How a search is done: `prompt` as `delays.Rules` has it; `exact`: zones are not extrapolated; at most `limit`
    symbolic states; so `many` zones of a discrete state become one (0: never)."""

    prompt: bool
    exact: bool
    limit: int
    many: int = 0


Left = Tuple[int, str]
"""The number of an automaton, and the location that it leaves."""


@dataclass(frozen=True)
class Latest:
    """The largest (scaled) value of a clock at the goal, or where a location is left; None: nothing bounds it, it was
    not found out within the limit, or the strategy `fails` when it is played so."""

    value: Optional[int]
    fails: bool = False


class Searches:
    """The searches through a closed loop, in Python. Each raises PursueError where the monitor does."""

    def __init__(self, loop: ClosedLoop) -> None:
        self.loop = loop

    def everything(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """All that is reachable."""
        self._begin(depth)
        return _everything(self.loop, depth, monitor)

    def ends(self, depth: Depth, monitor: LimitMonitor) -> Found:
        """Every play to its end, which has to be the goal."""
        self._begin(depth)
        return _ends(self.loop, depth, monitor)

    def covered(self, monitor: LimitMonitor) -> Optional[Found]:
        """All that a safety strategy covers, at once (see `invariant`); None where plays may leave it."""
        self._begin(Depth(False, False, 0))
        zones = is_invariant(self.loop, monitor)
        return None if zones is None else Found(zones, frozenset(self.loop.used), None)

    def latest(
        self, clock: int, limit: int, monitor: LimitMonitor, left: Optional[Left] = None, many: int = 0
    ) -> Latest:
        """When the goal is reached at the latest, or `left` is, with at most so many symbolic states; `many` as in
        Depth."""
        try:
            return Latest(_latest(self.loop, clock, limit, monitor, left, many))
        except Broken:
            return Latest(None, fails=True)

    def _begin(self, depth: Depth) -> None:
        self.loop.rules, self.loop.used = replace(self.loop.rules, prompt=depth.prompt), set()


def _everything(loop: ClosedLoop, depth: Depth, monitor: LimitMonitor) -> Found:
    """Breadth first."""
    start: Entry = (loop.arena.initial, loop.arena.start)
    hulled = False
    found: List[Tuple[Entry, int, Optional[JointMove]]] = [(start, -1, None)]
    passed: Dict[State, List[Dbm]] = {start[0]: [start[1]]}
    pending: Deque[int] = deque([0])

    def steps_to(n: int) -> List[JointMove]:
        steps: List[JointMove] = []
        while n >= 0:
            _, n, move = found[n]
            steps += [] if move is None else [move]
        return steps[::-1]

    while pending:
        monitor.check(len(found), len(pending))
        n = pending.popleft()
        (state, zone), _, _ = found[n]
        if not any(other is zone for other in passed[state]):
            continue
        try:
            successors = loop.successors((state, zone))
        except Broken as broken:
            if hulled:
                loop.used = set()
                return _everything(loop, replace(depth, many=0), monitor)
            return _failed(loop, broken.reason, steps_to(n), state, broken.zone, len(found))
        for move, (target, after) in successors:
            after = after if depth.exact else loop.max_constants.extrapolate(after, target)
            known = passed.setdefault(target, [])
            if any(other.includes(after) for other in known):
                continue
            if len(found) >= depth.limit:
                reason = reasons.LIMIT.format(depth.limit)
                return _failed(loop, reason, [*steps_to(n), move], target, after, len(found))
            if not depth.exact:
                if depth.many and len(known) >= depth.many:
                    after, hulled = reduce(Dbm.hull, known, after), True
                else:
                    after = with_neighbours(after, known)
            known[:] = [other for other in known if not after.includes(other)] + [after]
            found.append(((target, after), n, move))
            pending.append(len(found) - 1)
    return Found(len(found), frozenset(loop.used), None)


@dataclass
class _PathEntry:
    """An entry on the current play, with the entries after it that are still to be proven."""

    entry: Entry
    move: Optional[JointMove]
    left: List[Tuple[JointMove, Entry]]


def _ends(loop: ClosedLoop, depth: Depth, monitor: LimitMonitor) -> Found:
    """Depth first: an entry is proven when all that may follow it are, so every play ends in the goal."""
    proven: Dict[State, List[Dbm]] = {}
    open_zones: Dict[State, List[Dbm]] = {}
    path: List[_PathEntry] = []
    states = 0
    coming: Optional[Tuple[Optional[JointMove], Entry]] = (None, (loop.arena.initial, loop.arena.start))

    def failed(reason: str, move: Optional[JointMove], state: State, zone: Dbm) -> Found:
        steps = [step.move for step in path if step.move is not None] + ([] if move is None else [move])
        return _failed(loop, reason, steps, state, zone, states)

    while coming is not None or path:
        monitor.check(states, len(path))
        if coming is None:
            step = path[-1]
            if step.left:
                coming = step.left.pop()
            else:
                path.pop()
                state, zone = step.entry
                open_zones[state].pop()
                known = proven.setdefault(state, [])
                known[:] = [other for other in known if not zone.includes(other)] + [zone]
            continue
        move, (state, zone) = coming
        coming = None
        zone = zone if depth.exact else loop.max_constants.extrapolate(zone, state)
        if loop.won(state) or any(other.includes(zone) for other in proven.get(state, ())):
            continue
        on_path = open_zones.setdefault(state, [])
        if _comes_back(on_path, zone, loop, state):
            return failed(reasons.FOR_EVER, move, state, zone)
        if states >= depth.limit:
            return failed(reasons.LIMIT.format(depth.limit), move, state, zone)
        states += 1
        try:
            successors = loop.successors((state, zone))
        except Broken as broken:
            return failed(broken.reason, move, state, broken.zone)
        on_path.append(zone)
        path.append(_PathEntry((state, zone), move, successors))
    return Found(states, frozenset(loop.used), None)


def _comes_back(on_path: Sequence[Dbm], zone: Dbm, loop: ClosedLoop, state: State) -> bool:
    """True if a play may go round for ever.

    With exact zones each point of the zone has a predecessor in the earlier one on the path. When the zone includes
    that one, there are plays of every length, and so endless ones; likewise if it changes only in what no guard sees.
    """
    if any(zone.includes(other) for other in on_path):
        return True
    if len(on_path) < _OFTEN:
        return False
    max_constants: MaxConstants = loop.max_constants
    widened = max_constants.extrapolate(zone, state)
    return any(widened == max_constants.extrapolate(other, state) for other in on_path)


def _latest(
    loop: ClosedLoop, clock: int, limit: int, monitor: LimitMonitor, left: Optional[Left], many: int
) -> Optional[int]:
    """The largest value of the clock at the goal, or with the steps that leave a location, breadth first."""
    latest = 0
    start: Entry = (loop.arena.initial, loop.arena.start)
    passed: Dict[State, List[Dbm]] = {start[0]: [start[1]]}
    pending: Deque[Entry] = deque([start])
    met = 1
    while pending:
        state, zone = pending.popleft()
        if not any(other is zone for other in passed[state]):
            continue
        if loop.won(state):
            latest = latest if left else max(latest, zone.m[clock * zone.dim])
            if latest >= INF:
                return None
            continue
        monitor.check(met, len(pending))
        for _, (target, after) in loop.successors((state, zone)):
            if left and state[0][left[0]] == left[1] != target[0][left[0]]:
                latest = max(latest, after.m[clock * after.dim])
                if latest >= INF:
                    return None
            after = loop.max_constants.extrapolate(after, target)
            known = passed.setdefault(target, [])
            if any(other.includes(after) for other in known):
                continue
            met += 1
            if met > limit:
                return None
            after = reduce(Dbm.hull, known, after) if many and len(known) >= many else with_neighbours(after, known)
            known[:] = [other for other in known if not after.includes(other)] + [after]
            pending.append((target, after))
    return constant(latest)


def _failed(
    loop: ClosedLoop, reason: str, steps: Sequence[JointMove], state: State, zone: Dbm, states: int
) -> Found:
    return Found(states, frozenset(loop.used), Failure(reason, tuple(move.moves for move in steps), state, zone))
