"""Tables of simulated missions with faults, and the page that shows them."""

from __future__ import annotations

import json
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict, List

import pytest

from benchmarks import simulation, simulation_page
from benchmarks.simulation import bundled, cells, kind_of, main

pytestmark = pytest.mark.benchmark


def row(scenario: str, missions: int, **more: Any) -> Dict[str, Any]:
    facts = {"scenario": scenario, "faults": "loss", "missions": missions, "margin": 0.3, "latest": 0.125}
    facts.update({"ends": {"goal": missions}, "causes": {}, "examples": [], "date": "2026-01-01", "commit": "aaaaaaa"})
    return {**facts, **more}


def test_a_cell_counts_the_ends_of_the_first_missions_and_is_the_same_again() -> None:
    (found,) = cells(("thesis/scenario_1", [("loss", 12)], 600.0))
    assert (found["missions"], found["ends"], found["causes"]) == (12, {"goal": 12}, {})
    assert found["margin"] == 10.0 and 0.0 < found["latest"] < 0.2
    assert cells(("thesis/scenario_1", [("loss", 12)], 600.0)) == [found]


def test_a_scenario_that_cannot_be_won_has_no_cell() -> None:
    assert cells(("catch_the_thief/two_officers", [("loss", 3)], 600.0)) == []


def test_causes_have_three_kinds() -> None:
    command = "go in state 3 was due for 0.9 time units, the margin is 0.3; bot is late"
    assert kind_of("lost", command) == "command"
    assert kind_of("lost", "bot has failed") == kind_of("lost", "bot_end came outside the model's window") == "agent"
    assert [kind_of("failed", cause) for cause in ("", command, "bot has failed")] == ["ours"] * 3


def test_a_mission_that_fails_a_check_is_ours_whatever_fault_it_had(monkeypatch: pytest.MonkeyPatch) -> None:
    ends = [("lost", "bot is late", "too late"), ("failed", "bot is late", "wrong command"), ("lost", "bot failed", "")]

    def play(stage: Any, settings: Any, seed: int, remaining: Any) -> Any:
        end, cause, reason = ends[seed - 1]
        return SimpleNamespace(end=end, cause=cause, reason=reason, lateness=0.0)

    monkeypatch.setattr(simulation, "simulate_mission", play)
    (found,) = cells(("thesis/scenario_1", [("all", 3)], 600.0))
    assert (found["ends"], found["causes"]) == ({"failed": 1, "lost": 2}, {"agent": 2, "ours": 1})
    assert found["examples"][0] == {"seed": 2, "cause": "wrong command"}


def test_tables_add_up() -> None:
    lost = {"goal": 7, "lost": 2, "stopped": 1}
    example = [{"seed": 4, "cause": "go in state 3 was due for 0.9 time units, the margin is 0.3"}]
    rows = {"a": row("one", 10), "b": row("two", 10, ends=lost, causes={"command": 2}, latest=0.9, examples=example)}
    table = simulation_page.tables({"cells": rows})
    assert "| one | 0.3 | 10 | 10 | 100.00 | 0 | 0 | 0 | 0.125 | 0 | 0 | 0 |" in table
    assert "| all |  | 20 | 17 | 85.00 | 1 | 0 | 2 | 0.900 | 2 | 0 | 0 |" in table
    assert "| two | `loss` | 4 | go in state 3 was due for" in simulation_page.examples({"cells": rows})
    text = simulation_page.count({"cells": rows})
    assert text.startswith("20 missions, 0 of them with all faults; 0 of them failed")


def test_the_page_says_which_rows_were_played_when_and_with_which_commit() -> None:
    new = {"date": "2026-02-02", "commit": "bbbbbbb"}
    rows = {"a": row("one", 10), "b": row("two", 10), "c": {**row("one", 10), "faults": "all", **new}}
    assert played_rows(rows) == ["| 2026-02-02 | bbbbbbb | `all` |", "| 2026-01-01 | aaaaaaa | `loss` |"]
    rows["b"].update(new)
    rows["d"] = {**row("two", 10), "faults": "orders"}
    assert played_rows(rows) == [
        "| 2026-02-02 | bbbbbbb | `all`; `loss` of two |",
        "| 2026-01-01 | aaaaaaa | `orders`; `loss` of one |",
    ]


def played_rows(rows: Dict[str, Any]) -> List[str]:
    """The lines of the table of when rows were played."""
    return [line for line in simulation_page.count({"cells": rows}).splitlines() if line.startswith("| 20")]


def test_a_row_that_is_played_gets_a_stamp_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(simulation, "_played", lambda jobs, processes: [[{**row("one", 10), "faults": "orders"}]])
    monkeypatch.setattr(simulation, "version", lambda: "bbbbbbb")
    path = tmp_path / "benchmarks" / "simulation.json"
    path.parent.mkdir()
    path.write_text(json.dumps({"cells": {"loss one": row("one", 10)}}))
    main(["--out", str(tmp_path), "--only", "orders"])
    cells = json.loads(path.read_text())["cells"]
    assert [cell["commit"] for cell in cells.values()] == ["aaaaaaa", "bbbbbbb"]
    assert cells["loss one"]["date"] == "2026-01-01" < cells["orders one"]["date"]


def test_the_page_shows_the_data(project_root: Path) -> None:
    results = json.loads((project_root / "docs" / "benchmarks" / "simulation.json").read_text())
    page = (project_root / "docs" / "simulated_faults.md").read_text()
    assert set(re.findall(r"<!-- measured: ([a-z ]+) -->", page)) == set(simulation_page.PARTS)
    assert simulation_page.filled(page, results) == page, "run: python -m benchmarks.simulation --out docs"


def test_no_mission_of_the_page_was_lost_without_a_fault_that_was_too_long(project_root: Path) -> None:
    results = json.loads((project_root / "docs" / "benchmarks" / "simulation.json").read_text())
    assert not any(found["causes"].get("ours") for found in results["cells"].values())
    for found in (found for found in results["cells"].values() if found["faults"] in ("loss", "restart")):
        good = found["ends"].get("goal", 0) + found["ends"].get("safe", 0)
        assert "lost" not in found["ends"] and good >= 0.999 * found["missions"], found


def test_the_command_writes_the_page_and_keeps_what_it_did_not_play(tmp_path: Path) -> None:
    (tmp_path / "benchmarks").mkdir()
    for faults in ("loss=0.2", "orders"):
        words = ["--out", str(tmp_path), "--only", faults, "--scenarios", "thesis/scenario_1", "--seconds", "0"]
        assert main(words) == 0
    cells = json.loads((tmp_path / "benchmarks" / "simulation.json").read_text())["cells"]
    assert {key: found["missions"] for key, found in cells.items()} == {
        "loss=0.2 thesis/scenario_1": 1, "orders thesis/scenario_1": 1
    }  # fmt: skip
    assert "(`loss=0.2`)" in (tmp_path / "simulated_faults.md").read_text()
    assert "thesis/scenario_1" in bundled()
