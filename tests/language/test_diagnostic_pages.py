"""Every message that a person can meet has a page that tells the truth: its bad example is bad, its good one good."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Dict, List, Set, Tuple

import pytest

from pursue_gen.diagnostics import Severity
from pursue_gen.language.checks import check_reading
from pursue_gen.language.parser import read

ROOT = Path(__file__).resolve().parents[2]
PAGES = {page.stem: page.read_text(encoding="utf-8") for page in (ROOT / "docs" / "diagnostics").glob("*.md")}
INDEX = (ROOT / "docs" / "diagnostics.md").read_text(encoding="utf-8")
WITHOUT_EXAMPLE = {"PML001", "PML002", "PML003", "PML018", "PML106", "PML265", "PML266", "PML412"}
"""About a file as a whole, or found by solving or by a survey; tests of their own make such files."""
WITH_EXAMPLE = sorted(code for code in PAGES if code.startswith("PML") and code not in WITHOUT_EXAMPLE)


def used() -> Dict[str, bool]:
    """The codes in the source, and whether they are warnings."""
    found: Dict[str, bool] = {}
    for file in [*(ROOT / "pursue_gen").rglob("*.py"), *(ROOT / "templates").rglob("*.j2")]:
        text = file.read_text(encoding="utf-8")
        for code in re.findall(r"\"([A-Z]{3}\d{3})\"", text):
            found.setdefault(code, False)
        for code in re.findall(r"\bwarning\(\s*\"([A-Z]{3}\d{3})\"", text):
            found[code] = True
    return found


def examples(code: str) -> List[str]:
    return re.findall(r"```pursue\n(.*?)```", PAGES[code], re.S)


def section(code: str, title: str) -> str:
    found = re.search(rf"^## {title}\n+(.*?)(?=\n## |\Z)", PAGES[code], re.S | re.M)
    assert found, f"{code} has no part '{title}'"
    return found.group(1).strip()


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    assert set(PAGES) == set(used())


@pytest.mark.parametrize("code", sorted(PAGES))
def test_a_page_names_the_cause_and_the_cure(code: str) -> None:
    heading = PAGES[code].splitlines()[0]
    assert re.fullmatch(rf"# {code}: \S.*", heading)
    assert len(section(code, "What it means")) > 10
    assert len(section(code, "What to do")) > 10


def test_the_index_lists_every_page_with_its_title_and_severity() -> None:
    rows = re.findall(r"^\| \[(\w+)\]\(diagnostics/(\w+)\.md\)( \(W\))? \| (.*) \|$", INDEX, re.M)
    assert sorted(code for code, *_ in rows) == sorted(PAGES)
    warnings = used()
    for code, file, warns, title in rows:
        assert code == file
        assert PAGES[code].splitlines()[0] == f"# {code}: {title}"
        assert bool(warns) == warnings[code], code


def test_the_examples_are_there() -> None:
    assert len(WITH_EXAMPLE) > 40
    for code in WITH_EXAMPLE:
        assert len(examples(code)) == 2, code


def told(text: str) -> List[Tuple[str, Severity, str]]:
    found = check_reading(read(text, "example.pur"))
    places = [f"line {f.span.line}: " if f.span else "" for f in found]
    return [
        (f.code, f.severity, f"{place}{f.severity.value} {f.code}: {f.message}\n    help: {f.hint}\n")
        for f, place in zip(found, places)
    ]


@pytest.mark.parametrize("code", WITH_EXAMPLE)
def test_the_bad_example_is_bad_in_this_way(code: str) -> None:
    found = told(examples(code)[0])
    assert code in [name for name, *_ in found[:2]]
    (shown,) = re.findall(r"```text\n(.*?)```", PAGES[code], re.S)
    assert shown in [text for *_, text in found]
    assert all("help: \n" not in text for *_, text in found)


@pytest.mark.parametrize("code", WITH_EXAMPLE)
def test_the_good_example_is_good(code: str) -> None:
    assert told(examples(code)[1]) == []


# The command ----------------------------------------------------------------------------------------------------------


def program(*words: str) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, "-m", "pursue_gen", "explain", *words]
    pipe = subprocess.PIPE
    return subprocess.run(command, cwd=str(ROOT), stdout=pipe, stderr=pipe, text=True, check=False)


@pytest.mark.parametrize("word", ["PML110", "pml110", " SYN021"])
def test_explain_prints_the_page(word: str) -> None:
    done = program(word)
    assert (done.returncode, done.stdout, done.stderr) == (0, PAGES[word.strip().upper()], "")


def test_explain_without_a_code_lists_all() -> None:
    done = program()
    assert done.returncode == 0
    listed: Set[str] = {line.split(":")[0] for line in done.stdout.splitlines()}
    assert listed == set(PAGES)


@pytest.mark.parametrize(("word", "proposal"), [("PML11O", "did you mean PML110?"), ("PML", ""), ("../../README", "")])
def test_explain_proposes_what_was_meant(word: str, proposal: str) -> None:
    done = program(word)
    assert (done.returncode, done.stdout) == (2, "")
    assert proposal in done.stderr and "pursue-gen explain lists all" in done.stderr
