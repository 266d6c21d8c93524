"""How a game is solved: the limits, the engine, and what the strategy is optimized for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import Optional

from pursue_gen.synthesis.engine import Engine
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.solve import NATIVE


@dataclass(frozen=True)
class SolveOptions:
    """What solving and proving share; nothing in it changes which game is played.

    `limits` hold for solving and proving together; `progress` is called a few times a second. `engine`: the
    solver's own, or another one of its contract. `optimize`: "time" for the strategy with the least
    worst-case time to the goal, "none" for the first one found, None for a quick one that is found with little work.
    `within`: the goal has to be reached in so many time units; None: some time. `whole`: what cannot matter is not left
    out of the game, and the game is solved in one piece (an experiment). `solver`: None for the built-in solver,
    "verifytga" for UPPAAL-TIGA's, which is at the path `verifytga` or on PATH. `most_work`: the work after which a game
    in one piece is given up, whatever else has been tried before; 0: none.
    """

    limits: Limits = NO_LIMITS
    engine: Engine = NATIVE
    progress: Optional[Listener] = None
    optimize: Optional[str] = None
    within: Optional[Fraction] = None
    whole: bool = False
    solver: Optional[str] = None
    verifytga: Optional[Path] = None
    most_work: int = 0

    @property
    def in_one_piece(self) -> Limits:
        """The limits of a game in one piece."""
        return replace(self.limits, work=self.most_work) if self.most_work else self.limits

    def since(self, start: float) -> SolveOptions:
        """The same with the limits that are left of work that began at `start` (of `limits.now`)."""
        return replace(self, limits=self.limits.since(start))


DEFAULT = SolveOptions()
