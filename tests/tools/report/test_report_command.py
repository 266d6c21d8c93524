"""The command: what it writes and where, what it refuses, and what it says when something is missing."""

from __future__ import annotations

import contextlib
import io
import json
import re
import sys
from pathlib import Path
from typing import NamedTuple, Tuple

import pytest

from pursue_gen.cli.app import app
from pursue_gen.tools.report import graphviz, png
from pursue_gen.tools.report.png import available

SCENARIOS = Path(__file__).resolve().parents[3] / "scenarios"
FIRST, CELL = SCENARIOS / "thesis" / "scenario_1.pur", SCENARIOS / "work_cell" / "work_cell.pur"
THIEF = SCENARIOS / "thesis" / "catch_the_thief.pur"
LOST = """
poi "a" poi "b"
connect a and b distance 3
event "catch" collaborative
agent "bot" controllable mobile 3 location a can_do catch
agent "thief" mobile 1 location b reacts_to catch
reach_objective: do catch after 0
"""
CALLED = """poi "desk"
poi "shelf"
connect desk and shelf distance 2
event "callBot"
event "fetch" location shelf
agent "bot" controllable mobile 1 location desk can_do fetch
agent "visitor" location desk can_do callBot
objective: if callBot then fetch within 4
"""


class Result(NamedTuple):
    status: int
    out: str
    err: str


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each test has a folder of its own to be in."""
    monkeypatch.chdir(tmp_path)


def pursue(*words: object) -> Result:
    """The command line; `err` holds all that was message."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), pytest.raises(SystemExit) as end:
        app([str(word) for word in words])
    return Result(int(end.value.code or 0), out.getvalue(), err.getvalue())


def test_the_page_goes_to_the_file_or_beside_and_is_named_on_stdout(tmp_path: Path) -> None:
    result = pursue("report", FIRST, "--html", "--runs", 0)
    assert (result.status, result.out.split()[0]) == (0, "scenario_1_report.html")
    assert (tmp_path / "scenario_1_report.html").read_text().startswith("<!DOCTYPE html>")
    assert pursue("report", FIRST, "--html", "there/page.html", "--runs", 0).status == 0
    assert (tmp_path / "there" / "page.html").read_bytes() == (tmp_path / "scenario_1_report.html").read_bytes()


