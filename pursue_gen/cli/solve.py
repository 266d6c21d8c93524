"""The command `solve`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple

import typer

from pursue_gen.cli.console import ended, guarded, info, suggest
from pursue_gen.cli.inputs import game_from
from pursue_gen.cli.options import EXPLAIN, GAME, MARGIN, REQUEST, with_request
from pursue_gen.diagnostics import PursueError, usage_error
from pursue_gen.files import shell_quoted
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
    as_json_: bool = typer.Option(
        False, "--json", help="Print the verdict as JSON on stdout."
    ),
) -> None:
    """Find out whether the objective can be met whatever the others do, and make the plan that meets it.

    A summary is printed on stderr, the plan only with -o FILE or --plan -. It has the format of UPPAAL-TIGA's, and has
    been proven by a second, independent program. The exit status is 4 where the objective cannot be met.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.cli.solution import explained, show_promise, show_unneeded
    from pursue_gen.files import write_texts
    from pursue_gen.partition import unneeded
    from pursue_gen.solving.answers import answers
    from pursue_gen.solving.optional import promised_of
    from pursue_gen.solving.request import solution_of
    from pursue_gen.solving.solvers import keep_counter
    from pursue_gen.solving.verdict import margin_text, margins, optional_json, periods_json, verdict_json, verdict_text
    from pursue_gen.synthesis.plan import write_plan

    printed, output = _plan_to(plan_, output, as_json_)
    start = request.options.limits.now()
    network, objective, scenario = game_from(files, request, as_json_)
    request = request.since(start)
    rules, limits = request.rules(network), request.options.limits
    try:
        with progress_line(as_json_) as progress:
            promise = None if scenario is None else promised_of(scenario, request, progress)
            won = solution_of(network, objective, request, progress) if promise is None else promise.solution
    except PursueError as problem:
        kept = keep_counter(problem, network, objective, output)
        if kept is not None:
            info(f"The counter-strategy is in {kept}")
        why = explained(problem, scenario, request, as_json_) if scenario is not None and explain else {}
        if as_json_ and isinstance(problem, (Lost, TooSlow, NotProven, LimitHit)):
            print(json.dumps({**verdict_json(rules, problem), **why}, indent=1))
        if why:
            raise ended(problem) from None
        raise
    plan = write_plan(won.strategy, won.network, won.objective) if printed or output is not None else ""
    if output is not None:
        write_texts({output: plan})
    found = margins(won, margin, limits)
    times = [] if promise is None else answers(promise.scenario, won, limits)
    if as_json_:
        more: Dict[str, Any] = {}
        if promise is not None:
            alone = [agent.name for agent in unneeded(promise.scenario, won.strategy)]
            more = {**periods_json(promise.scenario), **optional_json(promise.scenario)}
            more = {"answers": [answer.as_json() for answer in times], "not_needed": alone, **more}
        print(json.dumps({**verdict_json(rules, won, *found), **more}, indent=1))
    elif printed:
        print(plan, end="")
    info(verdict_text(won))
    if promise is not None:
        for answer in times:
            info(answer.in_words())
        show_promise(promise.scenario)
        show_unneeded(promise)
    info(margin_text(won, *found))
    if len(files) == 1:
        suggest(f"pursue-gen ws {shell_quoted(files[0])}")


def _plan_to(plan: Optional[str], output: Optional[Path], as_json_: bool) -> Tuple[bool, Optional[Path]]:
    """Whether the plan is printed, and the file that it is written to. Raises PursueError (exit status 2)."""
    if plan not in (None, "-"):
        raise usage_error(f"solve makes a plan and takes none: --plan {plan}", "to write the plan: -o FILE")
    on_stdout = output == Path("-")
    printed = plan is not None or on_stdout
    if printed and as_json_:
        raise usage_error("stdout cannot have both the plan and JSON", "write the plan to a file: -o FILE")
    return printed, None if on_stdout else output
