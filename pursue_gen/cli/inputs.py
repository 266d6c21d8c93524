"""Scenarios from files, with their warnings on stderr."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Sequence

from pursue_gen.cli.console import show

if TYPE_CHECKING:
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.solving.request import SolveRequest


def are_scenario(files: Sequence[Path]) -> bool:
    """True for one file that is not a network of UPPAAL."""
    return len(files) == 1 and files[0].suffix != ".xml"


def scenario_from(file: Path, request: SolveRequest, quiet: bool = False) -> Scenario:
    """The scenario in a file, with the periods that have to be found; its warnings are printed. Raises PursueError.

    `quiet`: without progress.
    """
    from pursue_gen import api

    scenario = api.read(file)
    show(api.check(scenario))
    return settled(scenario, request, quiet)


def settled(scenario: Scenario, request: SolveRequest, quiet: bool = False) -> Scenario:
    """The scenario with the periods that have to be found, with a line of progress unless `quiet`."""
    from pursue_gen import api
    from pursue_gen.cli.progress import progress_line

    with progress_line(quiet) as progress:
        return api.settle(scenario, request, progress)
