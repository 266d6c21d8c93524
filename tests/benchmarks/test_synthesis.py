"""The benchmark's command: what it measures, what it writes, and that a case which takes too much does not stop it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any, Dict

import pytest

from benchmarks import command, random_page, synthesis, tables
from benchmarks.families import FAMILIES
from benchmarks.measure import RUNS, Bounds, Case, measured
from benchmarks.plots import pictures
from tests.conftest import thesis_scenario

pytestmark = pytest.mark.benchmark

ENOUGH = Bounds(600.0, 2048)


def family_case(name: str, size: int, game: str) -> Case:
    """A member of a family."""
    text = next(family for family in FAMILIES if family.name == name).text(size)
    return Case("family", name, game, size=size, text=text)


def test_a_case_is_decided_and_proven_in_another_process() -> None:
    row = measured(Case("thesis", "1", "default", file=str(thesis_scenario("1"))), ENOUGH)
    assert (row["verdict"], row["outcome"], row["game"]) == ("won", "", "default")
    assert row["states"] > 0 and row["memory"] > 1 and row["blocks"] >= row["commands"] > 0
    # How long it takes is no matter here: it may be less than one tick of the processor's clock.
    assert isinstance(row["seconds"], float) and row["runs"] == RUNS


@pytest.mark.parametrize("group", ["story", "family"])
def test_a_case_beyond_its_limit_says_so(group: str) -> None:
    text = next(family for family in FAMILIES if family.name == "ring").text(100)
    row = measured(Case(group, "ring", "default", text=text), Bounds(0.05, 2048))
    assert row["outcome"] == "time" and row.get("verdict") is None and row["memory"] > 1


def test_after_a_member_that_is_not_decided_the_rest_of_its_family_is_not_tried(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def by_size(case: Case, _: Bounds) -> Dict[str, Any]:
        late = case.name == "visitors" and case.size == 3
        return {"name": case.name, "size": case.size, **({"outcome": "time"} if late else {"verdict": "won"})}

    monkeypatch.setattr(synthesis, "measured", by_size)
    cases = [family_case("visitors", size, "default") for size in (2, 3, 4)] + [family_case("ring", 4, "ideal")]
    rows = list(synthesis.measurements(cases, ENOUGH))
    assert [row.get("verdict") or row["outcome"] for row in rows] == ["won", "time", "skipped", "won"]


def test_a_family_is_solved_as_the_commands_do_in_stages_too() -> None:
    row = measured(family_case("visitors", 3, "default"), ENOUGH)
    assert (row["verdict"], row["outcome"]) == ("won", "")
    assert row["stages"] > 1 and row["blocks"] > row["commands"] > 0 and row["states"] > 0


def test_a_member_that_is_lost_has_its_states() -> None:
    row = measured(family_case("all ways", 1, "default"), ENOUGH)
    assert (row["verdict"], row["outcome"]) == ("lost", "") and row["states"] > 0


def test_a_case_that_cannot_be_read_gives_its_reason(tmp_path: Path) -> None:
    (tmp_path / "bad.pur").write_text("nonsense")
    row = measured(Case("file", "bad", "ideal", file=str(tmp_path / "bad.pur")), ENOUGH)
    assert row.get("verdict") is None
    assert "expected a statement" in row["outcome"]


def test_the_command_writes_page_and_data_and_adds_to_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    here = ["--out", str(tmp_path), "--no-plots", "--machine", "m", "--date", "d", "--games", "ideal"]
    assert synthesis.main([*here, "--only", "scenario 1"]) == 0
    assert "scenario 1" in capsys.readouterr().out
    assert synthesis.main([*here, "--only", "scenario 2"]) == 0
    results = json.loads((tmp_path / "benchmarks" / "results.json").read_text())
    assert [row["name"] for row in results["rows"]] == ["scenario 1", "scenario 2"]
    page = (tmp_path / "benchmarks.md").read_text()
    assert "scenario 1" in page and "Measured d on m" in page
    assert isinstance(results["load"], float)
    (tmp_path / "benchmarks.md").unlink()
    assert synthesis.main(["--render", "--out", str(tmp_path), "--no-plots"]) == 0
    assert (tmp_path / "benchmarks.md").read_text() == page


def test_names_that_do_not_exist_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        synthesis.main(["--only", "no such thing"])
    assert "no such thing" in capsys.readouterr().err


def test_commands_and_random_games_are_added_to_what_is_there(tmp_path: Path) -> None:
    here = ["--out", str(tmp_path), "--no-plots"]
    assert synthesis.main([*here, "--only", "scenario 1", "--games", "ideal"]) == 0
    file = tmp_path / "benchmarks" / "results.json"
    before = json.loads(file.read_text())
    file.write_text(json.dumps({**before, "driving": []}))
    assert synthesis.main([*here, "--commands", "--only", "scenario 1", "--date", "2031-01-01"]) == 0
    results = json.loads(file.read_text())
    assert results["date"] == before["date"] != "2031-01-01" and results["driving"] == [], "others stay as they are"
    rows = results["rows"]
    assert [(row["group"], row["name"], row["game"]) for row in rows] == [
        ("thesis", "scenario 1", "ideal"),
        ("command", "scenario 1", "default"),
    ]
    page = (tmp_path / "benchmarks.md").read_text()
    assert "of 1 reach the goal. Measured 2031-01-01." in page


def test_all_is_chosen_by_one_word() -> None:
    given = synthesis.options().parse_args(["--all"])
    assert len(synthesis.chosen(given)) == len([*synthesis.scenario_cases(), *synthesis.family_cases(quick=False)])
    assert synthesis.chosen_commands(given) == list(command.GOALS)
    assert synthesis.chosen_random(given) == random_page.GAMES_EACH
    assert synthesis.is_complete(given)


def test_what_is_measured_in_part_is_not_complete() -> None:
    for words in (["--quick"], ["--families"], ["--all", "--only", "ring"], ["--all", "--games", "ideal"]):
        assert not synthesis.is_complete(synthesis.options().parse_args(words))


def test_without_results_there_is_nothing_to_render(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        synthesis.main(["--render", "--out", str(tmp_path)])
    assert "measure first" in capsys.readouterr().err


def test_tigas_figures_stand_beside_the_published_scenarios(reference_dir: Path) -> None:
    cases = {case.name: case for case in synthesis.scenario_cases() if case.group == "reference"}
    assert len(cases) == 13
    assert synthesis.tiga_figures(cases["CT1"]).blocks == 164
    assert synthesis.tiga_figures(cases["EB4"]).states is None


def test_no_two_cases_are_the_same() -> None:
    keys = [case.key for case in [*synthesis.scenario_cases(), *synthesis.family_cases(quick=False)]]
    assert len(set(keys)) == len(keys)


def test_without_git_the_commit_is_unknown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert synthesis.version() == ""


def points(name: str, game: str) -> "list[Dict[str, Any]]":
    """Rows for a picture."""
    row = {"group": "family", "name": name, "game": game, "verdict": "won", "outcome": ""}
    return [{**row, "size": n, "states": n**2, "seconds": 0.01 * n, "commands": n} for n in (1, 2, 5, 10)]


def test_pictures_are_the_same_each_time_and_have_no_colour() -> None:
    pytest.importorskip("matplotlib", reason="only the pictures need it: pip install 'pursue-gen[bench]'")
    rows = points("all ways", "ideal") + points("one way", "default")
    drawn = pictures(rows)
    assert list(drawn) == ["distance.svg"]
    assert drawn == pictures(rows)
    svg = drawn["distance.svg"]
    assert "one way, default" in svg and "dc:date" not in svg
    colours = set(re.findall(r"#([0-9a-f]{2})([0-9a-f]{2})([0-9a-f]{2})\b", svg))
    assert colours and all(red == green == blue for red, green, blue in colours)


def test_a_line_for_the_terminal_fits_its_head() -> None:
    row = {"group": "thesis", "name": "scenario 1", "game": "ideal", "verdict": "won", "states": 10, "seconds": 0.1}
    assert tables.terminal(row).index("|") == tables.HEADLINE.index("|")