def test_the_page_goes_where_the_option_says_as_with_other_commands(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    for target, written in (("there/page.html", "there/page.html"), ("folder", "folder/scenario_1_report.html")):
        result = pursue("report", FIRST, "-o", target, "--runs", 0)
        assert (result.status, result.out.split()[0]) == (0, written)
        assert (tmp_path / written).read_text().startswith("<!DOCTYPE html>")
    assert pursue("report", FIRST, "--html", "--output", "both.html", "--runs", 0).status == 0
    assert (tmp_path / "both.html").read_bytes() == (tmp_path / "there" / "page.html").read_bytes()


def test_a_page_with_a_deadline_is_made_of_a_strategy_that_keeps_it(tmp_path: Path) -> None:
    assert pursue("report", FIRST, "-o", "page.html", "--runs", 0, "--within", "23.4").status == 0
    assert "It can be met within 23.4 time units" in (tmp_path / "page.html").read_text()
    assert json.loads(pursue("report", FIRST, "--json", "--within", "23.4").out)["times"]["default"]["worst"] <= 23.4


@pytest.mark.parametrize("words", [("-o", "page.html"), ()])
def test_a_deadline_that_cannot_be_kept_is_reported_as_by_other_commands(
    tmp_path: Path, words: Tuple[str, ...]
) -> None:
    result = pursue("report", FIRST, "--within", "20", *words)
    assert result.status == 4 and "SYN023" in result.err
    assert not list(tmp_path.iterdir())


def test_a_page_replaces_a_page_and_nothing_else(tmp_path: Path) -> None:
    mine = tmp_path / "mine.pur"
    mine.write_text("// my work")
    refused = pursue("report", FIRST, "--html", mine, "--runs", 0)
    assert refused.status == 2 and mine.read_text() == "// my work" and "--force" in refused.err
    assert pursue("report", FIRST, "--html", mine, "--runs", 0, "--force").status == 0
    assert pursue("report", FIRST, "--html", mine, "--runs", 0).status == 0


def test_a_lost_scenario_gets_its_page_too(tmp_path: Path) -> None:
    (tmp_path / "lost.pur").write_text(LOST)
    result = pursue("report", "lost.pur", "--html")
    assert result.status == 0 and "SYN021" in result.err
    assert "It cannot be met" in (tmp_path / "lost_report.html").read_text()


@pytest.mark.skipif(not (graphviz.installed() and available()), reason="graphviz or a maker of PNGs is missing")
def test_every_picture_is_written_twice(tmp_path: Path) -> None:
    result = pursue("report", CELL, "--pictures", "pictures")
    assert result.status == 0
    names = {file.stem for file in (tmp_path / "pictures").iterdir()}
    assert {"map", "strategy", "ros_graph"} < names
    assert {file.name for file in (tmp_path / "pictures").iterdir()} == {
        f"{n}.{end}" for n in names for end in ("svg", "png")
    }
    assert all((tmp_path / line).is_file() for line in result.out.split() if line.startswith("pictures/"))


@pytest.mark.skipif(not graphviz.installed(), reason="graphviz is missing")
def test_without_a_program_for_pngs_pictures_are_written_as_svg_with_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(png.shutil, "which", lambda name: None if name == "rsvg-convert" else f"/usr/bin/{name}")
    monkeypatch.setitem(sys.modules, "cairosvg", None)
    result = pursue("report", CELL, "--pictures", "pictures")
    assert result.status == 0
    assert "warning REP003" in result.err and "librsvg2-bin" in result.err
    files = {file.name for file in (tmp_path / "pictures").iterdir()}
    assert {"map.svg", "strategy.svg", "ros_graph.svg"} < files
    assert {Path(name).suffix for name in files} == {".svg"}
    assert {Path(line).name for line in result.out.splitlines()} == files


@pytest.mark.skipif(not available(), reason="a maker of PNGs is missing")
def test_without_graphviz_the_rest_is_written_and_the_status_is_6(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(graphviz.shutil, "which", lambda name: None if name == "dot" else f"/usr/bin/{name}")
    result = pursue("report", FIRST, "--pictures", "pictures")
    assert result.status == 6 and "apt install graphviz" in result.err
    assert {file.name for file in (tmp_path / "pictures").iterdir()} == {
        f"{name}.{end}" for name in ("map", "timeline") for end in ("svg", "png")
    }


def test_places_that_are_not_on_the_floor_plan_are_reported(tmp_path: Path) -> None:
    (tmp_path / "map.pgm").write_bytes(b"P5 40 40 255 " + b"\xfe" * 1600)
    (tmp_path / "map.yaml").write_text("image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\n")
    result = pursue("report", THIEF, "--pictures", "pictures", "--map", "map.yaml")
    assert (tmp_path / "pictures" / "map.svg").is_file()
    places = re.findall(r"WSP008: the pose of (\w) \S+ \S+ is off the map", result.err)
    assert places == ["b", "d"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("page.html",), "-o page.html"),
        (("--html", "page.html", "-o", "other.html"), "two places for one page"),
        (("-o", "page.html", "--json"), "--json is for the tables alone"),
        (("--within", "soon"), "the within is 'soon'"),
        (("--map", "map.yaml"), "--html or --pictures"),
        (("--html", "--json"), "--json is for the tables alone"),
        (("--html", "--map", "none.yaml"), "none.yaml"),
    ],
)
def test_options_without_meaning_are_refused(tmp_path: Path, words: Tuple[str, ...], message: str) -> None:
    result = pursue("report", FIRST, *words)
    assert result.status == 2 and message in result.err
    assert not list(tmp_path.iterdir())


def test_report_compares_controllers_in_one_game() -> None:
    for ends, game in (("reported", "default"), ("controllable", "ideal")):
        told = pursue("report", FIRST, "--ends", ends)
        assert told.status == 0
        assert f"One strategy of the {game} game" in told.out and f"\n{game} game: " in told.out
        table = json.loads(pursue("report", FIRST, "--ends", ends, "--json").out)
        assert (table["ends"], list(table["margins"])) == (ends, [game])
        commands = {row["controller"]: row["commands"] for row in table["controllers"]}
        assert (commands["General"] > commands["Centralized"]) == (ends == "controllable")
    refused = pursue("report", FIRST, "--ends", "controllable", "--html")
    assert refused.status == 2 and "--ends is for the tables alone" in refused.err


def test_report_in_the_ideal_game_alone_does_not_need_the_default_one(tmp_path: Path) -> None:
    """One that is won in the ideal game only, as it is with ws."""
    file = tmp_path / "called.pur"
    file.write_text(CALLED)
    assert pursue("report", file).status == 4
    assert pursue("report", file, "--ends", "controllable").status == 0
