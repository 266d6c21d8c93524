"""Ordinary work: what is measured of it, and the tables of that."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any, Dict, List
from unittest import mock

import pytest

from benchmarks import command, ordinary, ordinary_page
from benchmarks.lab_scenarios import Size, lab_scenario
from benchmarks.ordinary_families import ORDINARY
from benchmarks.process import Ran

pytestmark = pytest.mark.benchmark

TINY = Size(places=3, robots=1, people=1, promises=1)

ROW: Dict[str, Any] = {
    "group": "command", "name": "lab 0", "size": 0, "game": "default", "verdict": "won", "outcome": "",
    "cpu": 0.5, "goal": 10, "memory": 40.2, "commands": 9, "date": "2026-11-24", "version": "abc",
}  # fmt: skip


def test_every_member_of_a_family_has_a_goal() -> None:
    assert [(goal.name, goal.size) for goal in ordinary.GOALS] == [
        (family.name, size) for family in sorted(ORDINARY, key=lambda one: _place(one.name)) for size in family.sizes
    ]


def _place(name: str) -> int:
    return next(place for place, goal in enumerate(ordinary.GOALS) if goal.name == name)


def test_a_lab_scenario_is_solved_as_people_call_it() -> None:
    with mock.patch.dict(ordinary.LABS, {"lab": (TINY, 600.0, 0.97)}):
        (row,) = ordinary.labs_measured("lab", 1)
    assert (row["name"], row["size"], row["game"], row["outcome"]) == ("lab 0", 0, "default", "")
    assert row["verdict"] in ("won", "lost") and row["cpu"] > 0


def test_each_seed_has_its_file_and_its_limits() -> None:
    seen: List[str] = []

    def run(arguments: List[str], seconds: float, _: Path, addresses: int, __: float) -> Ran:
        file = next(Path(argument) for argument in arguments if argument.endswith(".pur"))
        seen.append(file.read_text())
        assert seconds == 30 and arguments[arguments.index("--memory") + 1] == "1024" and addresses > 1024
        return Ran(-24, True, "", "", 30.0, 900.0)

    with mock.patch.object(command, "run", run):
        rows = list(ordinary.labs_measured("large lab", 2))
    assert seen == [lab_scenario(seed, ordinary.LABS["large lab"][0]) for seed in (0, 1)]
    assert [(row["name"], row["outcome"]) for row in rows] == [("large lab 0", "time"), ("large lab 1", "time")]


def test_a_family_is_measured_and_its_names_are_known(capsys: pytest.CaptureFixture[str]) -> None:
    goal = next(goal for goal in ordinary.GOALS if goal.title == "buildings apart 1")
    (row,) = ordinary.families_measured([goal])
    assert (row["name"], row["verdict"], row["goal"]) == ("buildings apart 1", "won", goal.seconds)
    with pytest.raises(SystemExit):
        ordinary.main(["--families", "nothing"])
    assert "no family is called nothing" in capsys.readouterr().err


def test_the_table_says_how_many_are_decided_and_which_are_not() -> None:
    undecided = {**ROW, "name": "lab 2", "size": 2, "verdict": None, "outcome": "time", "cpu": 10.0, "memory": 900.0}
    rows = [ROW, {**ROW, "name": "lab 1", "size": 1, "verdict": "lost", "cpu": 1.5}, undecided]
    rows.append({**ROW, "name": "factory 3", "size": 3})
    text = ordinary_page.labs({"ordinary": rows})
    line = next(line for line in text.splitlines() if line.startswith("| 10 places"))
    cells = [cell.strip() for cell in line.strip("|").split("|")]
    assert cells[1:] == ["3", "1", "1", "1", "10", "67%", "97%", "1.5", "1.0", "900"]
    assert "Not decided, of 10 places: 2." in text and "20 places" not in text
    families = ordinary_page.families({"ordinary": rows})
    assert "factory 3" in families and "lab" not in families and "2026-11-24 (version abc)" in families
    assert "python -m benchmarks.ordinary" in ordinary_page.labs({}) + ordinary_page.families({})


def test_figures_are_kept_beside_those_of_other_commands(tmp_path: Path, project_root: Path) -> None:
    (tmp_path / "benchmarks").mkdir()
    shutil.copy(project_root / "docs" / "benchmarks" / "results.json", tmp_path / "benchmarks")
    file = tmp_path / "benchmarks" / "results.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "ordinary": []}))
    with mock.patch("benchmarks.ordinary.version", return_value="older"):
        ordinary.keep(tmp_path, [{**ROW, "name": "lab 11", "size": 11}, {**ROW, "name": "lab 2", "size": 2}])
    with mock.patch("benchmarks.ordinary.version", return_value="newer"):
        ordinary.keep(tmp_path, [{**ROW, "name": "factory 3", "size": 3}, {**ROW, "name": "lab 2", "size": 2}])
    kept = [(row["name"], row["version"]) for row in json.loads(file.read_text())["ordinary"]]
    assert kept == [("factory 3", "newer"), ("lab 2", "newer"), ("lab 11", "older")]
    assert "Measured" in (tmp_path / "benchmarks.md").read_text()
