"""How hard strategies in shares are looked for (see `shares`)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Effort:
    """How hard shares are looked for: `work` for all games of groups, `game` for one of them, which has at most so many
    discrete `states` and `clocks` (of more, zones cost more than is counted). `thorough`: games that are not won with
    some hidden are played with all of them as well; `free`: they are played without the pauses of the environment;
    `joins`: groups that cannot be played beside each other are joined; `nobody`: what never happens while all stand
    still may be nobody's task, until what others are commanded shows that somebody has to see to it. `few`: only half
    as many robots as promises keep them all, by a policy, where all robots can; `pairs`: what has no deadline may be
    two robots' task also where one can see to it, as that one may be needed elsewhere once the other is there;
    `varied`: ways in which few promises go to another than the first choice come first (limited discrepancy search,
    Harvey and Ginsberg 1995).
    """

    work: int
    game: int = 20_000_000
    states: int = 20_000
    clocks: int = 6
    thorough: bool = False
    free: bool = True
    joins: bool = True
    nobody: bool = False
    few: bool = False
    pairs: bool = False
    varied: bool = False


EFFORTS = (
    Effort(1_000_000, few=True),
    Effort(10_000_000, game=150_000, joins=False, nobody=True),
    Effort(30_000_000, game=1_000_000),
    Effort(40_000_000, game=4_000_000, joins=False, pairs=True, varied=True),
    Effort(80_000_000, game=10_000_000, joins=False, varied=True),
    Effort(80_000_000, game=4_000_000),
    Effort(60_000_000, thorough=True),
    Effort(60_000_000, thorough=True, free=False),
)
"""One after the other, until one wins: few groups that need more than the first are won with little work."""
