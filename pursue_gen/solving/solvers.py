"""Whose solver finds the strategy: the built-in one, or UPPAAL-TIGA's where somebody has it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Optional, Tuple

from pursue_gen.cli.console import tell
from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.files import write_texts
from pursue_gen.proof.checker import LIMIT
from pursue_gen.proof.margin import USUAL, Margin, game_margin, strategy_margin
from pursue_gen.solving.solution import Rules, Solution, fastest_solution, guaranteed, played, solution
from pursue_gen.solving.verifytga import ToolError, run_verifytga
from pursue_gen.synthesis.limits import NO_LIMITS, Limits, Listener
from pursue_gen.synthesis.plan import write_plan
from pursue_gen.tga.network import Kind, Network, Objective


def solved(
    network: Network,
    objective: Objective,
    rules: Rules,
    solver: Optional[str] = None,
    verifytga: Optional[Path] = None,
    limits: Limits = NO_LIMITS,
    engine: Optional[str] = None,
    progress: Optional[Listener] = None,
    optimize: Optional[str] = None,
) -> Solution:
    """The proven solution, of the built-in solver (None) or of "verifytga", which is at the path `verifytga`.

    The rest is as for `pipeline.solution`, or with `optimize` "time" as for `pipeline.fastest_solution`, and it raises
    as these and `run_verifytga` do; with exit status 2 for options that contradict each other.
    """
    if solver is None:
        if verifytga is not None:
            raise usage_error("--verifytga names a program that is not used", "add --solver verifytga")
        if optimize is not None:
            return fastest_solution(network, objective, rules, limits, engine, progress)
        return _timed(solution(network, objective, rules, limits, engine, progress), limits)
    if optimize is not None:
        raise usage_error("UPPAAL-TIGA's solver does not look for the least time", "leave out --optimize or --solver")
    if engine is not None:
        raise usage_error(
            f"{engine} is an engine of the built-in solver", "use --engine or --solver verifytga, not both"
        )
    game = played(network, rules)
    verdict = run_verifytga(game, objective, verifytga, limits, rules.reaction, progress)
    assert verdict.strategy is not None  # it raises where there is none
    won = Solution(game, objective, verdict.strategy, rules.reaction, verdict.stats, rules=rules)
    return _timed(won, limits)


def _timed(won: Solution, limits: Limits) -> Solution:
    """With what the strategy guarantees, where that is quickly found."""
    return won if won.objective.kind is Kind.SAFETY else replace(won, guarantee=guaranteed(won, limits=limits))


def keep_counter(problem: PursueError, network: Network, objective: Objective, plan: Optional[Path]) -> None:
    """Writes the counter-strategy of verifytga, where there is one, beside the file that is named for the plan."""
    if not isinstance(problem, ToolError) or problem.counter is None or plan is None:
        return
    if plan.exists() and not plan.is_file():  # nothing stands beside /dev/null
        return
    kept = plan.with_name(f"{plan.stem}_failed{plan.suffix}")
    write_texts({kept: write_plan(problem.counter, network, objective)})
    tell(f"The counter-strategy is in {kept}")


def margins(won: Solution, thorough: bool, limits: Limits) -> Tuple[Margin, Optional[Margin]]:
    """The margin of the strategy, as far as it is quickly found; `thorough`: all of it, and the game's as well."""
    states = LIMIT if thorough else USUAL
    margin = strategy_margin(won.network, won.objective, won.strategy, won.reaction, states, limits)
    return margin, game_margin(won.network, won.objective, won.reaction, limits=limits) if thorough else None
