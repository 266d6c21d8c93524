"""What a person asks for on the command line, and the proven solution that answers it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Tuple

from pursue_gen.cli.console import tell
from pursue_gen.cli.loss import why
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.solving.given_plan import take_plan
from pursue_gen.solving.options import asked_rules, games_to_try, verdict_text
from pursue_gen.solving.solution import CONTROLLABLE, Rules, Solution
from pursue_gen.solving.solvers import solved
from pursue_gen.synthesis.limits import NO_LIMITS, Limits
from pursue_gen.tga.network import Network, Objective

_GENERAL = "general"


@dataclass(frozen=True)
class Asked:
    """Which controllers, for which game, and where its plan comes from; None: what is done where nothing is said."""

    controllers: str = "distributed"
    reach_obj: str = "dedicated"
    ends: Optional[str] = None
    reaction: Optional[str] = None
    slack: Tuple[str, ...] = ()
    plan: Optional[Path] = None
    solver: Optional[str] = None
    verifytga: Optional[Path] = None
    optimize: Optional[str] = None
    limits: Limits = NO_LIMITS

    @property
    def decides_ends(self) -> bool:
        """A general controller decides the ends itself, unless something else is asked for."""
        return self.ends is None and self.controllers == _GENERAL

    def rules(self, network: Network) -> Rules:
        """The game that is asked for. Raises PursueError (exit status 2)."""
        return asked_rules(network, self._ends, self.reaction, self.slack)

    def games(self, network: Network) -> Tuple[Rules, ...]:
        """The games to try a plan in. Raises as `rules`."""
        return games_to_try(network, self._ends, self.reaction, self.slack)

    @property
    def _ends(self) -> Optional[str]:
        return CONTROLLABLE if self.decides_ends else self.ends


def solution_of(network: Network, objective: Objective, asked: Asked, quiet: bool = False) -> Solution:
    """The proven solution: of the plan that is given, or of a solver, whose progress is shown unless `quiet`.

    Raises what `take_plan` and `solved` do; with exit status 2 for options that contradict each other.
    """
    if asked.plan is not None:
        if asked.solver is not None or asked.verifytga is not None:
            raise usage_error("there is a plan, and a solver to make one", "use --plan or --solver, not both")
        return take_plan(asked.plan, network, objective, asked.games(network), asked.limits)
    rules = asked.rules(network)
    with progress_line(quiet) as progress:
        how = (asked.solver, asked.verifytga, asked.limits, None, progress, asked.optimize)
        return solved(network, objective, rules, *how)


def told_solution(network: Network, objective: Objective, asked: Asked, explained: Optional[Path] = None) -> Solution:
    """As `solution_of`, and a solver's verdict is told.

    `explained`: the scenario's file; where it cannot be won, what would change that is looked for and told as well.
    """
    try:
        won = solution_of(network, objective, asked)
    except PursueError as problem:
        if explained and why(problem, (explained,), asked.rules(network), True, asked.limits):
            raise PursueError((), problem.exit_status) from None  # its findings are told
        raise
    if asked.plan is None:
        tell(verdict_text(won.rules, won))
    return won
