"""The command `solve`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional, Tuple

import typer

from pursue_gen.cli.console import ended, guarded, info, suggest
from pursue_gen.cli.inputs import are_scenario, scenario_from
from pursue_gen.cli.options import EXPLAIN, GAME, MARGIN, REQUEST, with_request
from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.files import shell_quoted, write_texts
from pursue_gen.outcomes import LimitHit, Lost, NotProven, TooSlow

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

SOLVERS = ("solver", "verifytga", "whole")
OPTIONS = ("ends", "reaction", "slack", "limit", "memory", "optimize", "within", *SOLVERS)


@guarded
@with_request(*OPTIONS)
def solve(
    files: List[Path] = typer.Argument(..., metavar=GAME, help="A scenario, or UPPAAL's files for a timed game."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Write the plan to FILE; -: print it on stdout."
    ),
    plan_: Optional[str] = typer.Option(None, "--plan", metavar="-", help="Print the plan on stdout."),
    request: SolveRequest = REQUEST,
    explain: bool = EXPLAIN,
    margin: bool = MARGIN,
    as_json_: bool = typer.Option(False, "--json", help="Print the verdict as JSON on stdout."),
) -> None:
    """Find out whether the objective can be met whatever the others do, and make the plan that meets it.

    A summary is printed on stderr, the plan only with -o FILE or --plan -. It has the format of UPPAAL-TIGA's, and has
    been proven by a second, independent program. The exit status is 4 where the objective cannot be met.
    """
    from pursue_gen import api
    from pursue_gen.cli.inputs import explained
    from pursue_gen.cli.progress import progress_line

    printed, output = _plan_to(plan_, output, as_json_)
    start = request.options.limits.now()
    scenario = scenario_from(files[0], request, as_json_) if are_scenario(files) else None
    game = api.read_game(*files) if scenario is None else api.game(scenario)
    request = request.since(start)
    solved: api.SolvedGame
    try:
        with progress_line(as_json_) as progress:
            if scenario is None:
                solved = api.solve_game(game, request, progress)
            else:
                solved = api.solve(scenario, request, progress)
    except PursueError as problem:
        _keep_counter(getattr(problem, "counter_plan", ""), output)
        why = explained(problem, scenario, request, as_json_) if scenario is not None and explain else {}
        if as_json_ and isinstance(problem, (Lost, TooSlow, NotProven, LimitHit)):
            print(json.dumps({**api.verdict_of(problem, game, request), **why}, indent=1))
        if why:
            raise ended(problem) from None
        raise
    if output is not None:
        write_texts({output: solved.plan})
    margins = solved.margins(margin)
    if as_json_:
        print(json.dumps(solved.as_json(margins), indent=1))
    elif printed:
        print(solved.plan, end="")
    for line in (*solved.in_words(), solved.margin_text(margins)):
        info(line)
    if len(files) == 1:
        suggest(f"pursue-gen ws {shell_quoted(files[0])}")


def _keep_counter(plan: str, output: Optional[Path]) -> None:
    """Writes a counter-strategy, if there is one, beside the file that is named for the plan."""
    if plan and output is not None and (output.is_file() or not output.exists()):  # nothing stands beside /dev/null
        kept = output.with_name(f"{output.stem}_failed{output.suffix}")
        write_texts({kept: plan})
        info(f"The counter-strategy is in {kept}")


def _plan_to(plan: Optional[str], output: Optional[Path], as_json_: bool) -> Tuple[bool, Optional[Path]]:
    """Whether the plan is printed, and the file that it is written to. Raises PursueError (exit status 2)."""
    if plan not in (None, "-"):
        raise usage_error(f"solve makes a plan and takes none: --plan {plan}", "to write the plan: -o FILE")
    on_stdout = output == Path("-")
    printed = plan is not None or on_stdout
    if printed and as_json_:
        raise usage_error("stdout cannot have both the plan and JSON", "write the plan to a file: -o FILE")
    return printed, None if on_stdout else output
