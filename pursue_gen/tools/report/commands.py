"""Commands and lines per controller, as in the thesis's tables 5.1 to 5.10, and the thesis's own figures beside them.

Commands are the pairs of a discrete state and a command in it. Lines are those of the controller's strategy file.
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
from pursue_gen.partition.strategy_file import render
from pursue_gen.solving.rules import CONTROLLABLE, REPORTED
from pursue_gen.solving.solution import Solution
from pursue_gen.synthesis.strategy import Strategy
from pursue_gen.tga.network import Network
from pursue_gen.tools.report.thesis_figures import CENTRALIZED_NAME, GENERAL_NAME, Figure, thesis_table

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
class Game:
    """A strategy with the network that it is for, the reaction delay (time units) that it allows, and who controls the
    ends (as in `Rules`).
    """

    network: Network
    strategy: Strategy
    reaction: Fraction = Fraction(0)
    ends: str = REPORTED


def game_of_solution(won: Solution) -> Game:
    """The game that a solution wins."""
    return Game(won.network, won.strategy, won.reaction, won.rules.ends)


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
    game: Game,
    ideal: Optional[Game] = None,
    reach_obj: Optional[str] = None,
) -> CommandsTable:
    """The table of a scenario.

    `game` is what the controllers play. `ideal` is the game with controllable ends, if General is to be made of that
    one; without it General is made of `game` too (and has the ends that its strategy commands). `reach_obj` None takes
    the thesis's policy where the scenario is one of the thesis's, else `dedicated`. Raises what `partition`
    raises.
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
    ends = None if ideal is not None else game.ends
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
