"""Solving with a line of progress, the verdict on stderr, and an explanation where the scenario is lost."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Dict, Optional, Sequence

from pursue_gen import language
from pursue_gen.cli.console import info, show
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.inputs import are_scenario, game_of
from pursue_gen.solving.request import SolveRequest, solution_of
from pursue_gen.solving.rules import Rules, rules_text
from pursue_gen.solving.solution import Solution, is_lost
from pursue_gen.solving.verdict import verdict_text
from pursue_gen.synthesis.limits import Limits


def solve_and_print(scenario: Scenario, request: SolveRequest, file: Optional[Path] = None) -> Solution:
    """The proven solution of a scenario; the verdict and warnings are printed.

    `file`: the scenario's file, if it is to be explained why the scenario is lost. Raises as `solution_of`.
    """
    network, objective = game_of(scenario)
    try:
        with progress_line() as progress:
            won = solution_of(network, objective, request, progress)
    except PursueError as problem:
        limits = request.options.limits
        if file and explain_loss(problem, (file,), request.rules(network), True, limits):
            raise PursueError((), problem.exit_status) from None  # its findings are printed
        raise
    show(won.warnings)
    if request.plan is None:
        info(verdict_text(won))
    elif not won.warnings:
        info(f"{request.plan} wins: {rules_text(won.rules)}")
    return won


def explain_loss(
    problem: PursueError, files: Sequence[Path], rules: Rules, wanted: bool, limits: Limits, quiet: bool = False
) -> Dict[str, Any]:
    """Prints the findings of a scenario that is lost and what would change that, within the limits and some work.

    `quiet`: without progress. Returns {"explanation": …} for JSON. Prints nothing, and returns an empty dict, where it
    is not `wanted`, where the problem is another one, and for UPPAAL's files: they have no words of a scenario.
    """
    if not wanted or not is_lost(problem) or not are_scenario(files):
        return {}
    from pursue_gen.explanation.explain import as_json, explain, render

    show(problem.diagnostics)
    info("Looking for what would change that (--no-explain leaves it out) …")
    with progress_line(quiet) as progress:
        explanation = explain(language.load(files[0]), rules, limits, progress)
    info(render(explanation).rstrip())
    return {"explanation": as_json(explanation)}
