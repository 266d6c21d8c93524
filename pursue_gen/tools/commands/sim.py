"""The command `sim`."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Optional

import typer

from pursue_gen.cli.console import guarded, info, show, suggest
from pursue_gen.cli.options import JSON, REQUEST, SCENARIO, choice, with_request
from pursue_gen.diagnostics import counted, usage_error
from pursue_gen.files import shell_quoted
from pursue_gen.outcomes import NO

if TYPE_CHECKING:
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tools.simulation.runs import Summary


OPPONENT = choice("opponent", "mixed", "What uncontrollable agents do; mixed: one of the others in each mission.")

PLAN = typer.Option(None, metavar="FILE", help="Use this plan instead of solving.")
OPTIONS = ("controllers", "reach_obj", "ends", "reaction", "slack", "plan", "optimize", "within", "limit", "memory")


@guarded
@with_request(*OPTIONS, plan=PLAN)
def sim(
    scenario: Path = SCENARIO,
    runs: int = typer.Option(1000, metavar="N", min=1, help="So many missions."),
    seed: int = typer.Option(1, metavar="S", min=0, help="The first mission's number; the next has the next."),
    faults: str = typer.Option(
        "none", metavar="NAMES", help="What goes wrong: names with commas between them, all, none; help: what there is."
    ),
    opponent: str = OPPONENT,
    until: Optional[float] = typer.Option(
        None, metavar="UNITS", help="When a mission is over; 1000 with a goal, or twice the time to it; else 200."
    ),
    jobs: int = typer.Option(1, metavar="N", min=1, help="So many processes; the outcome is the same."),
    scheduler: Optional[str] = typer.Option(
        None, metavar="ADDRESS", help="Play on the workers of this Dask scheduler, as tcp://HOST:8786, not here."
    ),
    request: SolveRequest = REQUEST,
    timeline: Optional[Path] = typer.Option(
        None, metavar="OUT", help="Draw one mission (--runs 1): a timeline OUT.svg, or OUT.html with an animation too."
    ),
    as_json_: bool = JSON,
) -> None:
    """Play many missions with the generated code in a simulated world, without ROS, and check each one.

    The exit status is 1 where a mission failed: without faults it did not reach the goal (or did not
    stay safe), with faults it neither did that nor stopped; or, ever, a robot got a wrong command. Its play is shown.
    """
    from pursue_gen import api
    from pursue_gen.cli.inputs import naming_costs, settled
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.tools.commands.progress import counting
    from pursue_gen.tools.simulation.faults import FAULTS, read_faults
    from pursue_gen.tools.simulation.runs import check_until

    if faults == "help":
        print("\n".join(f"{name:10}  {what}" for name, what in FAULTS.items()))
        return
    kinds = read_faults(faults)
    check_until(until)
    if timeline is not None:
        _check_timeline(timeline, runs, seed)
    read = settled(api.read(scenario), request, as_json_)
    with naming_costs(read, request, as_json_), progress_line(as_json_) as progress:
        solved = api.solve(read, request, progress)
    show(solved.solution.warnings)
    for sentence in api.promises_of(solved.scenario):
        info(sentence)
    with counting(runs, as_json_) as count:
        how: Dict[str, Any] = {"jobs": jobs, "scheduler": scheduler, "progress": count}
        summary = api.simulate(solved, runs, seed, opponent, faults, until, **how)
    if not summary.remaining:
        info("the worst opponent acts at random: the game is too large, or its strategy in stages, to look far ahead")
    if timeline is not None:
        _draw(summary, seed, timeline)
    facts = {"scenario": read.name, "seed": seed, "opponent": opponent, "faults": list(kinds)}
    _print(summary, facts, as_json_)
    if summary.failed:
        raise typer.Exit(NO)
    suggest(f"pursue-gen ws {shell_quoted(scenario)}")


def _check_timeline(timeline: Path, runs: int, seed: int) -> None:
    from pursue_gen.tools.report.animation import check_name

    check_name(timeline)
    if runs != 1:
        raise usage_error("a timeline shows one mission", f"add --runs 1, and --seed {seed} or another")


def _draw(summary: Summary, seed: int, timeline: Path) -> None:
    from pursue_gen.tools.report.animation import write
    from pursue_gen.tools.report.recording import simulated

    write(simulated(summary.case, seed), timeline)
    info(f"{timeline} shows the mission")


def _print(summary: Summary, facts: Dict[str, Any], as_json_: bool) -> None:
    from pursue_gen.tools.simulation.outcome_table import as_json, failure, table

    if as_json_:
        print(json.dumps(as_json(summary, facts), indent=1))
    else:
        guarantee = summary.case.won.guarantee
        print(table(summary, guarantee.in_words(summary.case.scenario.unit) if guarantee else None))
    if summary.failed:
        info(f"{counted(summary.failed, 'mission')} of {summary.missions} failed; the first:")
        for outcome in summary.failures:
            info("\n".join(failure(outcome, _again(outcome.seed))))


def _again(seed: int) -> str:
    """The command line that plays this mission alone, with the same options."""
    words = sys.argv[1:]
    for option in ("--seed", "--runs", "--jobs"):
        words = [w for k, w in enumerate(words) if w != option and words[k - 1] != option and w.split("=")[0] != option]
    return shlex.join(["pursue-gen", *words, "--seed", str(seed), "--runs", "1"])
