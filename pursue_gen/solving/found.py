"""What an attempt to win a game with less work has found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence

from pursue_gen.synthesis.solve import Stats
from pursue_gen.synthesis.strategy import Strategy


@dataclass(frozen=True)
class Found:
    """A proven strategy, and what it took to find it."""

    strategy: Strategy
    stats: Stats


def stats_of_all(verdicts: Sequence[Stats]) -> Stats:
    """What several games took together: at least one."""
    counts = [(some.discrete_states, some.zones, some.seconds, some.symbolic_states, some.work) for some in verdicts]
    states, zones, seconds, symbolic, work = (sum(column) for column in zip(*counts))
    return Stats(verdicts[0].engine, int(states), int(zones), seconds, int(symbolic), int(work))
