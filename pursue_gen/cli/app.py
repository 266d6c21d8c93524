"""The commands: each parses its arguments, calls one function, prints. Its needs are imported when it runs."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional

import typer

from pursue_gen import __version__
from pursue_gen.cli.bundle import bundle
from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.examples import examples
from pursue_gen.cli.explain import explain as explain_code
from pursue_gen.cli.fmt import fmt
from pursue_gen.cli.inputs import game_from, scenario_from
from pursue_gen.cli.keys import keys
from pursue_gen.cli.lsp import lsp
from pursue_gen.cli.new import new
from pursue_gen.cli.options import EXPLAIN, GAME, MARGIN, REQUEST, SCENARIO, Ends, with_request
from pursue_gen.cli.play import play
from pursue_gen.cli.replan import replan
from pursue_gen.cli.replay import replay
from pursue_gen.cli.report import report
from pursue_gen.cli.send import send
from pursue_gen.cli.sim import sim
from pursue_gen.cli.ws import ws
from pursue_gen.diagnostics import PursueError, Severity, as_json, counted, usage_error
from pursue_gen.files import shell_quoted

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest

SOLVE = ("ends", "reaction", "slack", "engine", "limit", "memory", "solver", "verifytga", "optimize")
IDEAL_ENDS = typer.Option(
    Ends.CONTROLLABLE, help="reported: ends are the environment's, as in the default game of solve and ws."
)

app = typer.Typer(
    name="pursue-gen",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="From a scenario in PuRSUE-ML to a ROS 1 workspace with one proven controller per robot.",
    epilog="Data goes to stdout, everything else to stderr. Exit status: 0 well; 2 the command line or a file is "
    "wrong; 3 the scenario has errors; 4 the objective cannot be met, or a plan does not win; 5 a limit was hit; 6 "
    "something that is needed is missing; 7 robots could not be reached or refused, and nothing has changed; 8 the "
    "robots differ; 130 interrupted.",
)


def main() -> None:
    """The program `pursue-gen`."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a terminal that cannot show a letter gets its code
            stream.reconfigure(errors="backslashreplace")
    try:
        app(prog_name="pursue-gen")
    except KeyboardInterrupt:  # before or after the command itself
        sys.exit(130)


def _version(wanted: bool) -> None:
    if wanted:
        print(f"pursue-gen {__version__}")
        raise typer.Exit()


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and exit."
    ),
) -> None:
    pass


@app.command(epilog="For example: pursue-gen check my_floor.pur")
@guarded
def check(
    files: List[Path] = typer.Argument(..., metavar="FILE...", help="Scenarios."),
    as_json_: bool = typer.Option(False, "--json", help="Print the findings as a JSON list."),
) -> None:
    """Tell everything that is wrong with scenarios, with line and column.

    Findings go to stdout; the exit status is 3 where there are errors.
    """
    from pursue_gen.solving.inputs import findings_in

    findings = [finding for file in files for finding in findings_in(file)]
    if as_json_:
        print(json.dumps([as_json(finding) for finding in findings], indent=1))
    else:
        show(findings, sys.stdout)
    errors = sum(finding.severity is Severity.ERROR for finding in findings)
    info(f"{counted(len(files), 'file')}: {counted(errors, 'error')}, {counted(len(findings) - errors, 'warning')}")
    if errors:
        suggest(f"pursue-gen explain {next(f.code for f in findings if f.severity is Severity.ERROR)}")
        raise typer.Exit(3)
    suggest(f"pursue-gen ws {shell_quoted(files[0])}")


@app.command(epilog="For example: pursue-gen tga scenarios/thesis/scenario_1.pur -o uppaal")
@guarded
@with_request("ends", "slack", ends=IDEAL_ENDS)
def tga(
    scenario: Path = SCENARIO,
    folder: Path = typer.Option(Path("."), "-o", "--output", metavar="DIR", help="Where to write; here by default."),
    request: SolveRequest = REQUEST,
) -> None:
    """Write a scenario's timed game as UPPAAL's files TGA.xml and TCTL.q (the original's ideal game)."""
    from pursue_gen.files import write_texts
    from pursue_gen.solving.inputs import game_of
    from pursue_gen.solving.rules import played
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = game_of(scenario_from(scenario))
    network = played(network, replace(request, reaction="0").rules(network))
    model, query = folder / "TGA.xml", folder / "TCTL.q"
    write_texts({model: write_network(network, objective), query: write_query(objective)})
    print(model, query, sep="\n")
    suggest(f"pursue-gen solve {shell_quoted(model)} {shell_quoted(query)}")


