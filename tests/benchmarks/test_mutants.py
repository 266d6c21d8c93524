"""Mutants: what is changed, which ones are drawn, and how their tests end."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

from benchmarks.mutants import PARTS, ROOT, drawn, folder_of, mutants_of, ran

pytestmark = pytest.mark.skipif(sys.version_info < (3, 9), reason="writes Python code as only 3.9 and newer can")

CODE = '''"""A docstring of 3 words."""
from typing import List
LIMIT: int = 4


def late(moments: List[float], now: float = 0) -> bool:
    """Whether a moment has passed, é."""
    self.count += 1
    self.seen = now
    log("late")
    if not moments or now < LIMIT:
        return min(moments) - 2 if now else True
    return None
'''

CHANGES = [
    "3: 4 -> 5",
    "6: 0 -> 1",
    "8: self.count += 1 -> pass",
    "8: 1 -> 2",
    "9: self.seen = now -> pass",
    '10: log("late") -> pass',
    "11: not moments or now < LIMIT -> (not moments and now < LIMIT)",
    "11: not moments -> (moments)",
    "11: now < LIMIT -> (now <= LIMIT)",
    "12: return min(moments) - 2 if now else True -> return None",
    "12: min(moments) - 2 if now else True -> (min(moments) - 2 if not now else True)",
    "12: min(moments) - 2 -> (min(moments) + 2)",
    "12: min -> max",
    "12: 2 -> 3",
    "12: True -> False",
]


def test_what_is_changed_and_what_stays() -> None:
    found = list(mutants_of("some.py", CODE))
    assert sorted(f"{each.line}: {each.before} -> {each.after}" for each in found) == sorted(CHANGES)
    for each in found:
        lines = zip(CODE.splitlines(), each.applied(CODE.encode()).decode().splitlines())
        assert [number for number, (old, new) in enumerate(lines, 1) if old != new] == [each.line]


def test_the_same_seed_draws_the_same_and_another_seed_others() -> None:
    part = ["pursue_gen/partition"]
    assert drawn(50, 1, part) == drawn(50, 1, part) != drawn(50, 2, part)
    assert all(each.file.startswith("pursue_gen/partition/") for each in drawn(20, 1, part))
    assert {each.file for each in drawn(5, 1, ["pursue_gen/partition/split.py"])} == {"pursue_gen/partition/split.py"}


def test_each_that_is_drawn_is_a_program_and_another_one() -> None:
    for each in drawn(100, 7):
        text = (ROOT / each.file).read_bytes()
        assert ast.dump(ast.parse(each.applied(text))) != ast.dump(ast.parse(text)), str(each)
        assert (ROOT / folder_of(each.file)).is_dir()


def test_they_are_killed_by_the_tests_of_the_folder_that_mirrors_theirs() -> None:
    assert folder_of("pursue_runtime/controller/goal.py") == "tests/runtime/controller"
    assert folder_of("pursue_runtime/state.py") == PARTS["pursue_runtime"]
    assert folder_of("pursue_gen/proof/native/search.py") == "tests/proof"


@pytest.mark.parametrize(
    ("body", "end"), [("n < 3", "passed"), ("n <= 3", "failed"), ("wait()", "too long"), ("n <", "failed")]
)
def test_how_the_tests_of_a_copy_end(tmp_path: Path, body: str, end: str) -> None:
    wait = "def wait():\n    while True:\n        pass\n"
    (tmp_path / "some_code.py").write_text(f"{wait}\n\ndef late(n):\n    return {body}\n")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_some_code.py").write_text(
        "from some_code import late\n\ndef test_it():\n    assert late(2) and not late(3)\n"
    )
    assert ran(tmp_path, "tests", 3.0)[0] == end
