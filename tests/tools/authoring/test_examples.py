"""`pursue-gen examples`: which scenarios there are, and how one gets into a folder of one's own."""

from __future__ import annotations

from pathlib import Path

import pytest

from pursue_gen.language import load
from pursue_gen.tools.authoring.examples import about, examples, examples_dir, listed

from .commands import pursue

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_every_scenario_is_listed_with_what_it_is_about() -> None:
    done = pursue("examples")
    assert done.status == 0 and "next: pursue-gen examples NAME" in done.err
    listing = dict(line.split(maxsplit=1) for line in done.out.splitlines())
    files = {
        path.relative_to(ROOT / "scenarios").with_suffix("").as_posix() for path in ROOT.glob("scenarios/**/*.pur")
    }
    assert set(listing) == files
    assert list(listing) == sorted(listing)
    assert listing["thesis/scenario_1"].startswith("Scenario 1 of the thesis (listing 5.1): bot2 waits")
    assert listing["thesis/scenario_4"].endswith("together, four robots.")
    assert all(len(text) > 20 for text in listing.values())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("// One thing. Another.\n", "One thing."),
        ('// One\n//   thing: two.\n\n// more\npoi "a"', "One thing: two."),
        ("/* One\n * thing. Two */ x", "One thing."),
        ("\n\n  // Is it? Yes\n", "Is it?"),
        ("// About scenario 1.5 of e.g. this\n", "About scenario 1.5 of e.g. this"),
        ('poi "a" // no\n', ""),
        ("", ""),
    ],
)
def test_the_first_sentence_tells_what_it_is_about(text: str, expected: str) -> None:
    assert about(text) == expected


def test_on_a_terminal_lines_are_broken_behind_the_names(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "70")
    lines = listed(examples(), terminal=True).splitlines()
    assert len(lines) > len(examples()) and all(len(line) <= 70 for line in lines)
    column = max(len(each.name) for each in examples()) + 2
    assert all(line[column - 2 : column] == "  " and line[column] != " " for line in lines)


def test_an_example_is_copied(folder: Path) -> None:
    done = pursue("examples", "thesis/scenario_1")
    assert (done.status, done.out) == (0, "scenario_1.pur\n")
    assert (folder / "scenario_1.pur").read_bytes() == (ROOT / "scenarios/thesis/scenario_1.pur").read_bytes()
    assert load(folder / "scenario_1.pur").name == "scenario_1"
    for name in ("scenario_2", "scenario_2.pur", "thesis/scenario_2.pur"):
        assert pursue("examples", name, "-o", "sub").out == "sub/scenario_2.pur\n"


def test_what_stands_there_is_not_replaced_without_force(folder: Path) -> None:
    assert pursue("examples", "scenario_2").status == 0
    assert pursue("examples", "scenario_2").status == 0
    (folder / "scenario_2.pur").write_text("mine", encoding="utf-8")
    done = pursue("examples", "scenario_2")
    assert done.status == 2 and "--force" in done.err
    assert (folder / "scenario_2.pur").read_text(encoding="utf-8") == "mine"
    assert pursue("examples", "scenario_2", "--force").status == 0
    assert load(folder / "scenario_2.pur").name == "scenario_2"


@pytest.mark.parametrize(
    ("name", "hint"),
    [("one_oficer", "did you mean catch_the_thief/one_officer?"), ("xyzzy", "pursue-gen examples"), ("", "examples")],
)
def test_what_is_no_example_is_reported(folder: Path, name: str, hint: str) -> None:
    done = pursue("examples", name)
    assert done.status == 2 and hint in done.err
    assert list(folder.iterdir()) == []


def test_a_name_that_two_have_is_reported(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    for place in ("a", "b"):
        (folder / "own" / place).mkdir(parents=True)
        (folder / "own" / place / "same.pur").write_text(f"// {place}\n", encoding="utf-8")
    monkeypatch.setattr("pursue_gen.tools.authoring.examples.examples_dir", lambda: folder / "own")
    done = pursue("examples", "same")
    assert done.status == 2 and "a/same, b/same" in done.err
    assert pursue("examples", "b/same").status == 0
    assert (folder / "same.pur").read_text(encoding="utf-8") == "// b\n"


def test_in_a_checkout_they_are_the_checkout_s() -> None:
    assert examples_dir() == ROOT / "scenarios"
