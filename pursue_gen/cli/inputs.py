"""Scenarios from files, with their warnings on stderr; on maps; and solved, with a line of progress, the verdict, and
an explanation where one is not won. What is needed for that is imported when it is done."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, Iterator, Optional, Sequence, Tuple

from pursue_gen.cli.console import ended, info, show
from pursue_gen.diagnostics import PursueError
from pursue_gen.outcomes import LimitHit, Lost

if TYPE_CHECKING:
    from pursue_gen import api
    from pursue_gen.diagnostics import Diagnostic
    from pursue_gen.drawing.floor import Floor
    from pursue_gen.language.scenario import Scenario
    from pursue_gen.solving.request import SolveRequest
    from pursue_gen.workspace.levels import Level
    from pursue_gen.workspace.robot_size import Sizes, Told

Levels = Tuple["Level", ...]


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


def placed_on(scenario: Scenario, file: Path, distance: float, told: Told) -> Tuple[Scenario, Optional[Floor], Levels]:
    """The scenario with the spots that its maps have room for, the floor plan with the paths of its ways, None of
    several levels, and the levels; findings are printed. Raises PursueError for a map that cannot be used."""
    from pursue_gen.drawing.floor_picture import read_floor
    from pursue_gen.workspace.levels import read_levels
    from pursue_gen.workspace.map_spots import with_spots
    from pursue_gen.workspace.robot_size import sizes_of

    levels, sizes = read_levels(file), sizes_of(scenario, told)
    floor = read_floor(file) if levels[0].elevation is None else None
    findings, levels = on_map(scenario, levels, distance, sizes)
    show(findings)
    floor = None if floor is None else replace(floor, paths=levels[0].ways)
    return with_spots(scenario, levels, distance, sizes), floor, levels


def on_map(scenario: Scenario, levels: Levels, distance: float, sizes: Sizes) -> Tuple[Tuple[Diagnostic, ...], Levels]:
    """The findings of `survey`, and the levels with the paths of the ways; of the points alone, and no paths, where its
    packages or pixels are missing."""
    from pursue_gen.workspace.map_check import check_spots

    if all(level.ground.cells is not None for level in levels):
        try:
            import scipy

            from pursue_gen.survey.make import found_on_map
        except ImportError:
            info("Ways are not looked at on the map without numpy and scipy: pip install 'pursue-gen[survey]'")
        else:
            del scipy
            return found_on_map(scenario, levels, distance, sizes)
    return check_spots(scenario, levels, distance, sizes), levels


def solve_and_print(scenario: Scenario, request: SolveRequest, explain: bool) -> api.Solved:
    """What is promised of a scenario, with its proven solution; the verdict and warnings are printed.

    `explain`: where it is not won, why. Raises as `api.solve`.
    """
    from pursue_gen import api
    from pursue_gen.cli.progress import progress_line

    try:
        with progress_line() as progress:
            solved = api.solve(scenario, request, progress)
    except PursueError as problem:
        if explain and explained(problem, scenario, request):
            raise ended(problem) from None
        raise
    show(solved.solution.warnings)
    for line in solved.in_words():
        info(line)
    return solved


def explained(problem: PursueError, scenario: Scenario, request: SolveRequest, quiet: bool = False) -> Dict[str, Any]:
    """Prints the findings of a scenario that is not won, even with nothing optional, and why that is so.

    `quiet`: without progress. Returns {"explanation": …} or {"costs": …} for JSON. Prints nothing, and returns an empty
    dict, where `api.explain` does not know the problem.
    """
    from pursue_gen import api
    from pursue_gen.cli.progress import progress_line

    if not api.can_explain(problem, request):
        return {}
    show(problem.diagnostics)
    if isinstance(problem, Lost):
        for sentence in api.promises_of(scenario, won=False):
            info(sentence)
        info("Looking for what would change that (--no-explain leaves it out) …")
    else:
        info("Looking for what makes it so large …")
    with progress_line(quiet) as progress:
        why = api.explain(scenario, problem, request, progress)
    info(why.text)
    return why.data


@contextlib.contextmanager
def naming_costs(scenario: Scenario, request: SolveRequest, quiet: bool = False) -> Iterator[None]:
    """Where a limit ends what is done meanwhile, what makes the scenario so large is printed after the error."""
    try:
        yield
    except LimitHit as problem:
        if explained(problem, scenario, request, quiet):
            raise ended(problem) from None
        raise
