"""Tests run under Python 3.8, too, with the oldest packages that do."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import List

import pytest

from tests.python38 import build_engine, said

QUICK = [
    "tests/language/test_messages.py", "tests/language/test_parser.py", "tests/language/test_formatter.py",
    "tests/runtime/controller", "tests/runtime/test_bounded.py", "tests/tga/test_translate.py",
]  # fmt: skip
SOLVING = ["tests/partition", "tests/runtime/observer", "tests/workspace/test_mission_test.py"]
"""They solve games, for which solver and checker are built."""


@pytest.fixture(scope="module")
def engine38(python38: str) -> str:
    """That Python, with solver and checker."""
    build_engine(python38)
    return python38


def passed(python: str, *tests: str) -> None:
    """The tests pass under this Python."""
    done = said([python, "-m", "pytest", "-q", "--few", "-p", "no:cacheprovider", *tests])
    assert done.returncode == 0, done.stdout[-5000:]
    assert " passed" in done.stdout.splitlines()[-1]


def test_quick_tests_pass_with_the_oldest_packages(python38: str) -> None:
    passed(python38, *QUICK)


def test_tests_that_solve_games_pass_with_the_native_engine(engine38: str) -> None:
    passed(engine38, *SOLVING)


@pytest.mark.parametrize(
    ("name", "how"), [("scenario_3", []), ("scenario_1", ["--controllers", "general"])], ids=["distributed", "general"]
)
def test_a_workspace_is_the_same_as_with_the_packages_of_today(
    engine38: str, name: str, how: List[str], tmp_path: Path
) -> None:
    trees = []
    for place, python in ((tmp_path / "old", engine38), (tmp_path / "today", sys.executable)):
        done = said([python, "-m", "pursue_gen", "ws", f"scenarios/thesis/{name}.pur", *how, "-o", str(place)])
        assert done.returncode == 0, done.stdout
        assert "native engine" in done.stdout
        files = [path for path in sorted(place.rglob("*")) if path.is_file()]
        trees.append({str(path.relative_to(place)): path.read_bytes() for path in files})
    old, today = trees
    assert sorted(old) == sorted(today) and len(old) > 100
    assert [path for path in old if old[path] != today[path]] == []
