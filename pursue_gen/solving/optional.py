"""Optional objectives: those that can be promised together with the rest, in the order of their numbers.

All that is not optional has to be promised, else the scenario is lost. Then the objectives with number 1 are added,
then those with number 2, and so on: each number stays that can be promised together with all that stayed before.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Mapping, Optional, Tuple, TypeVar

from pursue_gen.diagnostics import PursueError
from pursue_gen.language.objectives import WhyGivenUp
from pursue_gen.language.scenario import Scenario
from pursue_gen.outcomes import LimitHit, Lost, NotProven, TooSlow
from pursue_gen.solving.given_plan import Trial, try_plan
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.lost_promises import in_words
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest, solution_of
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.limits import Listener

WORK = 100_000_000
"""The work of a game with an optional objective: some twenty seconds. What takes more is given up. Not measured."""

T = TypeVar("T")

Solve = Callable[[Scenario, SolveOptions], Solution]
"""Solves a scenario of which everything has to be promised."""


@dataclass(frozen=True)
class Promised:
    """A scenario of which all objectives are promised, those that were given up aside, and its solution."""

    scenario: Scenario
    solution: Solution


def promised(scenario: Scenario, options: SolveOptions, solve: Solve) -> Promised:
    """The scenario with those of its optional objectives that can be promised, and its solution.

    Each number gets an equal share of the seconds that are left (all of them, where nobody has set any), and no more
    than WORK. Raises as `solve` where what is not optional cannot be promised, or is not decided.
    """
    start, numbers = options.limits.now(), scenario.optional
    base = scenario.giving_up(numbers)
    try:
        best = Promised(base, solve(base, options))
    except Lost as problem:
        raise in_words(problem, base) if problem.parts else problem from None
    given_up: Dict[int, WhyGivenUp] = {}
    for place, number in enumerate(numbers):
        limits = options.limits
        seconds = limits.seconds if limits.by_default else limits.since(start).left / (len(numbers) - place)
        share = replace(options, limits=replace(limits, seconds=seconds, spent=0.0), most_work=WORK)
        more = _without(scenario, numbers[place + 1 :], given_up)
        try:
            best = Promised(more, solve(more, share))
        except (Lost, TooSlow):
            given_up[number] = WhyGivenUp.IMPOSSIBLE
        except LimitHit:
            given_up[number] = WhyGivenUp.TOO_MUCH_WORK
        except NotProven:
            given_up[number] = WhyGivenUp.REFUSED
    return replace(best, scenario=_without(scenario, (), given_up))


def _without(scenario: Scenario, later: Tuple[int, ...], given_up: Mapping[int, WhyGivenUp]) -> Scenario:
    scenario = scenario.giving_up(later)
    for number, why in given_up.items():
        scenario = scenario.giving_up((number,), why)
    return scenario


def promised_of(scenario: Scenario, request: SolveRequest, progress: Optional[Listener] = None) -> Promised:
    """What is promised of a scenario, with the solution that was asked for; a given plan is proven for the first of
    `choices` that it wins. Raises as `solution_of`.
    """

    def solve(some: Scenario, options: SolveOptions) -> Solution:
        return solution_of(*game_of(some), replace(request, options=options), progress)

    if request.plan is None:
        return promised(scenario, request.options, solve)
    return _first(scenario, lambda choice: Promised(choice, solve(choice, request.options)), lambda found: True)


def try_plan_of(
    scenario: Scenario, plan: Path, request: SolveRequest, options: SolveOptions
) -> Tuple[Scenario, Tuple[Trial, ...]]:
    """The plan in a file, tried as `try_plan` does for each of `choices` until it wins one: which, and how."""

    def tried(choice: Scenario) -> Tuple[Scenario, Tuple[Trial, ...]]:
        network, objective = game_of(choice)
        return choice, try_plan(plan, network, objective, request.games(network), options)

    return _first(scenario, tried, lambda found: found[1][-1].solution is not None)


def _first(scenario: Scenario, attempt: Callable[[Scenario], T], wins: Callable[[T], bool]) -> T:
    """What comes of the first of `choices` that wins, else of the first one. Raises as `attempt` where all do that."""
    found: List[T] = []
    problems: List[PursueError] = []
    for choice in choices(scenario):
        try:
            found.append(attempt(choice))
        except PursueError as problem:
            problems.append(problem)
            continue
        if wins(found[-1]):
            return found[-1]
    if not found:
        raise problems[0]
    return found[0]


def choices(scenario: Scenario) -> Iterator[Scenario]:
    """The scenario with everything promised, then with less and less of it, what is to be kept longest last."""
    numbers = scenario.optional
    for kept in product((True, False), repeat=len(numbers)):
        yield scenario.giving_up([number for number, keep in zip(numbers, kept) if not keep])
