"""Commands and lines per controller, as in the thesis's tables 5.1 to 5.10, and the thesis's own figures beside them.

Commands are the pairs of a discrete state and a command in it. Lines are those of the controller's strategy file.

The thesis's "commands" are its number of if structures (of calls of its executor), its "lines" its loc: lines of
Python, where ours are lines of a data file. The scenarios are its listings 5.1 to 5.5, by the names of our files.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

from pursue_gen import __version__
from pursue_gen.columns import columns
from pursue_gen.language.scenario import Agent
from pursue_gen.partition import CENTRALIZED, DISTRIBUTED, GENERAL, SubStrategy, partition
from pursue_gen.partition.split import CONTROLLER, DEDICATED, UI
from pursue_gen.partition.strategy_data import render
from pursue_gen.solving.rules import CONTROLLABLE, REPORTED
from pursue_gen.solving.solution import Solution

_NOTES: Mapping[Optional[str], Tuple[str, ...]] = {
    None: (
        "General decides the ends of movements and actions itself; the others wait for reports of them. These are two",
        "games with a strategy each, so a share of General may be above 100 %. In one game: --ends controllable.",
    ),
    CONTROLLABLE: (
        "One strategy of the ideal game: General decides the ends of movements and actions; the others have the other",
        "commands, as in the thesis. They are for this comparison: robots play the default game.",
    ),
    REPORTED: ("One strategy of the default game: robots report the ends, so General has what Centralized has.",),
}
"""What is said of a table, by its `ends`."""


@dataclass(frozen=True)
class Row:
    """One controller: its commands, the lines of its strategy file, and the thesis's figures where it has some."""

    controller: str
    commands: int
    lines: int
    thesis: Optional[Figure] = None


@dataclass(frozen=True)
class CommandsTable:
    """A scenario's controllers: General, Centralized, then the distributed ones. Percentages are of General.

    `thesis_reach_obj` is where the thesis put reachObj's commands, None for a scenario that is not the thesis's.
    `ends`: who controls the ends of movements and actions in the game that all play; None: General plays the ideal
    game, and the rest the default one, with another strategy.
    """

    scenario: str
    reach_obj: str
    rows: Tuple[Row, ...]
    thesis_reach_obj: Optional[str] = None
    ends: Optional[str] = None


def commands_table(
    scenario_name: str,
    agents: Sequence[Agent],
    game: Solution,
    ideal: Optional[Solution] = None,
    reach_obj: Optional[str] = None,
) -> CommandsTable:
    """The table of a scenario.

    `game` is what the controllers play. `ideal` is the game with controllable ends, if General is to be made of that
    one; without it General is made of `game` too (and has the ends that its strategy commands). `reach_obj` None takes
    the thesis's policy where the scenario is one of the thesis's, else `dedicated`. Raises what `partition` raises.
    """
    thesis = thesis_table(scenario_name, tuple(agent.name for agent in agents if agent.is_robot))
    policy = reach_obj or (thesis.reach_obj if thesis else DEDICATED)
    shapes = ((GENERAL, GENERAL_NAME, ideal or game), (CENTRALIZED, CENTRALIZED_NAME, game), (DISTRIBUTED, "", game))
    rows: List[Row] = []
    for shape, title, played in shapes:
        for sub in partition(played.strategy, played.network, agents, shape, policy):
            if sub.controller == UI and shape != DISTRIBUTED:
                continue  # instructions to people are the same in every shape
            name = title if sub.controller == CONTROLLER else sub.controller
            lines = _lines(sub, scenario_name, played.reaction)
            rows.append(Row(name, sub.commands, lines, thesis.figure(name) if thesis else None))
    ends = None if ideal is not None else game.rules.ends
    return CommandsTable(scenario_name, policy, tuple(rows), thesis.reach_obj if thesis else None, ends)


def _lines(sub: SubStrategy, scenario_name: str, reaction: Fraction) -> int:
    """The lines of the controller's strategy file."""
    return render(sub, scenario_name, __version__, reaction).count("\n")


def as_json(table: CommandsTable) -> Dict[str, Any]:
    """The table as a JSON object; percentages are numbers, null where General has nothing."""
    general = table.rows[0]
    return {
        "scenario": table.scenario,
        "reach_obj": table.reach_obj,
        "thesis_reach_obj": table.thesis_reach_obj,
        "ends": table.ends,
        "controllers": [
            {
                "controller": row.controller,
                "commands": row.commands,
                "commands_percent": _percent(row.commands, general.commands),
                "lines": row.lines,
                "lines_percent": _percent(row.lines, general.lines),
                "thesis": {"commands": row.thesis.commands, "lines": row.thesis.lines} if row.thesis else None,
            }
            for row in table.rows
        ],
    }


