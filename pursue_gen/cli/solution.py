"""Solving with a line of progress, the verdict on stderr, and an explanation where the scenario is not won."""

from __future__ import annotations

import contextlib
from typing import Any, Dict, Iterator

from pursue_gen import api
from pursue_gen.cli.console import ended, info, show
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.request import SolveRequest


def solve_and_print(scenario: Scenario, request: SolveRequest, explain: bool) -> api.Solved:
    """What is promised of a scenario, with its proven solution; the verdict and warnings are printed.

    `explain`: where it is not won, why. Raises as `api.solve`.
    """
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
