"""An allowance of seconds for many solver runs."""

from __future__ import annotations

import time
from dataclasses import replace
from fractions import Fraction
from typing import Optional

from pursue_gen.diagnostics import PursueError, error
from pursue_gen.synthesis.limits import Limits, Listener
from pursue_gen.synthesis.solve import Verdict, solve
from pursue_gen.tga.network import Network, Objective

EXPLAINING = "explaining"


class TimeBudget:
    """How much of an allowance of seconds is left; solver runs that are cut off when it is used up.

    The limit on memory is one for each of them. The listener, where there is one, learns how far each of them is.
    """

    def __init__(self, limits: Limits, progress: Optional[Listener] = None) -> None:
        self._limits, self._listener = limits, progress
        self._end = time.monotonic() + limits.seconds

    def left(self) -> float:
        """Seconds."""
        return self._end - time.monotonic()

    def verdict(self, network: Network, objective: Objective, reaction: Fraction, share: float = 1.0) -> Verdict:
        """The verdict of `solve`. Raises PursueError (exit status 5) when that share of the time left is too short."""
        seconds = self.left() * share
        if seconds <= 0:
            raise PursueError([error("EXP001", "no verdict in the time that was left")], exit_status=5)
        listener = self._listener
        report = listener and (lambda progress: listener(replace(progress, phase=EXPLAINING)))
        return solve(network, objective, reaction, limits=Limits(seconds, self._limits.memory), progress=report)
