"""The command `check`."""

from __future__ import annotations

import contextlib
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Dict, Iterable, List, Optional, Tuple

import typer

from pursue_gen.cli.console import ended, guarded, info, show, suggest
from pursue_gen.cli.inputs import on_map
from pursue_gen.cli.options import ROBOT, SPOT_DISTANCE
from pursue_gen.diagnostics import Diagnostic, PursueError, Severity, as_json, counted
from pursue_gen.files import shell_quoted
from pursue_gen.outcomes import Invalid

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.workspace.robot_size import Told
    from pursue_gen.workspace.spots import Fit


@guarded
def check(
    files: List[Path] = typer.Argument(..., metavar="FILE...", help="Scenarios."),
    floor: Optional[Path] = typer.Option(
        None, "--map", metavar="YAML", help="Look where places and robots stand on this map, too, or those of levels."
    ),
    spot_distance: float = SPOT_DISTANCE,
    robot: List[str] = ROBOT,
    as_json_: bool = typer.Option(False, "--json", help="Print the findings as a JSON list."),
) -> None:
    """Tell everything that is wrong with scenarios, with line and column.

    Findings go to stdout; the exit status is 3 where there are errors, 2 where a file cannot be read.
    """
    from pursue_gen import api
    from pursue_gen.workspace.robot_size import read_sizes

    told = read_sizes(robot)
    findings = [finding for file in files for finding in api.check(file)]
    fits: Dict[Path, Fit] = {}
    if floor is not None:
        more, fits = _on_map(files, floor, spot_distance, told)
        findings += more
    if as_json_:
        print(json.dumps([as_json(finding) for finding in findings], indent=1))
    else:
        show(findings, sys.stdout)
    errors = sum(finding.severity is Severity.ERROR for finding in findings)
    info(f"{counted(len(files), 'file')}: {counted(errors, 'error')}, {counted(len(findings) - errors, 'warning')}")
    problem = _outcome_of(findings)
    if problem is not None:
        suggest(f"pursue-gen explain {problem.diagnostics[0].code}")
        raise ended(problem)
    for file in files:
        scenario = api.read(file)
        for sentence in (*_periods(scenario), *_moved(scenario, spot_distance, fits.get(file))):
            info(f"{file}: {sentence}")
    suggest(f"pursue-gen ws {shell_quoted(files[0])}")


def _outcome_of(findings: Iterable[Diagnostic]) -> Optional[PursueError]:
    """How the command ends that found this: None without errors, Invalid unless a file cannot be read."""
    errors = [finding for finding in findings if finding.severity is Severity.ERROR]
    outcome = PursueError if any(finding.code in ("PML001", "PML002") for finding in errors) else Invalid
    return outcome(errors) if errors else None


def _periods(scenario: Scenario) -> List[str]:
    """What is quickly found out about the periods of patrols that name none."""
    from pursue_gen.solving.periods import quickly_found, without_period

    return quickly_found(scenario) if without_period(scenario) else []


def _moved(scenario: Scenario, distance: float, fit: Optional[Fit]) -> List[str]:
    """Which robots are sent beside the pose that the scenario gives for a place, and how far."""
    from pursue_gen.workspace.spots import moved

    several = sum(agent.is_robot for agent in scenario.agents) > 1
    return moved(scenario, distance, fit) if several and any(poi.pose for poi in scenario.pois) else []


def _on_map(
    files: List[Path], floor: Path, spot_distance: float, told: Told
) -> Tuple[List[Diagnostic], Dict[Path, Fit]]:
    """The findings on the map, for scenarios that lack nothing but ways, and how well spots fit there. Raises
    PursueError for a map that cannot be used."""
    from pursue_gen.language.parser import read_text
    from pursue_gen.workspace.levels import read_levels
    from pursue_gen.workspace.map_check import read_placed
    from pursue_gen.workspace.map_spots import fit_on
    from pursue_gen.workspace.robot_size import sizes_of

    levels = read_levels(floor)
    found: List[Diagnostic] = []
    fits: Dict[Path, Fit] = {}
    for file in files:
        with contextlib.suppress(PursueError):  # its errors are reported
            scenario = read_placed(read_text(str(file)), str(file))
            sizes = sizes_of(scenario, told)
            more, known = on_map(scenario, levels, spot_distance, sizes)
            found += more
            fits[file] = fit_on(known, sizes)
    return found, fits