@app.command(
    epilog="For example: pursue-gen solve my_floor.pur -o plan.txt; "
    "as UPPAAL-TIGA plays: pursue-gen solve TGA.xml TCTL.q --ends controllable --reaction 0"
)
@guarded
@with_request(*SOLVE)
def solve(
    files: List[Path] = typer.Argument(..., metavar=GAME, help="A scenario, or UPPAAL's files for a timed game."),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where the plan goes, instead of stdout."
    ),
    request: SolveRequest = REQUEST,
    explain: bool = EXPLAIN,
    margin: bool = MARGIN,
    as_json_: bool = typer.Option(
        False, "--json", help="Print the verdict as JSON on stdout (the plan goes to -o only)."
    ),
) -> None:
    """Find out whether the objective can be met whatever the others do, and print the plan that meets it.

    The plan (in the format of UPPAAL-TIGA's) has been proven by a second, independent program. The exit status is 4
    where the objective cannot be met.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.cli.solution import explain_loss
    from pursue_gen.files import write_texts
    from pursue_gen.solving.request import solution_of
    from pursue_gen.solving.solvers import keep_counter
    from pursue_gen.solving.verdict import margin_text, margins, verdict_json, verdict_text
    from pursue_gen.synthesis.plan import write_plan

    network, objective = game_from(files)
    rules, limits = request.rules(network), request.options.limits
    try:
        with progress_line(as_json_) as progress:
            won = solution_of(network, objective, request, progress)
    except PursueError as problem:
        kept = keep_counter(problem, network, objective, output)
        if kept is not None:
            info(f"The counter-strategy is in {kept}")
        explained = explain_loss(problem, files, rules, explain, limits, as_json_)
        if as_json_ and problem.exit_status in (4, 5):
            print(json.dumps({**verdict_json(rules, None, problem.diagnostics), **explained}, indent=1))
        if explained:  # its findings are printed
            raise typer.Exit(problem.exit_status) from None
        raise
    plan = write_plan(won.strategy, won.network, objective)
    if output is not None:
        write_texts({output: plan})
    found = margins(won, margin, limits)
    if as_json_:
        print(json.dumps(verdict_json(rules, won, (), *found), indent=1))
    elif output is None:
        print(plan, end="")
    info(verdict_text(won))
    info(margin_text(won, *found))
    if len(files) == 1:
        suggest(f"pursue-gen ws {shell_quoted(files[0])}")


@app.command(epilog="For example: pursue-gen verify my_floor.pur plan.txt")
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
    from pursue_gen.solving.given_plan import exit_status, try_plan
    from pursue_gen.solving.rules import rules_text

    if len(files) < 2:
        raise usage_error("a plan is missing", "name the game, then the plan: pursue-gen verify my_floor.pur plan.txt")
    network, objective = game_from(files[:-1])
    with progress_line() as progress:
        options = replace(request.options, progress=progress)
        tried = try_plan(files[-1], network, objective, request.games(network), options)
    for trial in tried:
        print(f"{rules_text(trial.rules)}: {trial.outcome}")
        show(trial.findings)
    if exit_status(tried):
        raise typer.Exit(exit_status(tried))


app.command(epilog="For example: pursue-gen ws scenarios/thesis/scenario_1.pur")(ws)
app.command("explain", epilog="For example: pursue-gen explain PML110")(explain_code)
app.command(epilog="For example: pursue-gen play scenarios/thesis/catch_the_thief.pur")(play)
app.command(epilog="For example: pursue-gen report scenarios/thesis/scenario_3.pur --html")(report)
app.command(epilog="For example: pursue-gen replay mission.bag")(replay)
app.command(epilog="For example: pursue-gen sim my_floor.pur --runs 10000 --faults delay,loss --jobs 4")(sim)
app.command(epilog="For example: pursue-gen fmt my_floor.pur")(fmt)
app.command(epilog="For example: pursue-gen new my_floor --kind reach --robots 2")(new)
app.command(epilog="For example: pursue-gen examples thesis/scenario_1")(examples)
app.command(epilog="For example: pursue-gen replan < request.json")(replan)
app.command(epilog="For example, in an editor's settings: pursue-gen lsp")(lsp)
app.add_typer(keys, name="keys")
app.command(epilog="For example: pursue-gen bundle my_floor.pur --poses lab.yaml --key lab")(bundle)
app.command(epilog="For example: pursue-gen send my_floor.pur --to robots.yaml --poses lab.yaml")(send)


if __name__ == "__main__":
    main()
