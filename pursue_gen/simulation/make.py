"""What is simulated, as a person asks for it on the command line."""

from __future__ import annotations

from typing import Optional, Tuple

from pursue_gen.cli.console import tell
from pursue_gen.diagnostics import usage_error
from pursue_gen.language.scenario import Scenario
from pursue_gen.simulation.mission import Settings
from pursue_gen.simulation.runs import Case, case_of
from pursue_gen.solving.request import Asked, solution_of
from pursue_gen.tga import scenario_objective, translate
from pursue_gen.tga.network import Kind
from pursue_gen.workspace import Options

_LONG, _SHORT = 1000.0, 200.0
"""When a mission is over, in time units, unless it is said: with a goal, and without one."""
_LONGEST = 1e6


def check_until(until: Optional[float]) -> None:
    """Raises PursueError (exit status 2) for what is no end of a mission, in time units."""
    if until is not None and not 0 < until < _LONGEST:
        raise usage_error(f"--until is {until:g}", "a number of time units greater than 0, such as 200")


def make_case(
    read: Scenario, asked: Asked, opponent: str, faults: Tuple[str, ...], until: Optional[float], quiet: bool = False
) -> Case:
    """The scenario with its proven solution; `until`: when a mission is over, in time units. Raises PursueError.

    `opponent` and `faults` as for `Settings`; `quiet`: no progress is shown.
    """
    objective = scenario_objective(read)
    won = solution_of(translate(read), objective, asked, quiet)
    goal = objective.kind is not Kind.SAFETY
    settings = Settings(opponent, faults, until or (_LONG if goal else _SHORT))
    options = Options(asked.controllers, asked.reach_obj, won.reaction, won.rules.ends, won.rules.slack)
    case, knows = case_of(read, won, options, settings)
    if not knows and opponent in ("worst", "mixed") and goal:
        tell("the game is too large to tell how long plays can be: the worst opponent does anything")
    return case
