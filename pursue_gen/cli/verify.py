"""The command `verify`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, List

import typer

from pursue_gen.cli.console import ended, guarded, show
from pursue_gen.cli.inputs import game_from, scenario_from
from pursue_gen.cli.options import GAME, REQUEST, with_request
from pursue_gen.diagnostics import usage_error

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest


@guarded
@with_request("ends", "reaction", "slack", "limit", "memory")
def verify(
    files: List[Path] = typer.Argument(..., metavar=f"({GAME}) PLAN", help="A game as for solve, and a plan for it."),
    request: SolveRequest = REQUEST,
) -> None:
    """Prove that a plan wins, or show a play in which it does not.

    Without --ends, --reaction and --slack the default game is tried, then UPPAAL-TIGA's (ends controllable, reaction
    0). The exit status is 4 where the plan wins in neither.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.cli.solution import show_promise
    from pursue_gen.solving.given_plan import problem_of, try_plan
    from pursue_gen.solving.inputs import are_scenario
    from pursue_gen.solving.optional import try_plan_of
    from pursue_gen.solving.rules import rules_text

    if len(files) < 2:
        raise usage_error("a plan is missing", "name the game, then the plan: pursue-gen verify my_floor.pur plan.txt")
    *game, plan = files
    scenario = scenario_from(game[0], request) if are_scenario(game) else None
    with progress_line() as progress:
        options = replace(request.options, progress=progress)
        if scenario is None:
            network, objective, _ = game_from(game, request)
            tried = try_plan(plan, network, objective, request.games(network), options)
        else:
            scenario, tried = try_plan_of(scenario, plan, request, options)
    for trial in tried:
        print(f"{rules_text(trial.rules)}: {trial.outcome}")
        show(trial.findings)
    problem = problem_of(tried)
    if problem is not None:
        raise ended(problem)
    if scenario is not None:
        show_promise(scenario, assumptions=False)
