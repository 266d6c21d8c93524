"""A new plan by which robots go on with the tours of the workspace's plan."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Optional, Tuple

from pursue_gen.diagnostics import PursueError
from pursue_gen.solving.due_moves import patrols
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.tours_again import Now
from pursue_gen.solving.tours_beside import goes_on
from pursue_gen.synthesis.plan_parts import read_own
from pursue_gen.synthesis.strategy import Strategy, with_automata_of
from pursue_gen.tga.network import Network, Objective
from pursue_gen.tools.replanning.request import Request, wrong
from pursue_gen.tools.replanning.start import around, network_from, start_clocks

_LATE = (Fraction(5), Fraction(2), Fraction(0))
"""So many time units later than expected a plan may come into force, tried in this order. Measured on a patrol of six
rooms by two robots."""


def tours_from_here(
    game: Network, objective: Objective, own: Strategy, request: Request, options: SolveOptions
) -> Optional[Tuple[Strategy, Network]]:
    """A proven strategy with the tours of the workspace's own one, and its network; None where they do not keep what is
    asked for."""
    if not own.tours or request.turning:  # who turns round is off its tour
        return None
    network = network_from(with_automata_of(game, own), request, told_apart=True)
    clocks = start_clocks(network, request)
    start, patrolled = options.limits.now(), patrols(game)
    gone = request.excused | request.out_of_service
    for late in _LATE:
        whenever = replace(network, start=around(network.start, request.ahead, late))
        now = Now(clocks, late)
        left = options.since(start)
        found = goes_on(whenever, objective, request.rules.reaction, own, now, gone, patrolled, left)
        if found is not None:
            return found, whenever
    return None


def followers(game: Network, request: Request) -> Strategy:
    """The workspace's strategy with its watchers and tours alone. Raises PursueError (exit status 2) for such as the
    game cannot have."""
    text = "\n".join(request.follows)
    try:
        return read_own(text, game, "game.yaml")
    except PursueError as problem:
        message = problem.diagnostics[0].message
        raise wrong(f"follows: {message}", "the lines of the plan of this scenario") from None
