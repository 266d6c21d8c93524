"""The command `calibrate`."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, List, Optional, Tuple

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import JSON, REQUEST, SCENARIO, with_request
from pursue_gen.diagnostics import usage_error
from pursue_gen.files import check_new, shell_quoted, write_texts

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tools.calibration.proposal import Options, Proposal
    from pursue_gen.tools.calibration.solved_again import Verdict

STEP = typer.Option("0.1", metavar="UNITS", help="Round windows outwards to multiples of this: 0.1, 0.5, 1 …")
SHARE = typer.Option(
    0.99, metavar="SHARE", help="How large a share of later times the windows are to hold, such as 0.95 or 0.99."
)


@guarded
@with_request("ends", "reaction", "slack", "limit", "memory")
def calibrate(
    file: Path = SCENARIO,
    recordings: List[Path] = typer.Argument(
        ..., metavar="BAG…", help="Bags of missions or of drives, and observers' journals (journal-….jsonl)."
    ),
    output: Optional[Path] = typer.Option(
        None, "-o", "--output", metavar="FILE", help="Write the scenario with the proposal to FILE."
    ),
    force: bool = typer.Option(
        False, "--force", help="Replace FILE and OUT if they are there already, also the scenario itself."
    ),
    request: SolveRequest = REQUEST,
    time_unit: Optional[float] = typer.Option(
        None, "--time-unit", metavar="SECONDS", help="How long a time unit is; by default as recorded, or 1 second."
    ),
    step: str = STEP,
    share: float = SHARE,
    outliers: bool = typer.Option(
        True, "--outliers/--without-outliers", help="Whether outliers count for the windows."
    ),
    solved: bool = typer.Option(
        True, "--solve/--no-solve", help="Solve the scenario as it is and with the proposal, and compare."
    ),
    picture: Optional[Path] = typer.Option(
        None, "--picture", metavar="OUT", help="Draw the times: OUT.svg, or a page OUT.html with the tables too."
    ),
    as_json_: bool = JSON,
) -> None:
    """Compare measured times with the scenario's windows, and propose windows that hold nearly all later times.

    The times are those of movements and actions in recorded missions, and those of drives that were measured without a
    mission (rosrun UI drive_legs). Needs no ROS.
    """
    from pursue_gen import api
    from pursue_gen.tools.calibration.picture import check_name, write
    from pursue_gen.tools.calibration.proposal import propose
    from pursue_gen.tools.calibration.recordings import samples_in

    check_name(picture)
    for target in filter(None, (output, picture)):
        check_new(target, force)
    scenario = api.read(file)
    show(api.check(scenario))
    options = _options(scenario, request, time_unit, step, share, outliers)
    samples, findings = samples_in(recordings, scenario, time_unit)
    show(findings)
    proposal = propose(scenario, samples, replace(options, unit=samples.unit or 1.0))
    proposed, verdicts = _printed(proposal, request if solved else None, as_json_)
    if picture is not None:
        write(proposal, verdicts, picture)
        info(f"{picture} shows the times")
    if output is None:
        words = ["pursue-gen", "calibrate", str(file), *map(str, recordings), "-o", f"{file.stem}_calibrated.pur"]
        suggest(shlex.join(words))
        return
    write_texts({output: proposed.text})
    info(f"{output} has the proposed windows")
    suggest(f"pursue-gen ws {shell_quoted(output)}")


def _options(
    scenario: Scenario, request: SolveRequest, unit: Optional[float], step: str, share: float, outliers: bool
) -> Options:
    """What was asked for. Raises PursueError (exit status 2) for what cannot be meant."""
    from pursue_gen import api
    from pursue_gen.language.numbers import is_fine, read_number
    from pursue_gen.tools.calibration.proposal import Options
    from pursue_gen.tools.calibration.recordings import timed

    if unit is not None and not 1e-6 <= unit <= 1e6:
        raise usage_error(f"the time unit is {unit:g} seconds", "a number of seconds such as 1 or 0.5")
    if not 0.5 <= share <= 0.9999:
        raise usage_error(f"the share is {share:g}", "a number from 0.5 to 0.9999, such as 0.99")
    exact_step = read_number(step)
    if exact_step is None or not 0 < exact_step <= 1000 or not is_fine(exact_step):
        raise usage_error(f"the step is '{step}'", "a number of time units from 0.001 to 1000, such as 0.1 or 1")
    slack = request.rules(api.game(timed(scenario))[0]).slack
    return Options(unit or 1.0, Fraction(exact_step), share, slack, outliers)


def _printed(
    proposal: Proposal, request: Optional[SolveRequest], as_json_: bool
) -> Tuple[Scenario, Tuple[Verdict, ...]]:
    """Prints the proposal and what it changes; returns the scenario with it, and the verdicts, none without a request.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.tools.calibration import proposal_report
    from pursue_gen.tools.calibration.solved_again import compared

    if not as_json_:
        print(*proposal_report.report(proposal), sep="\n")
    proposed = proposal.checked()
    verdicts: Tuple[Verdict, ...] = ()
    if request is not None:
        with progress_line(as_json_) as progress:
            verdicts = compared(proposal.scenario, proposed, request, progress)
    if as_json_:
        print(json.dumps(proposal_report.as_json(proposal, verdicts), indent=1))
    elif verdicts:
        print("", *proposal_report.changed(proposal, *verdicts), sep="\n")
    return proposed, verdicts
