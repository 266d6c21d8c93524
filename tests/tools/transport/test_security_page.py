"""docs/security.md claims nothing without a test, and the tests that it names exist; so do those of docs/faults.md."""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path
from typing import List, Set

import pytest

ROOT = Path(__file__).resolve().parents[3]
SECURITY, FAULTS = ((ROOT / "docs" / name).read_text(encoding="utf-8") for name in ("security.md", "faults.md"))
NAMED = re.compile(r"`(?:((?:\w+/)*test_\w+\.py|…))?(?:::(\w+…?))?`")


def rows(text: str) -> List[List[str]]:
    """The cells of all tables, without heads and rulers."""
    lines = [line.strip() for line in text.splitlines()]
    heads = {number for number, line in enumerate(lines) if number + 1 < len(lines) and _ruler(lines[number + 1])}
    body = [line for number, line in enumerate(lines) if line.startswith("|") and number not in heads]
    return [[cell.strip() for cell in line.strip("|").split(" | ")] for line in body if not _ruler(line)]


def _ruler(line: str) -> bool:
    return re.fullmatch(r"\|( *-+:? *\|)+", line) is not None


@functools.lru_cache(maxsize=None)
def names_in(file: Path) -> Set[str]:
    """Names of tests in a file, also of those that are assigned (state machines of hypothesis)."""
    found: Set[str] = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found.add(node.name)
        elif isinstance(node, ast.Assign):
            found.update(target.id for target in node.targets if isinstance(target, ast.Name))
    return {name for name in found if name.startswith(("test_", "Test"))}


CLAIMS = rows(SECURITY.split("## What we do\n", 1)[1].split("\n## ", 1)[0])


def test_every_claim_has_a_test() -> None:
    assert len(CLAIMS) > 30
    for cells in CLAIMS:
        assert len(cells) == 2, cells
        assert re.fullmatch(r"`tests/[\w/]*test_\w+\.py::\w+`(, `tests/[\w/]*test_\w+\.py::\w+`)*", cells[1]), cells


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`(tests/[\w/]*test_\w+\.py::\w+)`", SECURITY))))
def test_a_test_that_is_named_exists(name: str) -> None:
    file, _, test = name.partition("::")
    assert (ROOT / file).is_file(), name
    assert test in names_in(ROOT / file), name


def test_every_section_of_the_page_that_is_linked_is_there() -> None:
    found = re.findall(r"^#+ (.*)$", SECURITY, re.MULTILINE)
    heads = {re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-") for head in found}
    assert set(re.findall(r"\]\(#([\w-]+)\)", SECURITY)) <= heads


def test_every_fault_has_a_test_that_exists() -> None:
    """Names are short: `test_x.py`, `ui/test_x.py`, `test_x.py::test_y`, `…::test_y` of the same file, `test_y_…`."""
    found = rows(FAULTS)
    assert len(found) > 25
    for cells in found:
        shown = cells[-1]
        files: List[Path] = []
        for file, test in NAMED.findall(shown):
            if file not in ("", "…"):
                found_files = (ROOT / "tests").rglob(file.rsplit("/", 1)[-1])
                files = sorted(path for path in found_files if path.as_posix().endswith(f"/{file}"))
                assert files, (file, cells)
            names = set().union(*map(names_in, files))
            start = test.rstrip("…")
            assert not test or any(name == test or (test != start and name.startswith(start)) for name in names), cells
        assert files or "the same" in shown, cells
