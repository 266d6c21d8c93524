"""A safety strategy as its own certificate: no play leaves the points that it covers.

Plays are not followed. Each discrete state is checked once, as if every point for which the strategy says something
could be entered: from there time, commands (on their way, too) and all that the environment can do must lead to points
that are covered again.

Why that is enough: the game starts at covered points, and from all covered points of a discrete state the closed loop
finds no failure and no step but to covered points, so by induction over the steps of a play each is taken from a
covered point, and none fails. A play from one point is among those from all of them, so what the checker's walk through
the reached points would find, it finds here; the reverse does not hold, as covered points need not be reached.
"""

from __future__ import annotations

from collections import deque
from typing import Deque, Dict, Optional, Set

from pursue_gen.proof.moves import State
from pursue_gen.synthesis.limits import LimitMonitor
from pursue_gen.zones.dbm import Dbm
from tests.oracle.closed_loop import LoopInPython
from tests.oracle.delays import Broken
from tests.oracle.unions import outside


def is_invariant(loop: LoopInPython, monitor: LimitMonitor) -> Optional[int]:
    """The number of zones that were checked, if no play leaves what the strategy of a safety game covers.

    None where that is not so; then the strategy may win all the same. Only discrete states that steps lead to count,
    and only those are among what the loop then has as used.
    """
    start = loop.arena.initial
    if outside(loop.arena.start, loop.covered(start)):
        return None
    known: Dict[State, Set[Dbm]] = {start: set()}
    pending: Deque[State] = deque([start])
    while pending:
        monitor.check(len(known), len(pending))
        try:
            steps = loop.steps_from_all(pending.popleft())
        except Broken:
            return None
        for _, (target, after) in steps:
            if target not in known:
                known[target] = set()
                pending.append(target)
            if after not in known[target]:
                if outside(after, loop.covered(target)):
                    return None
                known[target].add(after)
    return sum(len(loop.covered(state)) for state in known)
