"""The case to simulate, of a solved scenario."""

from __future__ import annotations

from typing import Optional, Tuple

from pursue_gen.diagnostics import usage_error
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.runs import Case, case_of
from pursue_gen.workspace.make import options_for

_LONG, _SHORT = 1000.0, 200.0
"""The default time after which a mission is over, in time units: with a goal, and without one. Not measured."""

_SPARE = 2
"""With a goal it is at least so many times as long as the strategy takes at worst. Not measured."""

_LONGEST = 1e6


def usual_end(won: Solution) -> float:
    """When a mission is over if nobody says so, in time units."""
    if not won.objective.reaches:
        return _SHORT
    worst = None if won.guarantee is None else won.guarantee.worst
    return max(_LONG, float(_SPARE * (worst or 0)))


def check_until(until: Optional[float]) -> None:
    """Raises PursueError (exit status 2) for what is no end of a mission, in time units."""
    if until is not None and not 0 < until < _LONGEST:
        raise usage_error(f"--until is {until:g}", "a number of time units greater than 0, such as 200")


def make_case(
    scenario: Scenario,
    won: Solution,
    request: SolveRequest,
    opponent: str,
    faults: Tuple[str, ...],
    until: Optional[float],
) -> Tuple[Case, bool]:
    """The case to simulate, and whether its worst opponent knows how long plays can be.

    `opponent` and `faults` as for `Settings`; `until`: when a mission is over, in time units; None for the default. It
    does not know where the game is too large or the strategy has stages: then it does anything.
    """
    check_until(until)
    goal = won.objective.reaches
    settings = Settings(opponent, faults, until or usual_end(won))
    case, knows = case_of(scenario, won, options_for(request, won), settings)
    return case, knows or not goal or opponent not in ("worst", "mixed")
