"""The whole report of a scenario: what it is made of (both games solved, missions simulated, or a scenario that is lost
explained), its page, and its pictures as files."""

from __future__ import annotations

import traceback
from dataclasses import dataclass, replace
from typing import Callable, Dict, Optional, Sequence, Tuple

from pursue_gen import outcomes
from pursue_gen.diagnostics import PursueError
from pursue_gen.drawing import map_svg
from pursue_gen.drawing.floor import Floor
from pursue_gen.drawing.layout import poses
from pursue_gen.drawing.look import safe
from pursue_gen.explanation.costs import costs
from pursue_gen.explanation.explain import explain
from pursue_gen.language.scenario import Scenario
from pursue_gen.partition import partition
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
from pursue_gen.tga.network import Network
from pursue_gen.tools.report import animation, automata, graphviz, ros_graph, strategy, tables, timeline, verdict
from pursue_gen.tools.report.commands import CommandsTable
from pursue_gen.tools.report.html import Section, figure, page
from pursue_gen.tools.report.recording import Recording, simulated
from pursue_gen.tools.report.strategy_data import StrategyData, strategy_data_of
from pursue_gen.tools.report.tables import Measured
from pursue_gen.tools.report.verdict import Lost
from pursue_gen.workspace.spots import SPOT_DISTANCE, placing


@dataclass(frozen=True)
class Report:
    """The content of a report. `network` is the game as it is played under `rules`.

    A scenario that is won has `won`, `margin` (sentences), `tables` and `missions` (empty: not simulated); one that is
    not has `lost`. `reach_obj`: who gets the objective's commands. `floor`: what lies under the map. `recording`: the
    mission that is shown as a timeline and as an animation.
    """

    scenario: Scenario
    network: Network
    rules: Rules
    won: Optional[Solution] = None
    lost: Optional[Lost] = None
    margin: str = ""
    reach_obj: str = "dedicated"
    tables: Tuple[CommandsTable, ...] = ()
    missions: Tuple[Measured, ...] = ()
    floor: Optional[Floor] = None
    recording: Optional[Recording] = None


def report_page(report: Report) -> str:
    """The page. Where graphviz is not installed there are tables instead of some pictures, and it says so."""
    scenario, won = report.scenario, report.won
    sections = [verdict.section(scenario, report.rules, won, report.margin, report.lost), _map(report)]
    if report.recording is not None:
        sections += [timeline.section(report.recording), animation.section(scenario, report.recording, report.floor)]
    if won is not None:
        sections.append(strategy.section(_strategy_data(report, won)))
        sections.append(tables.section(scenario, won, report.tables, report.missions))
    sections.append(automata.section(report.network, scenario))
    if won is not None:
        sections.append(ros_graph.section(_topics(report, won)))
    sections.append(Section("scenario", "The scenario", _text(scenario.text)))
    return page(f"Report on {scenario.name}", sections)


def _text(text: str) -> str:
    """The scenario's text, which the keyboard can scroll where it is wider than the page."""
    return f'<pre tabindex="0" role="region" aria-label="The text of the scenario">{safe(text)}</pre>'


def pictures(report: Report) -> Dict[str, str]:
    """Every picture as SVG, by the name of its file without its ending; empty texts: graphviz could not draw them."""
    found = {"map": _map_svg(report)}
    if report.recording is not None:
        found["timeline"] = timeline.draw(report.recording, "timeline-picture")
    graphs = {f"automaton_{a.name}": automata.graph(a) for a in report.network.automata}
    if report.won is not None:
        graphs["strategy"] = strategy.graph(_strategy_data(report, report.won))
        graphs["ros_graph"] = ros_graph.graph(_topics(report, report.won))
    for name, graph in graphs.items():
        if graph is not None:
            found[name] = graphviz.draw(graph) or ""
    return found


def _map(report: Report) -> Section:
    _, computed = poses(report.scenario)
    positions = f"Positions are {'computed from the distances' if computed else 'those of the scenario, in metres'}."
    if report.floor is not None:
        apart = f"{SPOT_DISTANCE:g} m apart unless the scenario says where"
        positions += f" Small marks are where further robots stand, {apart}."
    shown = figure(_map_svg(report, "map-picture"), f"{positions} Distances stand at the connections.")
    return Section("map", "The map", shown)


def _map_svg(report: Report, ident: str = "") -> str:
    where = placing(report.scenario, SPOT_DISTANCE)
    spots = where.spots if report.floor is not None else None
    return map_svg.draw(report.scenario, where.places, where.computed, report.floor, ident, spots)


def _strategy_data(report: Report, won: Solution) -> StrategyData:
    return strategy_data_of(report.scenario, won, report.reach_obj)


def _topics(report: Report, won: Solution) -> Sequence[ros_graph.Topic]:
    subs = partition(won.strategy, won.network, report.scenario.agents, reach_obj=report.reach_obj)
    return ros_graph.topics(report.scenario, subs)


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
    policies = tables.command_tables(scenario, *both, options.reach_obj)
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
