"""The command `report`."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.inputs import placed_on, scenario_from
from pursue_gen.cli.options import DEFAULT_DISTANCE, JSON, REQUEST, ROBOT, SCENARIO, choice, with_request
from pursue_gen.diagnostics import counted, error, usage_error
from pursue_gen.files import shell_quoted
from pursue_gen.outcomes import LimitHit, Lost, Unavailable

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.solving.options import SolveOptions
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tools.report.whole import Report, ReportOptions

_NAMES = {"reported": "default", "controllable": "ideal"}
"""What a game is called, by who controls the ends in it."""
_ENDS = choice(
    "ends",
    None,
    "The tables of one game for all controllers: the default game (reported) or the ideal one (controllable: the "
    "thesis's comparison). Without it General is of the ideal game, the others of the default one.",
)
_MARK = 'name="generator" content="pursue-gen'


@guarded
@with_request("ends", "optimize", "within", "limit", "memory", ends=_ENDS)
def report(
    scenario: Path = SCENARIO,
    file: Optional[Path] = typer.Argument(
        None, metavar="[FILE]", help="With --html: where the page goes; <scenario>_report.html by default."
    ),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Write the page to FILE, or into this folder; --html is implied."
    ),
    html: bool = typer.Option(False, "--html", help="Write one HTML page with everything, for any browser."),
    pictures: Optional[Path] = typer.Option(None, metavar="DIR", help="Write every picture there, as SVG and as PNG."),
    floor: Optional[Path] = typer.Option(
        None, "--map", metavar="YAML", help="A floor plan of map_server, to lie under the map."
    ),
    robot: List[str] = ROBOT,
    runs: int = typer.Option(
        200, metavar="N", min=0, help="So many simulated missions for each shape of controllers, for the page."
    ),
    reach_obj: Optional[str] = typer.Option(
        None,
        metavar="dedicated|all|ROBOT",
        help="Who gets the objective's commands; default: dedicated, for the thesis's scenarios as the thesis has it.",
    ),
    request: SolveRequest = REQUEST,
    as_json_: bool = JSON,
    force: bool = typer.Option(False, "--force", help="Replace a FILE that is no report."),
) -> None:
    """Print how many commands and lines each controller has, beside the thesis's figures for its scenarios.

    With --html or --pictures: show the scenario, its strategy and its workspace instead. A scenario that cannot be won
    gets a page that says why.
    """
    from pursue_gen.tools.report.whole import ReportOptions
    from pursue_gen.workspace.robot_size import read_sizes

    html = html or output is not None
    seen = html or pictures is not None
    _check_options(seen, html, file, output, floor, as_json_)
    if not seen:
        _print_tables(scenario, reach_obj, request, as_json_)
        return
    if request.ends is not None:
        raise usage_error("--ends is for the tables alone", "leave it out: the page has the tables of both")
    solving = replace(request.options, within=request.deadline)
    target = _target(scenario, file or output)
    if html and not force:
        _check_target(target)
    told = read_sizes(robot)
    options = ReportOptions(reach_obj, runs if html else 0)
    read = scenario_from(scenario, request)
    if floor is not None:
        read, plan, *_ = placed_on(read, floor, DEFAULT_DISTANCE, told)
        options = replace(options, floor=plan)
    made = _made(read, options, solving)
    if pictures is not None:
        _write_pictures(made, pictures)
    if html:
        _write_page(made, target)


def _check_options(
    seen: bool, html: bool, file: Optional[Path], output: Optional[Path], floor: Optional[Path], as_json_: bool
) -> None:
    if file is not None and not html:
        raise usage_error(f"{file} has no meaning here", f"to write a page: pursue-gen report SCENARIO -o {file}")
    if file is not None and output is not None:
        raise usage_error(f"two places for one page: {file} and {output}", "name it behind -o only")
    if floor is not None and not seen:
        raise usage_error("--map is for pages and pictures", "add --html or --pictures DIR")
    if as_json_ and seen:
        raise usage_error("--json is for the tables alone", "leave it out, or leave --html, -o and --pictures out")


def _target(scenario: Path, given: Optional[Path]) -> Path:
    """Where the page goes."""
    name = f"{scenario.stem}_report.html"
    if given is None:
        return Path(name)
    return given / name if given.is_dir() else given


def _check_target(target: Path) -> None:
    """A page replaces a page, nothing else."""
    if not target.is_file():
        return
    with open(target, encoding="utf-8", errors="replace") as stream:
        if _MARK not in stream.read(4000):
            raise usage_error(f"{target} is there and is no report", "name another file, or replace it with --force")


def _print_tables(file: Path, reach_obj: Optional[str], request: SolveRequest, as_json_: bool) -> None:
    from pursue_gen import api
    from pursue_gen.cli.inputs import naming_costs
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.tools.report import commands
    from pursue_gen.tools.report.whole import solved_games

    request = replace(request, reaction="0" if request.ends == "controllable" else None)
    read = scenario_from(file, request, as_json_)
    with naming_costs(read, request, as_json_), progress_line(as_json_) as progress:
        scenario, played = solved_games(read, request, progress)
        games = [api.SolvedGame(won, request) for won in played]
        margins = [solved.margins() for solved in games]
    names = [_NAMES[won.rules.ends] for won in played]
    game, *ideal = played
    table = commands.commands_table(scenario.name, scenario.agents, game, ideal[0] if ideal else None, reach_obj)
    if as_json_:
        of_games = {name: margin.as_json() for name, (margin, _) in zip(names, margins)}
        times = {name: won.guarantee.as_json() for name, won in zip(names, played) if won.guarantee}
        extra = {"margins": of_games, **({"times": times} if times else {})}
        print(json.dumps({**commands.as_json(table), **extra}, indent=1))
        return
    print(commands.render_table(table))
    for name, solved, found in zip(names, games, margins):
        print(f"{name} game: {solved.margin_text(found)}")
        if solved.solution.guarantee:
            print(f"{name} game: {solved.solution.guarantee.in_words()}")


def _made(scenario: Scenario, options: ReportOptions, solving: SolveOptions) -> Report:
    """The report, with lines of progress while it is made."""
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.language.numbers import decimal_text
    from pursue_gen.tools.commands.progress import counting
    from pursue_gen.tools.report.whole import lost_report, solved_both, won_report

    try:
        with progress_line() as progress:
            scenario, both = solved_both(scenario, replace(solving, progress=progress))
    except (Lost, LimitHit) as problem:
        show(problem.diagnostics)
        option = "" if solving.within is None else f"--within {decimal_text(solving.within)}"
        with progress_line() as progress:
            return lost_report(scenario, problem, solving.limits, progress, options.floor, option)
    with counting(2 * options.runs) as count:
        return won_report(scenario, both, options, solving.limits, count)


def _write_pictures(made: Report, folder: Path) -> None:
    """Writes every picture as SVG, and as PNG where that can be made; all files or none."""
    from pursue_gen.files import write_bytes
    from pursue_gen.tools.report import graphviz
    from pursue_gen.tools.report.png import NO_PNG, available, png
    from pursue_gen.tools.report.whole import pictures

    drawn = pictures(made)
    missing = [name for name, svg in drawn.items() if not svg]
    found = {name: svg for name, svg in drawn.items() if svg}
    files = {folder / f"{name}.svg": svg.encode("utf-8") for name, svg in found.items()}
    with_png = available()
    if with_png:
        files.update({folder / f"{name}.png": png(svg) for name, svg in found.items()})
    write_bytes(files)
    for file in sorted(files):
        print(file)
    if not with_png:
        show([NO_PNG])
    if missing:
        reason = "graphviz could not draw them" if graphviz.installed() else graphviz.HOW_TO_GET
        message = f"{counted(len(missing), 'picture')} could not be drawn: {', '.join(missing)}"
        raise Unavailable([error("REP005", message, hint=reason)])


def _write_page(made: Report, target: Path) -> None:
    from pursue_gen.files import write_texts
    from pursue_gen.tools.report import graphviz
    from pursue_gen.tools.report.whole import report_page

    write_texts({target: report_page(made)})
    print(target)
    if not graphviz.installed():
        info(f"Some pictures are missing in it: {graphviz.HOW_TO_GET}.")
    suggest(f"xdg-open {shell_quoted(target)}")
