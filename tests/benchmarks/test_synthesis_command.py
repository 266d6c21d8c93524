"""The whole command: which are measured, what is read from them, and their tables."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Dict, List

import pytest

from benchmarks import command
from benchmarks.command import GOALS, Goal, command_measured, files_of
from benchmarks.measure import Bounds
from benchmarks.process import Ran
from pursue_gen.language import check, load

pytestmark = pytest.mark.benchmark

ENOUGH = Bounds(600.0, 2048)
NOWHERE = Path("nowhere")

ROW: Dict[str, Any] = {
    "group": "command", "name": "CT9", "size": None, "game": "default", "verdict": "won", "outcome": "",
    "cpu": 0.5, "goal": 1, "memory": 40.2, "commands": 9, "worst": 26.25, "least": 25.0,
}  # fmt: skip


def goal(title: str, game: str = "default") -> Goal:
    return next(one for one in GOALS if (one.title, one.game) == (title, game))


def cells(line: str) -> List[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def test_a_command_is_measured_as_people_call_it(tmp_path: Path) -> None:
    row = command_measured(goal("scenario 1"), files_of(goal("scenario 1"), NOWHERE, tmp_path), tmp_path, ENOUGH)
    assert (row["verdict"], row["outcome"], row["game"]) == ("won", "", "default")
    assert row["cpu"] > 0 and row["memory"] > 1 and row["blocks"] >= row["commands"] > 0
    assert row["worst"] == pytest.approx(row["least"], rel=0.1)
    assert (tmp_path / "plan.txt").read_text()


def test_a_game_that_is_lost_is_a_verdict(tmp_path: Path) -> None:
    lost = Goal("all ways", "default", 1, size=1)
    row = command_measured(lost, files_of(lost, NOWHERE, tmp_path), tmp_path, ENOUGH)
    assert (row["verdict"], row["outcome"]) == ("lost", "")


def test_the_ideal_game_is_the_ideal_game(tmp_path: Path) -> None:
    ideal = Goal("all ways", "ideal", 1, size=1)
    row = command_measured(ideal, files_of(ideal, NOWHERE, tmp_path), tmp_path, ENOUGH)
    assert (row["verdict"], row["outcome"]) == ("won", "")


def test_a_command_that_cannot_read_its_file_gives_its_reason(tmp_path: Path) -> None:
    (tmp_path / "bad.pur").write_text("nonsense")
    row = command_measured(goal("scenario 1"), [tmp_path / "bad.pur"], tmp_path, ENOUGH)
    assert row.get("verdict") is None and "error" in row["outcome"]


@pytest.mark.parametrize(
    ("status", "late", "out", "outcome"),
    [
        (-9, True, "", "time"),
        (0, False, "no JSON", "it printed no verdict"),
        (-11, False, "", "it ended with status -11"),
        (5, False, json.dumps({"won": None, "diagnostics": [{"message": "no verdict within 4096 MiB of memory; 3"}]}),
         "memory"),
        (5, False, json.dumps({"won": None, "diagnostics": [{"message": "no verdict within 600 seconds; 3"}]}), "time"),
    ],
)  # fmt: skip
def test_without_a_verdict_the_row_says_why(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, status: int, late: bool, out: str, outcome: str
) -> None:
    monkeypatch.setattr(command, "run", lambda *_: Ran(status, late, out, "", 1.0, 50.0))
    row = command_measured(goal("scenario 1"), [], tmp_path, ENOUGH)
    assert row.get("verdict") is None and row["outcome"] == outcome


def test_every_file_of_this_project_is_a_scenario_without_findings(tmp_path: Path) -> None:
    """But for the warning that a published event of two has been written without `together`, which is younger."""
    for one in GOALS:
        if one.size is not None or "/" in one.name:
            (file,) = files_of(one, NOWHERE, tmp_path)
            assert {finding.code for finding in check(load(file))} <= {"PML158"}, one.title


def test_published_scenarios_are_measured_where_they_are_at_hand(reference_dir: Path, tmp_path: Path) -> None:
    published = [one for one in GOALS if one.size is None and "/" not in one.name]
    assert published
    for one in published:
        assert len(files_of(one, reference_dir, tmp_path)) == 2
        assert files_of(one, NOWHERE, tmp_path) == []


def test_no_two_commands_are_the_same() -> None:
    assert len({(one.title, one.game) for one in GOALS}) == len(GOALS)


def test_the_table_says_how_many_reach_their_goal() -> None:
    late = {**ROW, "name": "CT10", "cpu": 0.2, "verdict": None, "outcome": "time", "worst": None, "commands": None}
    slow = {**ROW, "name": "CT11", "cpu": 1.1}
    text = command.table([ROW, late, slow, {"group": "thesis"}])
    lines = text.splitlines()
    assert cells(lines[2]) == ["CT9", "default", "won", "0.500", "1", "40", "9", "26.25"]
    assert cells(lines[3])[2] == "too long" and cells(lines[3])[-1] == "-"
    assert "1 of 3 reach the goal" in text


def test_guaranteed_times_stand_beside_the_least() -> None:
    unknown = {**ROW, "name": "CT10", "least": None}
    lines = command.times_table([ROW, unknown]).splitlines()
    assert [cells(line) for line in lines[2:]] == [["CT9", "default", "26.25", "25", "1.050"]]
