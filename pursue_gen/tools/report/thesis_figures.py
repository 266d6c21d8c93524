"""How many commands and lines the controllers of the thesis have (its tables 5.1 to 5.10), to compare with.

"Commands" is the thesis's number of if structures (of calls of its executor), "lines" its loc: lines of Python, where
ours are lines of a data file. The scenarios are its listings 5.1 to 5.5, by the names of our files for them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional, Tuple

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
