"""How hard strategies in shares are looked for (see `shares`)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Effort:
    """How much work the search for shares may spend, and what it tries.

    `work`: for all games of groups; `game`: for one of them, which has at most so many discrete `states` and `clocks`
    (with more clocks a zone costs more than is counted); `guess`: for its policies, as a unit of that work takes five
    times as long. `thorough`: a group's game that is not won with others hidden is played with everybody as well.
    `free`: the environment's pauses are left out. `joins`: groups that cannot be played beside each other are joined.
    `nobody`: a promise that holds while all robots stand still is given to nobody, until other robots' commands show
    that somebody has to keep it. `few`: half as many robots as promises keep all of them, by a policy. `turns`: all
    robots keep all of them, by a policy by which those that are in each other's way leave their homes in turns.
    `pairs`: a promise without a deadline may be given to two robots though one can keep it. `varied`: ways in which few
    promises go to another team than their first choice come first (limited discrepancy search, Harvey and Ginsberg
    1995).
    """

    work: int
    game: int = 20_000_000
    guess: int = 2_500_000
    states: int = 20_000
    clocks: int = 6
    thorough: bool = False
    free: bool = True
    joins: bool = True
    nobody: bool = False
    few: bool = False
    turns: bool = False
    pairs: bool = False
    varied: bool = False


EFFORTS = (
    Effort(1_000_000, few=True),
    Effort(10_000_000, game=150_000, guess=37_500, states=6_000, joins=False, nobody=True),
    Effort(60_000_000, game=10_000_000, guess=200_000),
    Effort(4_000_000, turns=True),
    Effort(40_000_000, game=4_000_000, guess=1_000_000, joins=False, pairs=True, varied=True),
    Effort(80_000_000, game=10_000_000, guess=1_000_000, joins=False, varied=True),
    Effort(80_000_000, game=4_000_000, guess=1_000_000),
    Effort(60_000_000, thorough=True),
    Effort(60_000_000, thorough=True, free=False),
)
"""One after the other, until one wins: few groups that need more than the first are won with little work. Measured on
200 lab scenarios: of 290 policies that win the dearest took 31,000 units of work in the second, 139,000 in the third,
629,000 in the fifth; of four fleets on lanes three took 0.5 to 0.8 million in the fourth."""
