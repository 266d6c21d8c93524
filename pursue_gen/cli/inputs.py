"""Scenarios and games from files, with their warnings on stderr."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Optional, Sequence, Tuple

from pursue_gen.cli.console import show

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.tga.network import Network, Objective


def scenario_from(file: Path, request: SolveRequest, quiet: bool = False) -> Scenario:
    """The scenario in a file, with the periods that have to be found; its warnings are printed. Raises PursueError.

    `quiet`: without progress.
    """
    from pursue_gen.solving.inputs import findings_in, load_scenario

    scenario = load_scenario(file)
    show(findings_in(file))
    return with_periods(scenario, request, quiet)


def with_periods(scenario: Scenario, request: SolveRequest, quiet: bool = False) -> Scenario:
    """The scenario with the periods that have to be found, with a line of progress unless `quiet`."""
    from pursue_gen.cli.progress import progress_line
    from pursue_gen.solving.inputs import settled

    with progress_line(quiet) as progress:
        return settled(scenario, request, progress)


def game_from(
    files: Sequence[Path], request: SolveRequest, quiet: bool = False
) -> Tuple[Network, Objective, Optional[Scenario]]:
    """The ideal game of UPPAAL's two files, or of a scenario's file, with nothing optional; and the scenario.

    Warnings are printed. Raises PursueError. `quiet`: without progress.
    """
    from pursue_gen.solving.inputs import are_scenario, game_of, load_game

    if not are_scenario(files):
        return (*load_game(files), None)
    scenario = scenario_from(files[0], request, quiet)
    return (*game_of(scenario.giving_up(scenario.optional)), scenario)
