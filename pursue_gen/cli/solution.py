"""Solving with a line of progress, the verdict on stderr, and an explanation where the scenario is not won."""

from __future__ import annotations

import contextlib
import traceback
from typing import Any, Dict, Iterator

from pursue_gen.cli.console import ended, info, show
from pursue_gen.cli.progress import progress_line
from pursue_gen.diagnostics import PursueError
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.wording import condition_of_promise, periods_found, promise_words
from pursue_gen.outcomes import LimitHit, Lost
from pursue_gen.solving.answers import answers
from pursue_gen.solving.optional import Promised, promised_of
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import rules_text
from pursue_gen.solving.verdict import verdict_text
from pursue_gen.synthesis.limits import UNDECIDED
from pursue_gen.tga import translate


def solve_and_print(scenario: Scenario, request: SolveRequest, explain: bool) -> Promised:
    """What is promised of a scenario, with its proven solution; the verdict and warnings are printed.

    `explain`: where it is not won, why. Raises as `promised_of`.
    """
    try:
        with progress_line() as progress:
            found = promised_of(scenario, request, progress)
    except PursueError as problem:
        if explain and explained(problem, scenario, request):
            raise ended(problem) from None
        raise
    won = found.solution
    show(won.warnings)
    if request.plan is None:
        info(verdict_text(won))
    elif not won.warnings:
        info(f"{request.plan} wins: {rules_text(won.rules)}")
    for answer in answers(found.scenario, won, request.options.limits):
        info(answer.in_words())
    show_promise(found.scenario, request.plan is None)
    show_unneeded(found)
    return found


def show_unneeded(found: Promised) -> None:
    """Prints which robots and allies the strategy does without, if any."""
    from pursue_gen.partition import unneeded, unneeded_words

    words = unneeded_words(unneeded(found.scenario, found.solution.strategy))
    if words:
        info(words)


def show_promise(scenario: Scenario, assumptions: bool = True) -> None:
    """Prints which periods were found, which optional objectives are promised, and what the verdict assumes of others,
    if anything.
    """
    show_periods(scenario)
    for sentence in promise_words(scenario):
        info(f"{sentence}.")
    if not assumptions:
        return
    assumed = condition_of_promise(scenario)
    if assumed:
        info(f"This holds {assumed}.")


def explained(
    problem: PursueError, scenario: Scenario, request: SolveRequest, quiet: bool = False
) -> Dict[str, Any]:
    """Prints the findings of a scenario that is not won, even with nothing optional, and why that is so, which takes a
    fixed amount of work.

    Lost: what would change that. Not decided within a limit: what makes it so large. `quiet`: without progress.
    Returns {"explanation": …} or {"costs": …} for JSON. Prints nothing, and returns an empty dict, where the problem is
    another one, or another solver or a given plan has it.
    """
    traceback.clear_frames(problem.__traceback__)  # what the search that has ended holds, else counts as in use
    scenario = scenario.giving_up(scenario.optional)
    limits, rules = request.options.limits, request.rules(translate(scenario))
    if isinstance(problem, Lost) and request.options.solver is None:
        from pursue_gen.explanation.explain import as_json, explain, render

        show(problem.diagnostics)
        show_periods(scenario, won=False)
        info("Looking for what would change that (--no-explain leaves it out) …")
        with progress_line(quiet) as progress:
            explanation = explain(scenario, rules, limits, progress, problem.parts)
        info(render(explanation).rstrip())
        return {"explanation": as_json(explanation)}
    ours = request.plan is None and request.options.solver is None
    if isinstance(problem, LimitHit) and ours and problem.diagnostics[0].code == UNDECIDED:
        from pursue_gen.explanation import costs

        show(problem.diagnostics)
        info("Looking for what makes it so large …")
        option = "" if request.within is None else f"--within {request.within}"
        with progress_line(quiet) as progress:
            found = costs.costs(scenario, rules, limits, progress, option)
        info(costs.in_words(found))
        return {"costs": costs.as_json(found)}
    return {}


def show_periods(scenario: Scenario, won: bool = True) -> None:
    """Prints which periods were found for patrols that name none."""
    for sentence in periods_found(scenario, won):
        info(sentence)


@contextlib.contextmanager
def naming_costs(scenario: Scenario, request: SolveRequest, quiet: bool = False) -> Iterator[None]:
    """Where a limit ends what is done meanwhile, what makes the scenario so large is printed after the error."""
    try:
        yield
    except LimitHit as problem:
        if explained(problem, scenario, request, quiet):
            raise ended(problem) from None
        raise
