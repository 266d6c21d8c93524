"""What a report is made of, worked out: both games solved, missions simulated, or a scenario that is lost explained."""

from __future__ import annotations

import traceback
from dataclasses import dataclass, replace
from typing import Callable, Optional, Tuple

from pursue_gen import outcomes
from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.floor import Floor
from pursue_gen.explanation.costs import costs
from pursue_gen.explanation.explain import explain
from pursue_gen.language.scenario import Scenario
from pursue_gen.solving.inputs import game_of
from pursue_gen.solving.optional import promised, promised_of
from pursue_gen.solving.options import SolveOptions
from pursue_gen.solving.request import SolveRequest
from pursue_gen.solving.rules import IDEAL, Rules, played
from pursue_gen.solving.solution import Solution
from pursue_gen.solving.solvers import solved
from pursue_gen.solving.verdict import margin_text, margins
from pursue_gen.synthesis.limits import Limits, Listener
from pursue_gen.tga import translate
from pursue_gen.tools.report import tables
from pursue_gen.tools.report.commands import game_of_solution
from pursue_gen.tools.report.recording import simulated
from pursue_gen.tools.report.verdict import Lost
from pursue_gen.tools.report.whole import Report


@dataclass(frozen=True)
class ReportOptions:
    """What a report holds.

    `reach_obj`: who gets the objective's commands (None: the usual); `runs`: how many missions are simulated for each
    shape of controllers; `floor`: the floor plan under the map.
    """

    reach_obj: Optional[str] = None
    runs: int = 0
    floor: Optional[Floor] = None


def solved_both(scenario: Scenario, options: SolveOptions) -> Tuple[Scenario, Tuple[Solution, Solution]]:
    """What is promised of a scenario in the default game, solved in that and in the ideal game. Raises as
    `solvers.solved` does.
    """
    found = promised(scenario, options, lambda some, how: solved(*game_of(some), Rules(), how))
    return found.scenario, (found.solution, solved(*game_of(found.scenario), IDEAL, options))


def solved_games(
    scenario: Scenario, request: SolveRequest, progress: Optional[Listener] = None
) -> Tuple[Scenario, Tuple[Solution, ...]]:
    """What is promised of a scenario, and its solutions: in the game that `request.ends` names, else those of
    `solved_both`. Raises as `solvers.solved` does.
    """
    if request.ends is None:
        return solved_both(scenario, replace(request.options, within=request.deadline, progress=progress))
    found = promised_of(scenario, request, progress)
    return found.scenario, (found.solution,)


def won_report(
    scenario: Scenario,
    both: Tuple[Solution, Solution],
    options: ReportOptions,
    limits: Limits,
    count: Callable[[int], None] = lambda done: None,
) -> Report:
    """The report on a scenario that is won; `count` is called with how many missions have been simulated."""
    won = both[0]
    margin = margin_text(won, margins(won, False, limits)[0], unit=scenario.unit)
    game, ideal = map(game_of_solution, both)
    policies = tables.command_tables(scenario, game, ideal, options.reach_obj)
    policy = policies[0].reach_obj
    missions = tables.measured(scenario, won, policy, options.runs, count) if options.runs else ()
    recording = simulated(tables.case_for(scenario, won, policy), tables.FIRST)
    made = Report(scenario, won.network, won.rules, won, margin=margin, reach_obj=policy)
    return replace(made, tables=policies, missions=missions, floor=options.floor, recording=recording)


def lost_report(
    scenario: Scenario,
    problem: PursueError,
    limits: Limits,
    progress: Optional[Listener] = None,
    floor: Optional[Floor] = None,
    option: str = "",
) -> Report:
    """The report on a scenario that is not won, as `problem` says: why, and what would change that; or that it is not
    decided, and what makes it so large (`option` as for `costs`).
    """
    traceback.clear_frames(problem.__traceback__)  # what the search that has ended holds, else counts as in use
    rules, scenario = Rules(), scenario.giving_up(scenario.optional)
    if isinstance(problem, outcomes.Lost):
        lost = Lost(problem.diagnostics, explain(scenario, rules, limits, progress, problem.parts))
    else:
        lost = Lost(problem.diagnostics, None, costs(scenario, rules, limits, progress, option))
    return Report(scenario, played(translate(scenario), rules), rules, lost=lost, floor=floor)
