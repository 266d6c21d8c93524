"""The command `verify`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, List

import typer

from pursue_gen.cli.console import ended, guarded, info, show
from pursue_gen.cli.inputs import are_scenario, scenario_from
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
    from pursue_gen import api
    from pursue_gen.cli.progress import progress_line

    if len(files) < 2:
        raise usage_error("a plan is missing", "name the game, then the plan: pursue-gen verify my_floor.pur plan.txt")
    *game, plan = files
    scenario = scenario_from(game[0], request) if are_scenario(game) else None
    with progress_line() as progress:
        if scenario is None:
            tried = api.verify_game(api.read_game(*game), plan, request, progress)
        else:
            scenario, tried = api.verify(scenario, plan, request, progress)
    for trial in tried:
        print(trial.in_words())
        show(trial.findings)
    problem = api.problem_of(tried)
    if problem is not None:
        raise ended(problem)
    for sentence in [] if scenario is None else api.promises_of(scenario):
        info(sentence)