def cells_of(table: CommandsTable, thesis: bool) -> List[List[object]]:
    """Heads and rows: counts, each with its share of General's in percent; with the `thesis`'s figures beside ours."""
    general = table.rows[0]
    rows: List[List[object]] = [[row.controller, *_shared(row, general)] for row in table.rows]
    if not (thesis and general.thesis):
        return [["controller", "commands", "%", "lines", "%"], *rows]
    for row, cells in zip(table.rows, rows):
        cells += _shared(row.thesis, general.thesis) if row.thesis else ["-"] * 4
    return [["controller", "commands", "%", "lines", "%", "thesis: commands", "%", "lines", "%"], *rows]


def _shared(one: Union[Row, Figure], general: Union[Row, Figure]) -> List[object]:
    """The commands and lines of a controller, each with its share as a table shows it."""
    shares = _percent(one.commands, general.commands), _percent(one.lines, general.lines)
    commands, lines = ("-" if share is None else f"{share:.1f}" for share in shares)
    return [one.commands, commands, one.lines, lines]


def render_table(table: CommandsTable) -> str:
    """The table as text, columns aligned, with the thesis's figures beside ours where it has some."""
    cells = [[f"{cell:,}" if isinstance(cell, int) else str(cell) for cell in row] for row in cells_of(table, True)]
    title = f"{table.scenario}: commands and lines per controller (reachObj's commands: {table.reach_obj}"
    if table.thesis_reach_obj and table.thesis_reach_obj != table.reach_obj:
        title += f"; in the thesis: {table.thesis_reach_obj}"
    return "\n".join([title + ")", "", *columns(cells, ruled=True), "", *_NOTES[table.ends]]) + "\n"


def _percent(part: int, whole: int) -> Optional[float]:
    """The share in percent, to one place; None of nothing."""
    return round(100 * part / whole, 1) if whole else None


GENERAL_NAME, CENTRALIZED_NAME = "General", "Centralized"


@dataclass(frozen=True)
class Figure:
    """One controller of the thesis."""

    controller: str
    commands: int
    lines: int


@dataclass(frozen=True)
class Times:
    """The thesis's times to the goal (its table 5.11), in seconds; None where its goal was not reached."""

    centralized: Optional[float]
    distributed: Optional[float]


@dataclass(frozen=True)
class ThesisTable:
    """One scenario of the thesis. `reach_obj` is where its author put reachObj's commands."""

    scenario: str
    reach_obj: str
    times: Times
    figures: Tuple[Figure, ...]

    def figure(self, controller: str) -> Optional[Figure]:
        """The figure of that controller, None where the thesis has none."""
        return next((figure for figure in self.figures if figure.controller == controller), None)


def _table(scenario: str, reach_obj: str, times: Times, *figures: Tuple[str, int, int]) -> ThesisTable:
    return ThesisTable(scenario, reach_obj, times, tuple(Figure(*figure) for figure in figures))


TABLES = (
    _table(
        "scenario_1",
        "bot2",
        Times(None, 37.862),
        (GENERAL_NAME, 17, 425),
        (CENTRALIZED_NAME, 9, 278),
        ("controller_bot1", 4, 182),
        ("controller_bot2", 5, 203),
    ),
    _table(
        "scenario_2",
        "all",
        Times(None, 32.007),
        (GENERAL_NAME, 20, 494),
        (CENTRALIZED_NAME, 10, 307),
        ("controller_bot1", 6, 233),
        ("controller_bot2", 3, 176),
        ("controller_bot3", 2, 152),
    ),
    _table(
        "scenario_3",
        "all",
        Times(67.821, 48.306),
        (GENERAL_NAME, 41, 862),
        (CENTRALIZED_NAME, 19, 447),
        ("controller_bot1", 7, 248),
        ("controller_bot2", 5, 205),
        ("controller_bot3", 9, 285),
    ),
    _table(
        "scenario_4",
        "all",
        Times(None, None),
        (GENERAL_NAME, 25, 609),
        (CENTRALIZED_NAME, 13, 402),
        ("controller_bot1", 4, 212),
        ("controller_bot2", 3, 193),
        ("controller_bot3", 2, 171),
        ("controller_bot4", 7, 266),
    ),
    _table(
        "catch_the_thief",
        "dedicated",
        Times(7.771, 6.795),  # its thief stood still
        (GENERAL_NAME, 779, 14697),
        (CENTRALIZED_NAME, 539, 12706),
        ("controller_polBot1", 170, 5652),
        ("controller_polBot2", 172, 5795),
        ("controllerObj", 195, 7070),
    ),
)


def thesis_table(scenario: str, robots: Tuple[str, ...]) -> Optional[ThesisTable]:
    """The thesis's table for a scenario of that name with these robots, None where it is not one of the thesis's."""
    controllers = {f"controller_{robot}" for robot in robots}
    for table in TABLES:
        named = {figure.controller for figure in table.figures if figure.controller.startswith("controller_")}
        if table.scenario == scenario and named == controllers:
            return table
    return None
