"""Solvers of the games: the built-in one, or UPPAAL-TIGA's verifytga where it is installed.

What only UPPAAL-TIGA needs is imported when it is used.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from pursue_gen.diagnostics import usage_error
from pursue_gen.outcomes import LimitHit
from pursue_gen.solving.calm import calm
from pursue_gen.solving.deadlines import fastest_solution
from pursue_gen.solving.options import DEFAULT, SolveOptions
from pursue_gen.solving.quick import quick, within
from pursue_gen.solving.rules import Rules, played
from pursue_gen.solving.solution import Solution, check_goal, guaranteed, solution
from pursue_gen.synthesis.enforced import enforced
from pursue_gen.synthesis.limits import Limits
from pursue_gen.tga.network import Network, Objective

_FASTEST, _FIRST = "time", "none"
"""What `optimize` may be; None: a quick strategy."""


def solved(network: Network, objective: Objective, rules: Rules, options: SolveOptions = DEFAULT) -> Solution:
    """The proven solution of the solver that the options name.

    Raises as `solution`, `fastest_solution` and `run_verifytga` do; with exit status 2 for options that contradict
    each other.
    """
    if options.solver is None:
        if options.verifytga is not None:
            raise usage_error("--verifytga names a program that is not used", "add --solver verifytga")
        return _built_in(network, objective, rules, options)
    if options.optimize is not None or options.within is not None:
        hint = "leave out --solver, or --optimize and --within"
        raise usage_error("UPPAAL-TIGA's solver does not look at the time to the goal", hint)
    from pursue_gen.solving.verifytga import run_verifytga

    game = played(network, rules)
    verdict = run_verifytga(game, objective, options.verifytga, options.limits, rules.reaction, options.progress)
    assert verdict.strategy is not None  # it raises where there is none
    won = Solution(game, objective, verdict.strategy, rules.reaction, verdict.stats, rules=rules)
    return _timed(won, options.limits)


def _built_in(network: Network, objective: Objective, rules: Rules, options: SolveOptions) -> Solution:
    """The proven solution of the built-in solver: as quick as the options ask for."""
    start = options.limits.now()
    if options.within is not None:
        check_goal(objective, "--within")
        if options.optimize is not None:
            message = "the time to the goal is given, and to be optimized"
            raise usage_error(message, "use --within or --optimize, not both")
        return within(solution(network, objective, rules, options), options.within, options.since(start))
    if options.optimize == _FASTEST:
        return fastest_solution(network, objective, rules, options)
    won = solution(network, objective, rules, options)
    left = options.since(start)
    if options.optimize == _FIRST:
        return _timed(won, left.limits)
    with suppress(LimitHit), enforced(left.limits.chosen):
        return quick(won, left) if objective.reaches else calm(won, left)
    return won  # what is proven stays so


def _timed(won: Solution, limits: Limits) -> Solution:
    """With the worst-case time of the strategy, where that is quickly computed."""
    return replace(won, guarantee=guaranteed(won, limits=limits)) if won.objective.reaches else won
