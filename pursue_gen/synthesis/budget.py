"""One budget for several games: of work, and of seconds where a person has set a limit."""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import AbstractSet, FrozenSet, Hashable, List, Optional, Tuple

from pursue_gen.outcomes import LimitHit
from pursue_gen.synthesis.engine import Engine
from pursue_gen.synthesis.limits import NOTHING_YET, SOLVING, Limits, Listener, limit_reached
from pursue_gen.synthesis.solve import NATIVE, Stats, Verdict, guess, solve
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network, Objective

_PER_EDGE = 200
"""Work that counts for an edge of a network: it is translated for the engine, in about the time of so many steps.
Measured on catch the thief and drug delivery."""

_PER_STATE = 100
"""Work that counts for a discrete state of a game that has too many: these are explored, and hardly anything else is
done. Measured on labs 92 and 112."""


@dataclass(frozen=True)
class TooLarge:
    """What can be done in a safety game that is not decided within `most` of a limit, `which` is "states" or "work",
    without pauses or with them."""

    moves: FrozenSet[Hashable]
    which: str
    most: int
    without_pauses: bool

    def shows(self, moves: FrozenSet[Hashable], limits: Limits, without_pauses: bool) -> bool:
        """True if a game in which all that and perhaps more can be done, whatever its numbers, is likely to be too
        large as well: without pauses it has no fewer states."""
        allowed = limits.states if self.which == "states" else limits.work
        alike = self.without_pauses == without_pauses or (without_pauses and self.which == "states")
        return alike and 0 < allowed <= self.most and self.moves <= moves


class Budget:
    """How much is left of limits that several games share; a game ends where its part is used up.

    The limit on memory is one for each game. `progress` is called with this phase; `engine` and `whole` as
    for `solve`. `large`: safety games that are too large, in which what is found is noted: one that can do all that one
    of these can, whatever the numbers in it, is tried only with more than that.
    """

    def __init__(
        self,
        limits: Limits,
        progress: Optional[Listener] = None,
        engine: Engine = NATIVE,
        phase: str = SOLVING,
        whole: bool = False,
        large: Optional[List[TooLarge]] = None,
    ) -> None:
        self._large: List[TooLarge] = [] if large is None else large
        self._limits, self._engine, self._games_whole = limits, engine, whole
        self._whole: Optional[Budget] = None
        self._progress = progress and (lambda reached: progress(replace(reached, phase=phase)))
        self._start = limits.now()
        self.work: float = limits.work or math.inf

    @property
    def used_up(self) -> bool:
        """True if nothing is left."""
        late = bool(self._limits.seconds) and self._limits.since(self._start).left < 1e-6
        return self.work < 1 or late

    def part(self, share: float = 1.0) -> Limits:
        """That share of what is left, of 0 to 1."""
        assert 0 <= share <= 1
        work = max(1, int(self.work * share)) if self.work < math.inf else 0
        return replace(self._limits, seconds=self._limits.since(self._start).left * share, spent=0.0, work=work)

    @property
    def for_proofs(self) -> Limits:
        """What is left of seconds and memory: the checker counts symbolic states instead of work."""
        return replace(self.part(), states=0, work=0)

    def verdict(
        self,
        network: Network,
        objective: Objective,
        reaction: Fraction,
        share: float = 1.0,
        soonest: bool = False,
        without_pauses: bool = False,
        first: Optional[int] = None,
    ) -> Verdict:
        """The verdict of `solve`. Raises LimitHit where that share of what is left is too little."""
        limits = self.part(share)
        if self.used_up:
            raise limit_reached("work" if self.work < 1 else "seconds", limits, NOTHING_YET)
        self.spend(_PER_EDGE * sum(len(automaton.edges) for automaton in network.automata))
        moves = _moves(network)
        for some in () if objective.reaches else self._large:
            if some.shows(moves, limits, without_pauses):
                raise limit_reached(some.which, limits, NOTHING_YET)
        try:
            how = self._engine, limits, self._progress, self._games_whole, soonest, without_pauses, first
            verdict = solve(network, objective, reaction, *how)
        except LimitHit as limit:
            most = {"states": limits.states, "work": limits.work}
            if limit.which in most and not objective.reaches:
                self._large.append(TooLarge(moves, limit.which, most[limit.which], without_pauses))
            self.spend(min(limits.work, _PER_STATE * limits.states) if limit.which == "states" else limits.work)
            raise
        self.spend(verdict.stats.work)
        return verdict

    def guess(
        self,
        network: Network,
        objective: Objective,
        reaction: Fraction,
        share: float,
        without_pauses: bool = False,
        late: AbstractSet[str] = frozenset(),
        turns: bool = False,
    ) -> Optional[Tuple[Strategy, Stats]]:
        """What `solve.guess` finds with that share of what is left, and what it took."""
        limits = self.part(share)
        how = self._engine, limits, self._progress, self._games_whole, without_pauses, late, turns
        try:
            strategy, stats = guess(network, objective, reaction, *how)
        except LimitHit:
            self.spend(limits.work)
            return None
        self.spend(stats.work)
        return None if strategy is None else (strategy, stats)

    def split(self, share: float, states: int = 0) -> Budget:
        """A budget of that share of what is left; what it spends is spent of this one too. `states`: the most discrete
        states of each of its games, if fewer than now."""
        some, limits = copy.copy(self), self.part(share)
        fewest = min(filter(None, (states, limits.states)), default=0)
        some._whole, some._limits, some.work = self, replace(limits, states=fewest), self.work * share
        some._start = self._limits.now()
        return some

    def with_work(self, work: float) -> Budget:
        """A budget of so much work, kept for later from what there was at first, and of the seconds that are left."""
        some = self.split(1)
        some.work = work
        return some

    def spend(self, work: float) -> None:
        """Counts work that something else did, 0 or more."""
        assert work >= 0
        self.work -= work
        if self._whole is not None:
            self._whole.spend(work)


def _moves(network: Network) -> FrozenSet[Hashable]:
    """Where all begin, and what each may do there and elsewhere, whatever the guards."""
    begins = [(automaton.name, automaton.initial) for automaton in network.automata]
    edges = ((name, edge.source, edge.target, edge.channel) for name, edge in network.edges)
    return frozenset((*begins, *network.variables, *edges))
