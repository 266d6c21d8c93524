"""The command `replay`."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import typer

from pursue_gen.cli.console import guarded, info
from pursue_gen.cli.options import JSON, REQUEST, with_request
from pursue_gen.diagnostics import usage_error
from pursue_gen.outcomes import NO

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tools.calibration.proposal import Proposal
    from pursue_gen.tools.replay import Findings, Game, MissionRecord


@guarded
@with_request("ends", "reaction", "slack", "limit", "memory")
def replay(
    recording: Path = typer.Argument(..., metavar="FILE", help="A bag of ROS 1, or an observer's journal (.jsonl)."),
    scenario: Optional[Path] = typer.Argument(
        None, metavar="[SCENARIO]", help="The scenario, where the recording does not hold it."
    ),
    workspace: Optional[Path] = typer.Option(
        None, "--workspace", metavar="DIR", help="The workspace that was run: its scenario, rules and plan are taken."
    ),
    request: SolveRequest = REQUEST,
    tolerance: float = typer.Option(
        0.1, metavar="UNITS", min=0.0, help="How far events may miss the model's windows, in time units."
    ),
    timeline: Optional[Path] = typer.Option(
        None, metavar="OUT", help="Draw what happened: a timeline OUT.svg, or a page OUT.html with an animation too."
    ),
    quiet: bool = typer.Option(False, "--quiet", "-q", help="Only what is wrong, the summary and the verdict."),
    as_json_: bool = JSON,
) -> None:
    """Check a recorded mission against its scenario, step by step, and say where the world left the model most.

    Needs no ROS. The exit status is 0 if the mission kept to the model and was won, 1 if not, 2 if there is nothing to
    check.
    """
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.tools.calibration.proposal import of_mission
    from pursue_gen.tools.replay import check, game_of, read_recording
    from pursue_gen.tools.replay.game import source_of
    from pursue_gen.tools.replay.journal import Journal, reconstruct
    from pursue_gen.tools.replay.moves import Moves
    from pursue_gen.tools.replay.written import with_orders, with_what_was_written
    from pursue_gen.tools.report.animation import check_name

    if timeline is not None:
        check_name(timeline)
    found = read_recording(recording)
    source = source_of(found, recording, scenario, workspace, request)
    with progress_line(as_json_ or quiet) as progress:
        game = game_of(source, request.options.limits, progress)
    if isinstance(found, Journal):
        game = with_orders(game, found.plans_of_orders)
        record = reconstruct(found, Moves(game.network), game.objective)
    else:
        record, game = with_what_was_written(found, game)
    if timeline is not None:
        _draw(record, game, recording, timeline)
    findings = check(record, game, tolerance)
    proposal = of_mission(record, game.scenario, source.rules.slack, tolerance, recording.name)
    _print(findings, game, record, recording, proposal, quiet, as_json_)
    if not (findings.kept and findings.won):
        raise typer.Exit(NO)


def _draw(record: MissionRecord, game: Game, recording: Path, timeline: Path) -> None:
    from pursue_gen.tools.report.animation import write
    from pursue_gen.tools.report.recording import from_states

    shown = from_states(record.states, game.scenario, game.network, recording.name)
    if shown is None:
        raise usage_error(f"the mission never starts in {recording}", "leave out --timeline: there is nothing to draw")
    write(shown, timeline)
    info(f"{timeline} shows the mission")


def _print(
    findings: Findings,
    game: Game,
    record: MissionRecord,
    recording: Path,
    proposal: Proposal,
    quiet: bool,
    as_json_: bool,
) -> None:
    from pursue_gen.tools.calibration.advice import advice_json, reaction_advice
    from pursue_gen.tools.calibration.proposal_report import left_most, left_most_json
    from pursue_gen.tools.replay.summary import as_json, listed, summary, verdict
    from pursue_gen.workspace.model_file import model_data
    from pursue_runtime.model import Model

    late = findings.delays, findings.reaction, proposal.options.unit
    if as_json_:
        data = {**as_json(findings, record, str(recording)), "left_most": left_most_json(proposal)}
        data["reaction"] = advice_json(*late)
        print(json.dumps(data, indent=1))
        info(verdict(findings))
        return
    if not quiet or not findings.kept:
        model = Model(model_data(game.network, game.objective, game.scenario, Fraction(0)))
        print(*listed(findings, model, notes=not quiet), sep="\n")
    print(*left_most(proposal), *([] if quiet else reaction_advice(*late)), summary(findings), sep="\n")
    print(verdict(findings))
