"""The commands: each parses its arguments, calls one function, prints. Its needs are imported when it runs."""

from __future__ import annotations

import json
import shlex
import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional, Sequence, Tuple

import typer

from pursue_gen import __version__
from pursue_gen.cli_options import (
    ENDS,
    EXPLAIN,
    GAME,
    JSON,
    LIMIT,
    MARGIN,
    MEMORY,
    OPTIMIZE,
    REACH_OBJ,
    REACTION,
    SCENARIO,
    SLACK,
    SOLVER,
    VERIFYTGA,
    Controllers,
    Ends,
    Engine,
    Optimize,
    Solver,
)
from pursue_gen.console import count, guarded, show, suggest, tell, usage
from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, as_json, in_order

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.tga.network import Network, Objective


app = typer.Typer(
    name="pursue-gen",
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="From a scenario in PuRSUE-ML to a ROS 1 workspace with one proven controller per robot.",
    epilog="Data goes to stdout, everything else to stderr. Exit status: 0 well; 2 the command line or a file is "
    "wrong; 3 the scenario has errors; 4 the objective cannot be met, or a plan does not win; 5 a limit was hit; 6 "
    "something that is needed is missing; 130 interrupted.",
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
    findings = [finding for file in files for finding in _findings(file)]
    if as_json_:
        print(json.dumps([as_json(finding) for finding in findings], indent=1))
    else:
        show(findings, sys.stdout)
    errors = sum(finding.severity is Severity.ERROR for finding in findings)
    tell(f"{count(len(files), 'file')}: {count(errors, 'error')}, {count(len(findings) - errors, 'warning')}")
    if errors:
        raise typer.Exit(3)
    suggest(f"pursue-gen ws {_quoted(files[0])}")


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
    from pursue_gen.game_options import asked_rules
    from pursue_gen.pipeline import played
    from pursue_gen.tga.uppaal import write_network, write_query

    network, objective = _game_of(_scenario(scenario))
    network = played(network, asked_rules(network, ends.value, "0", slack))
    model, query = folder / "TGA.xml", folder / "TCTL.q"
    write_texts({model: write_network(network, objective), query: write_query(objective)})
    print(model, query, sep="\n")
    suggest(f"pursue-gen solve {_quoted(model)} {_quoted(query)}")


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
    from pursue_gen.explanation.told import why
    from pursue_gen.files import write_texts
    from pursue_gen.game_options import asked_limits, asked_rules, margins_told, verdict_json, verdict_text
    from pursue_gen.progress import progress_line
    from pursue_gen.solvers import keep_counter, margins, solved
    from pursue_gen.synthesis.plan import write_plan

    network, objective = _game(files)
    rules, limits = asked_rules(network, _value(ends), reaction, slack), asked_limits(limit, memory)
    try:
        with progress_line(as_json_) as progress:
            asked = (_value(solver), verifytga, limits, _value(engine), progress, _value(optimize))
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
        suggest(f"pursue-gen ws {_quoted(files[0])}")


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
    from pursue_gen.game_options import asked_limits, games_to_try, in_words
    from pursue_gen.plans import exit_status, try_plan

    if len(files) < 2:
        raise usage("a plan is missing", "name the game, then the plan: pursue-gen verify my_floor.pur plan.txt")
    network, objective = _game(files[:-1])
    games = games_to_try(network, _value(ends), reaction, slack)
    tried = try_plan(files[-1], network, objective, games, asked_limits(limit, memory))
    for trial in tried:
        print(f"{in_words(trial.rules)}: {trial.outcome}")
        show(trial.findings)
    if exit_status(tried):
        raise typer.Exit(exit_status(tried))


@app.command(epilog="For example: pursue-gen report scenarios/thesis/scenario_3.pur")
@guarded
def report(
    scenario: Path = SCENARIO,
    reach_obj: Optional[str] = typer.Option(
        None,
        metavar="dedicated|all|ROBOT",
        help="Who gets the objective's commands; default: dedicated, for the thesis's scenarios as the thesis has it.",
    ),
    optimize: Optional[Optimize] = OPTIMIZE,
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
    as_json_: bool = JSON,
) -> None:
    """Print how many commands and lines each controller has, beside the thesis's figures for its scenarios."""
    from pursue_gen.game_options import asked_limits
    from pursue_gen.pipeline import IDEAL, Rules
    from pursue_gen.progress import progress_line
    from pursue_gen.report import commands
    from pursue_gen.solvers import margins, solved
    from pursue_gen.synthesis.margin import as_json as margin_json
    from pursue_gen.synthesis.margin import told

    read = _scenario(scenario)
    network, objective = _game_of(read)
    limits = asked_limits(limit, memory)
    with progress_line(as_json_) as progress:
        asked = (None, None, limits, None, progress, _value(optimize))
        both = [solved(network, objective, rules, *asked) for rules in (Rules(), IDEAL)]
        found = [margins(won, False, limits)[0] for won in both]
    game, ideal = (commands.Game(won.network, won.strategy, won.reaction) for won in both)
    table = commands.commands_table(read.name, read.agents, game, ideal, reach_obj)
    if as_json_:
        of_games = {name: margin_json(margin) for name, margin in zip(("default", "ideal"), found)}
        times = {name: won.guarantee.as_json() for name, won in zip(("default", "ideal"), both) if won.guarantee}
        extra = {"margins": of_games, **({"times": times} if times else {})}
        print(json.dumps({**commands.as_json(table), **extra}, indent=1))
        return
    print(commands.render_table(table))
    for name, won, margin in zip(("default", "ideal"), both, found):
        print(f"{name} game: {told(margin, won.strategy)}")
        if won.guarantee:
            print(f"{name} game: {won.guarantee.in_words()}")


@app.command(epilog="For example: pursue-gen ws scenarios/thesis/scenario_1.pur")
@guarded
def ws(
    scenario: Path = SCENARIO,
    folder: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="DIR", help="Where the workspace goes; workspace_out/<scenario> by default."
    ),
    controllers: Controllers = typer.Option(
        Controllers.DISTRIBUTED,
        help="distributed: one per robot; centralized: one; general: one that decides the ends too (the original's).",
    ),
    reach_obj: str = REACH_OBJ,
    ends: Optional[Ends] = ENDS,
    reaction: Optional[str] = REACTION,
    slack: List[str] = SLACK,
    plan: Optional[Path] = typer.Option(
        None, metavar="FILE", help="Use this plan (UPPAAL-TIGA's format) instead of solving."
    ),
    solver: Optional[Solver] = SOLVER,
    verifytga: Optional[Path] = VERIFYTGA,
    optimize: Optional[Optimize] = OPTIMIZE,
    limit: float = LIMIT,
    memory: Optional[int] = MEMORY,
    explain: bool = EXPLAIN,
    force: bool = typer.Option(False, "--force", help="Replace files that were edited since they were generated."),
) -> None:
    """Write a ROS 1 workspace: a controller per robot, the observer, the user interface, simulated robots, tests.

    The folder is printed on stdout.
    """
    from pursue_gen.explanation.told import why
    from pursue_gen.game_options import asked_limits, asked_rules, games_to_try, verdict_text
    from pursue_gen.plans import take_plan
    from pursue_gen.progress import progress_line
    from pursue_gen.solvers import solved
    from pursue_gen.synthesis.margin import QUICK, strategy_margin, told
    from pursue_gen.workspace import Options, write_workspace

    read = _scenario(scenario)
    network, objective = _game_of(read)
    if controllers is Controllers.GENERAL and ends is None:
        ends = Ends.CONTROLLABLE
        tell("ends: controllable, since a general controller decides them itself (else: --ends reported)")
    limits = asked_limits(limit, memory)
    if plan is None:
        rules = asked_rules(network, _value(ends), reaction, slack)
        try:
            with progress_line() as progress:
                asked = (_value(solver), verifytga, limits, None, progress, _value(optimize))
                won = solved(network, objective, rules, *asked)
        except PursueError as problem:
            if why(problem, (scenario,), rules, explain, limits):
                raise typer.Exit(problem.exit_status) from None
            raise
        tell(verdict_text(rules, won))
    elif solver is not None or verifytga is not None:
        raise usage("there is a plan, and a solver to make one", "use --plan or --solver, not both")
    else:
        won = take_plan(plan, network, objective, games_to_try(network, _value(ends), reaction, slack), limits)
    late = told(strategy_margin(won.network, objective, won.strategy, won.reaction, QUICK, limits), won.strategy)
    tell(late)
    options = Options(controllers=controllers.value, reach_obj=reach_obj, reaction=won.reaction, margin=late)
    place = write_workspace(read, won.network, objective, won.strategy, options, folder, force)
    print(place)
    tell(f"A workspace for {read.name} is in {place}; its README.md says what is in it.")
    launch = f"roslaunch {read.name}_bringup mission.launch"
    suggest(f"cd {_quoted(place)} && catkin_make", "source devel/setup.bash", launch)


