"""The commands: each parses its arguments, calls one function, prints. Its needs are imported when it runs."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import List, Optional

import typer

from pursue_gen import __version__
from pursue_gen.cli.bundle import bundle
from pursue_gen.cli.console import guarded, show, suggest, tell
from pursue_gen.cli.examples import examples
from pursue_gen.cli.explain import explain as explain_code
from pursue_gen.cli.fmt import fmt
from pursue_gen.cli.keys import keys
from pursue_gen.cli.lsp import lsp
from pursue_gen.cli.new import new
from pursue_gen.cli.options import (
    ENDS,
    EXPLAIN,
    GAME,
    LIMIT,
    MARGIN,
    MEMORY,
    OPTIMIZE,
    REACTION,
    SCENARIO,
    SLACK,
    SOLVER,
    VERIFYTGA,
    Ends,
    Engine,
    Optimize,
    Solver,
    value,
)
from pursue_gen.cli.play import play
from pursue_gen.cli.replan import replan
from pursue_gen.cli.replay import replay
from pursue_gen.cli.report import report
from pursue_gen.cli.send import send
from pursue_gen.cli.sim import sim
from pursue_gen.cli.ws import ws
from pursue_gen.diagnostics import PursueError, Severity, as_json, counted, usage_error
from pursue_gen.files import shell_quoted

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
    tell(f"{counted(len(files), 'file')}: {counted(errors, 'error')}, {counted(len(findings) - errors, 'warning')}")
    if errors:
        suggest(f"pursue-gen explain {next(f.code for f in findings if f.severity is Severity.ERROR)}")
        raise typer.Exit(3)
    suggest(f"pursue-gen ws {shell_quoted(files[0])}")


@app.command(epilog="For example: pursue-gen tga scenarios/thesis/scenario_1.pur -o uppaal")
@guarded
def tga(
    scenario: Path = SCENARIO,
    folder: Path = typer.Option(Path("."), "-o", "--output", metavar="DIR", help="Where to write; here by default."),
    ends: Ends = typer.Option(
        Ends.CONTROLLABLE, help="reported: ends are the environment's, as in the default game of solve and ws."
    ),
    slack: List[str] = SLACK,
) -> None:
    """Write a scenario's timed game as UPPAAL's files TGA.xml and TCTL.q (the original's ideal game)."""
    from pursue_gen.files import write_texts
    from pursue_gen.solving.inputs import game_of, scenario_in
    from pursue_gen.solving.options import asked_rules
    from pursue_gen.solving.solution import played
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = game_of(scenario_in(scenario))
    network = played(network, asked_rules(network, ends.value, "0", slack))
    model, query = folder / "TGA.xml", folder / "TCTL.q"
    write_texts({model: write_network(network, objective), query: write_query(objective)})
    print(model, query, sep="\n")
    suggest(f"pursue-gen solve {shell_quoted(model)} {shell_quoted(query)}")


@app.command(
    epilog="For example: pursue-gen solve my_floor.pur -o plan.txt; "
    "as UPPAAL-TIGA plays: pursue-gen solve TGA.xml TCTL.q --ends controllable --reaction 0"
)
@guarded
def solve(
    files: List[Path] = typer.Argument(..., metavar=GAME, help="A scenario, or UPPAAL's files for a timed game."),
    ends: Optional[Ends] = ENDS,
    reaction: Optional[str] = REACTION,
    slack: List[str] = SLACK,
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Where the plan goes, instead of stdout."
    ),
    engine: Optional[Engine] = typer.Option(None, help="The solver; native where it was built, by default."),
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
    solver: Optional[Solver] = SOLVER,
    verifytga: Optional[Path] = VERIFYTGA,
    optimize: Optional[Optimize] = OPTIMIZE,
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
    from pursue_gen.cli.loss import why
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.files import write_texts
    from pursue_gen.solving.inputs import game_in
    from pursue_gen.solving.options import asked_limits, asked_rules, margins_told, verdict_json, verdict_text
    from pursue_gen.solving.solvers import keep_counter, margins, solved
    from pursue_gen.synthesis.plan import write_plan

    network, objective = game_in(files)
    rules, limits = asked_rules(network, value(ends), reaction, slack), asked_limits(limit, memory)
    try:
        with progress_line(as_json_) as progress:
            asked = (value(solver), verifytga, limits, value(engine), progress, value(optimize))
            won = solved(network, objective, rules, *asked)
    except PursueError as problem:
        keep_counter(problem, network, objective, output)
        explained = why(problem, files, rules, explain, limits, as_json_)
        if as_json_ and problem.exit_status in (4, 5):
            print(json.dumps({**verdict_json(rules, None, problem.diagnostics), **explained}, indent=1))
        if explained:  # and so the findings are told
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
    tell(verdict_text(rules, won))
    tell(margins_told(won, *found))
    if len(files) == 1:
        suggest(f"pursue-gen ws {shell_quoted(files[0])}")


@app.command(epilog="For example: pursue-gen verify my_floor.pur plan.txt")
@guarded
def verify(
    files: List[Path] = typer.Argument(..., metavar=f"({GAME}) PLAN", help="A game as for solve, and a plan for it."),
    ends: Optional[Ends] = ENDS,
    reaction: Optional[str] = REACTION,
    slack: List[str] = SLACK,
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
) -> None:
    """Prove that a plan wins, or show a play in which it does not.

    Without --ends, --reaction and --slack the default game is tried, then UPPAAL-TIGA's (ends controllable, reaction
    0). The exit status is 4 where the plan wins in neither.
    """
    from pursue_gen.solving.given_plan import exit_status, try_plan
    from pursue_gen.solving.inputs import game_in
    from pursue_gen.solving.options import asked_limits, games_to_try, in_words

    if len(files) < 2:
        raise usage_error("a plan is missing", "name the game, then the plan: pursue-gen verify my_floor.pur plan.txt")
    network, objective = game_in(files[:-1])
    games = games_to_try(network, value(ends), reaction, slack)
    tried = try_plan(files[-1], network, objective, games, asked_limits(limit, memory))
    for trial in tried:
        print(f"{in_words(trial.rules)}: {trial.outcome}")
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
