"""What a report is made of, worked out: both games solved, missions simulated, or a scenario that is lost explained."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Callable, Optional, Tuple

from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing.floor import Floor
from pursue_gen.explanation.explain import DEFAULT_SECONDS, explain
from pursue_gen.language.scenario import Scenario
from pursue_gen.proof.margin import told
from pursue_gen.report import tables
from pursue_gen.report.commands import Game
from pursue_gen.report.recording import simulated
from pursue_gen.report.verdict import Lost
from pursue_gen.report.whole import Report
from pursue_gen.solving.solution import IDEAL, Rules, Solution, played
from pursue_gen.solving.solvers import margins, solved
from pursue_gen.synthesis.limits import Limits, Listener
from pursue_gen.tga import scenario_objective, translate

_CANNOT_BE_MET = "SYN021"


@dataclass(frozen=True)
class Asked:
    """What somebody wants: who gets the objective's commands (None: the usual), `optimize` as for `solvers.solved`, so
    many simulated missions for each shape of controllers, and what lies under the map."""

    reach_obj: Optional[str] = None
    optimize: Optional[str] = None
    runs: int = 0
    floor: Optional[Floor] = None


def solved_both(
    scenario: Scenario, limits: Limits, optimize: Optional[str] = None, progress: Optional[Listener] = None
) -> Tuple[Solution, Solution]:
    """The default and the ideal game of a scenario. Raises as `solvers.solved` does."""
    network, objective = translate(scenario), scenario_objective(scenario)
    asked = (None, None, limits, None, progress, optimize)
    return solved(network, objective, Rules(), *asked), solved(network, objective, IDEAL, *asked)


def won_report(
    scenario: Scenario,
    both: Tuple[Solution, Solution],
    asked: Asked,
    limits: Limits,
    count: Callable[[int], None] = lambda done: None,
) -> Report:
    """The report on a scenario that is won; `count` hears how many missions have been simulated."""
    won = both[0]
    margin = told(margins(won, False, limits)[0], won.strategy)
    game, ideal = (Game(one.network, one.strategy, one.reaction) for one in both)
    policies = tables.command_tables(scenario, game, ideal, asked.reach_obj)
    policy = policies[0].reach_obj
    missions = tables.measured(scenario, won, policy, asked.runs, count) if asked.runs else ()
    recording = simulated(tables.case_for(scenario, won, policy), tables.FIRST)
    made = Report(scenario, won.network, won.rules, won, margin=margin, reach_obj=policy)
    return replace(made, tables=policies, missions=missions, floor=asked.floor, recording=recording)


def lost_report(
    scenario: Scenario,
    problem: PursueError,
    limits: Limits,
    progress: Optional[Listener] = None,
    floor: Optional[Floor] = None,
) -> Report:
    """The report on a scenario that is not won, as `problem` says: why, and what would change that."""
    rules = Rules()
    lost = any(finding.code == _CANNOT_BE_MET for finding in problem.diagnostics)
    seconds = min(limits.seconds, DEFAULT_SECONDS) if limits.seconds else DEFAULT_SECONDS
    explanation = explain(scenario, rules, replace(limits, seconds=seconds), progress) if lost else None
    network = played(translate(scenario), rules)
    return Report(scenario, network, rules, lost=Lost(problem.diagnostics, explanation, lost), floor=floor)