# What the commands share ----------------------------------------------------------------------------------------------


def _findings(file: Path) -> Tuple[Diagnostic, ...]:
    """Everything there is to say about a scenario file."""
    from pursue_gen.language.checks import check_reading
    from pursue_gen.language.parser import read, read_text
    from pursue_gen.tga import translation_notes

    try:
        reading = read(read_text(str(file)), str(file))
    except PursueError as problem:
        return problem.diagnostics
    findings = check_reading(reading)
    if reading.scenario is None or any(finding.severity is Severity.ERROR for finding in findings):
        return findings
    return in_order((*findings, *translation_notes(reading.scenario)))


def _scenario(file: Path) -> Scenario:
    """The scenario in a file; its warnings are told."""
    from pursue_gen.language import load

    if file.suffix == ".xml":
        raise usage(f"{file} is not a scenario", "only solve and verify take UPPAAL's files")
    scenario = load(file)
    show(_findings(file))
    return scenario


def _game_of(scenario: Scenario) -> Tuple[Network, Objective]:
    from pursue_gen.tga import scenario_objective, translate

    return translate(scenario), scenario_objective(scenario)


def _game(files: Sequence[Path]) -> Tuple[Network, Objective]:
    """The ideal game of a scenario, or of UPPAAL's two files."""
    from pursue_gen.files import read_text
    from pursue_gen.tga.uppaal import read_network, read_query

    if len(files) == 1 and files[0].suffix != ".xml":
        return _game_of(_scenario(files[0]))
    if len(files) != 2:
        raise usage("expected one scenario, or a network and its query", f"pursue-gen solve {GAME}")
    model, query = files
    network = read_network(read_text(model, "a network of UPPAAL, such as TGA.xml"), str(model))
    return network, read_query(read_text(query, "a query of UPPAAL-TIGA, such as TCTL.q"), str(query))


def _quoted(path: Path) -> str:
    return shlex.quote(str(path))


def _value(choice: Optional[Enum]) -> Optional[str]:
    return None if choice is None else str(choice.value)


if __name__ == "__main__":
    main()
