"""Which examples property tests draw: always the same ones, new ones with `--explore`, few with `--few`."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import List

import pytest

CONFTEST = Path(__file__).resolve().parent / "conftest.py"
PROPERTIES = """
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

@pytest.mark.parametrize("name", ["first", "second"])
@settings(max_examples=5)
@given(number=st.integers(0, 10**9))
def test_function(name, number):
    print("drawn", name, number)

class TestMethod:
    @given(number=st.integers(0, 10**9))
    def test_method(self, number):
        print("drawn method", number)

class Machine(RuleBasedStateMachine):
    @rule(number=st.integers(0, 10**9))
    def step(self, number):
        print("drawn machine", number)

TestMachine = Machine.TestCase
TestMachine.settings = settings(max_examples=5, stateful_step_count=1)
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """Three property tests beside the project's own conftest.py."""
    shutil.copy(str(CONFTEST), str(tmp_path))
    (tmp_path / "test_properties.py").write_text(PROPERTIES, encoding="utf-8")
    (tmp_path / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    return tmp_path


def drawn(folder: Path, *options: str) -> List[str]:
    """What the tests draw, in order."""
    words = [sys.executable, "-m", "pytest", "-s", "-p", "no:cacheprovider", "-p", "no:xdist", *options, str(folder)]
    done = subprocess.run(
        words, cwd=str(folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    return [line[line.index("drawn") :] for line in done.stdout.splitlines() if "drawn" in line]


def of(kind: str, lines: List[str]) -> List[str]:
    return [line for line in lines if line.startswith(f"drawn {kind} ")]


def test_examples_are_the_same_in_each_run_and_with_explore_new_and_ten_times_as_many(project: Path) -> None:
    usual = drawn(project)
    assert len(of("first", usual)) == 5
    assert drawn(project) == usual
    explored = drawn(project, "--explore")
    assert drawn(project, "--explore") != explored
    for kind in ("first", "second", "method", "machine"):
        assert len(of(kind, explored)) == 10 * len(of(kind, usual)) > 0, kind


def test_with_few_each_draws_a_tenth_and_one_at_least(project: Path) -> None:
    few = drawn(project, "--few")
    assert [len(of(kind, few)) for kind in ("first", "second", "method", "machine")] == [1, 1, 4, 1]
