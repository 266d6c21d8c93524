"""The thesis's tables for a scenario: commands and lines per controller and policy, and times to the goal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, List, Optional, Sequence, Tuple

from pursue_gen.language.numbers import at_most
from pursue_gen.language.scenario import Scenario
from pursue_gen.language.times import unit_name
from pursue_gen.partition.split import ALL, CENTRALIZED, DEDICATED, DISTRIBUTED
from pursue_gen.solving.solution import Solution
from pursue_gen.tools.report.commands import CommandsTable, ThesisTable, cells_of, commands_table, thesis_table
from pursue_gen.tools.report.html import Section, rendered, table
from pursue_gen.tools.simulation.outcome import Settings
from pursue_gen.tools.simulation.outcome_table import END_TEXTS, driven_words
from pursue_gen.tools.simulation.runs import Case, Summary, case_of, simulate, usual_end
from pursue_gen.workspace import Options

FIRST = 1
"""The number of the first mission that is simulated."""


@dataclass(frozen=True)
class Measured:
    """Simulated missions with the controllers of one shape."""

    controllers: str
    summary: Summary


def command_tables(
    scenario: Scenario, game: Solution, ideal: Solution, reach_obj: Optional[str] = None
) -> Tuple[CommandsTable, ...]:
    """A table for each policy for the objective's commands, `reach_obj` first (None: the thesis's or `dedicated`); at
    last one with the first policy and all controllers in the ideal game.
    """
    robots = [agent.name for agent in scenario.agents if agent.is_robot]
    first = commands_table(scenario.name, scenario.agents, game, ideal, reach_obj)
    policies = [DEDICATED, *([ALL, *robots] if robots and scenario.reach else [])]
    others = [policy for policy in policies if policy != first.reach_obj]
    more = [commands_table(scenario.name, scenario.agents, game, ideal, policy) for policy in others]
    return (first, *more, commands_table(scenario.name, scenario.agents, ideal, reach_obj=first.reach_obj))


def case_for(scenario: Scenario, won: Solution, reach_obj: str, shape: str = DISTRIBUTED) -> Case:
    """What is simulated with controllers of that shape."""
    options = Options(shape, reach_obj, won.reaction, won.rules.ends, won.rules.slack)
    return case_of(scenario, won, options, Settings("mixed", (), usual_end(won)))[0]


def measured(
    scenario: Scenario, won: Solution, reach_obj: str, runs: int, progress: Callable[[int], None] = lambda done: None
) -> Tuple[Measured, ...]:
    """So many simulated missions each with central and with distributed controllers; the same seeds each time.

    The uncontrollable agents do in turn anything, the worst, and nothing. `progress` is called with how many are done.
    """
    result: List[Measured] = []
    for shape in (CENTRALIZED, DISTRIBUTED):
        before = len(result) * runs
        case = case_for(scenario, won, reach_obj, shape)
        result.append(Measured(shape, simulate(case, range(FIRST, FIRST + runs), progress=_from(before, progress))))
    return tuple(result)


def _from(before: int, progress: Callable[[int], None]) -> Callable[[int], None]:
    return lambda done: progress(before + done)


def section(
    scenario: Scenario, won: Solution, tables: Sequence[CommandsTable], missions: Sequence[Measured]
) -> Section:
    """The tables on the page."""
    robots = tuple(agent.name for agent in scenario.agents if agent.is_robot)
    thesis, unit = thesis_table(scenario.name, robots), unit_name(scenario.unit)
    ideal, others = [[_policy(one, False) for one in tables[1:] if bool(one.ends) is ends] for ends in (True, False)]
    body = rendered(
        "tables",
        first=_policy(tables[0], True),
        others="".join(others),
        ideal="".join(ideal),
        goal=won.objective.reaches,
        times=_times(won, missions, thesis, unit) if won.objective.reaches else _safety(missions, unit),
        missions=missions,
        thesis=thesis,
        driven=[text for one in missions[-1:] for text in driven_words(one.summary)],
        failed=sum(one.summary.failed for one in missions),
    )
    return Section("tables", "Commands and times", body)


def _policy(one: CommandsTable, first: bool) -> str:
    owner = {DEDICATED: "a controller of their own has them", ALL: "every robot has them"}
    policy = owner.get(one.reach_obj, f"{one.reach_obj} has them")
    thesis = one.reach_obj == one.thesis_reach_obj
    heads, *rows = cells_of(one, thesis)
    end = ", as in the thesis" if thesis and first else ""
    return table(heads, rows, f"The objective's commands: {policy}{end}")


def _times(won: Solution, missions: Sequence[Measured], thesis: Optional[ThesisTable], unit: str) -> str:
    heads = ["time to the goal", "least", "median", "worst", *(["thesis (seconds)"] if thesis else [])]
    worst = won.guarantee.worst if won.guarantee else None
    rows: List[List[object]] = [["guaranteed", "", "", "not found out" if worst is None else at_most(worst)]]
    rows[0] += [""] if thesis else []
    for one in missions:
        reached = [row for row in one.summary.rows if row.end == "goal"]
        label = f"simulated, {one.controllers} ({one.summary.missions} missions)"
        found = [_number(v) for row in reached for v in (row.least, row.median, row.worst)] or ["not reached", "", ""]
        if thesis:
            seconds = thesis.times.centralized if one.controllers == CENTRALIZED else thesis.times.distributed
            found.append("not reached" if seconds is None else _number(seconds))
        rows.append([label, *found])
    return table(heads, rows, f"In {unit} from the start")


def _safety(missions: Sequence[Measured], unit: str) -> str:
    rows = [
        [one.controllers, END_TEXTS[row.end], row.missions, _number(row.worst)]
        for one in missions
        for row in one.summary.rows
    ]
    short = "units" if unit == "time units" else unit
    heads = ["controllers", "outcome", "missions", f"watched for ({short})"]
    return table(heads, rows, "Simulated missions, without faults") if rows else ""


def _number(value: float) -> str:
    return f"{value:.2f}"
