"""The searches through a closed loop, in readable Python: the twins of those in C++ (proof/native/search.hpp)."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace
from functools import reduce
from typing import Deque, Dict, List, Optional, Sequence, Tuple

from pursue_gen.proof import reasons
from pursue_gen.proof.closed_loop import ClosedLoop, Depth, Entry, Failure, Found, Latest, Left
from pursue_gen.proof.moves import JointMove, State
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.zones.dbm import INF, Dbm, constant
from tests.oracle.closed_loop import LoopInPython
from tests.oracle.delays import Broken
from tests.oracle.extrapolation import MaxConstants
from tests.oracle.invariant import is_invariant
from tests.oracle.unions import with_neighbours
from tests.oracle.zones import hull

_OFTEN = 8
"""As `often` of search.hpp."""


def everything(loop: ClosedLoop, depth: Depth, monitor: LimitMonitor) -> Found:
    """As `ClosedLoop.everything`."""
    return _everything(_begun(loop, depth), depth, monitor)


def ends(loop: ClosedLoop, depth: Depth, monitor: LimitMonitor) -> Found:
    """As `ClosedLoop.ends`."""
    return _ends(_begun(loop, depth), depth, monitor)


def covered(loop: ClosedLoop, monitor: LimitMonitor) -> Optional[Found]:
    """As `ClosedLoop.covered`."""
    begun = _begun(loop, Depth(False, False, 0))
    zones = is_invariant(begun, monitor)
    return None if zones is None else Found(zones, frozenset(begun.used), None)


def latest(
    loop: ClosedLoop,
    clock: int,
    limit: int,
    monitor: LimitMonitor,
    left: Optional[Left] = None,
    many: int = 0,
    start: Optional[Entry] = None,
) -> Latest:
    """As `ClosedLoop.latest`."""
    begun = _begun(loop, Depth(loop.rules.instant > 0, False, limit))
    search = _Latest(begun, clock, limit, left, many)
    try:
        return Latest(search.found(start or loop.start, monitor), states=search.looked)
    except Broken:
        return Latest(None, fails=True, states=search.looked)


def _begun(loop: ClosedLoop, depth: Depth) -> LoopInPython:
    """The closed loop in Python: what one search works out serves the next ones."""
    own: LoopInPython = loop.__dict__.setdefault("in_python", LoopInPython(loop))
    own.rules, own.used = replace(own.rules, prompt=depth.prompt), set()
    return own


def _everything(loop: LoopInPython, depth: Depth, monitor: LimitMonitor) -> Found:
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
                    after, hulled = reduce(hull, known, after), True
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


def _ends(loop: LoopInPython, depth: Depth, monitor: LimitMonitor) -> Found:
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


def _comes_back(on_path: Sequence[Dbm], zone: Dbm, loop: LoopInPython, state: State) -> bool:
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


@dataclass
class _Latest:
    """The search for the largest value of a clock; so many symbolic states are `looked` at."""

    loop: LoopInPython
    clock: int
    limit: int
    left: Optional[Left]
    many: int
    looked: int = 0

    def found(self, start: Entry, monitor: LimitMonitor) -> Optional[int]:
        """The largest value of the clock at the goal, or with the steps that leave a location, breadth first."""
        latest, loop, left = 0, self.loop, self.left
        passed: Dict[State, List[Dbm]] = {start[0]: [start[1]]}
        pending: Deque[Entry] = deque([start])
        while pending:
            state, zone = pending.popleft()
            if not any(other is zone for other in passed[state]):
                continue
            if loop.won(state):
                latest = latest if left else max(latest, zone.m[self.clock * zone.dim])
                if latest >= INF:
                    return None
                continue
            monitor.check(self.looked, len(pending))
            self.looked += 1
            if self.looked > self.limit:
                return None
            for _, (target, after) in loop.successors((state, zone)):
                if left and state[0][left[0]] == left[1] != target[0][left[0]]:
                    latest = max(latest, after.m[self.clock * after.dim])
                    if latest >= INF:
                        return None
                after = loop.max_constants.extrapolate(after, target)
                known = passed.setdefault(target, [])
                if any(other.includes(after) for other in known):
                    continue
                hulled = self.many and len(known) >= self.many
                after = reduce(hull, known, after) if hulled else with_neighbours(after, known)
                known[:] = [other for other in known if not after.includes(other)] + [after]
                pending.append((target, after))
        return constant(latest)


def _failed(
    loop: LoopInPython, reason: str, steps: Sequence[JointMove], state: State, zone: Dbm, states: int
) -> Found:
    return Found(states, frozenset(loop.used), Failure(reason, tuple(move.moves for move in steps), state, zone))
