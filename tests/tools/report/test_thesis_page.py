"""docs/thesis.md: the figures beside the thesis's are those that the command prints."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

from typer.testing import CliRunner

from pursue_gen.cli.app import app

ROOT = Path(__file__).resolve().parents[3]


def rows_of_the_comparison(heading: str) -> List[List[str]]:
    """The rows of the first table below a heading of docs/thesis.md, its head left out; the name of a scenario stands
    in each of its rows."""
    page = (ROOT / "docs" / "thesis.md").read_text(encoding="utf-8").split(f"\n{heading}\n")[1].split("\n#")[0]
    lines = [line for line in page.splitlines() if line.startswith("|")][2:]
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    name = ""
    for row in rows:
        row[0] = name = row[0].partition(" (")[0] or name
    return rows


def rows_of_report(*options: str) -> Iterator[Tuple[str, Dict[str, Any], Dict[str, Any]]]:
    """Name of a scenario of the thesis, a row of its table, and that of General."""
    names = {"scenario_1": "1", "scenario_2": "2", "scenario_3": "3", "scenario_4": "4"}
    for file, name in {**names, "catch_the_thief": "catch the thief"}.items():
        scenario = ROOT / "scenarios" / "thesis" / f"{file}.pur"
        rows = json.loads(CliRunner().invoke(app, ["report", str(scenario), "--json", *options]).stdout)["controllers"]
        for row in rows:
            yield name, row, rows[0]


# The engines find different strategies; the figures are those of the native one.
def test_the_figures_beside_those_of_the_thesis_are_those_that_report_prints() -> None:
    expected = [
        [name, row["controller"], *(f"{one[what]}" for one in (row, row["thesis"]) for what in ("commands", "lines"))]
        for name, row, _ in rows_of_report()
    ]
    assert rows_of_the_comparison("### Two games") == expected


def test_the_shares_in_one_game_are_those_that_report_prints() -> None:
    expected = []
    for name, row, general in rows_of_report("--ends", "controllable"):
        thesis = 100 * row["thesis"]["commands"] / general["thesis"]["commands"]
        expected.append([name, row["controller"], f"{row['commands']}", f"{row['commands_percent']}", f"{thesis:.1f}"])
    assert rows_of_the_comparison("### One game") == expected
