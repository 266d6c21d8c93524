"""What continuous integration does with a test that fails: once more, alone."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Dict

import pytest

from tests.conftest import ROOT

GOOD = "def test_good():\n    pass\n"
BAD = "def test_bad():\n    assert False\n"
FLAKY = """
import pathlib
def test_{name}():
    seen = pathlib.Path(__file__).with_suffix('.seen')
    first = not seen.exists()
    seen.touch()
    assert not first
"""
IN_SET_UP = """
import pathlib, pytest
@pytest.fixture
def shaky():
    seen = pathlib.Path(__file__).with_suffix('.seen')
    first = not seen.exists()
    seen.touch()
    assert not first
def test_shaky(shaky):
    pass
"""
IN_CLEAN_UP = IN_SET_UP.replace("def shaky():\n", "def shaky():\n    yield\n")
CRASHED = """
import os, pathlib
def test_crash():
    seen = pathlib.Path(__file__).with_suffix('.seen')
    if not seen.exists():
        seen.touch()
        os._exit(3)
"""


def run(folder: Path, files: Dict[str, str], *arguments: str) -> "subprocess.CompletedProcess[str]":
    for name, text in {"conftest": "", **files}.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    (folder / "pytest.ini").write_text("[pytest]\n", encoding="utf-8")
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment.update(PYTHONPATH=str(ROOT), PYTEST_DISABLE_PLUGIN_AUTOLOAD="1")  # theirs takes longer than the tests
    command = [sys.executable, "-m", "tests.retry", "-p", "no:cacheprovider", *arguments]
    return subprocess.run(
        command, cwd=str(folder), env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        timeout=600, check=False,
    )  # fmt: skip


WORKER = ("-p", "xdist.plugin", "-n", "1")
WAYS = pytest.mark.parametrize("ways", [(), WORKER], ids=["alone", "with a worker"])


@WAYS
@pytest.mark.parametrize(
    ("text", "name"),
    [(FLAKY.format(name="once"), "test_once"), (IN_SET_UP, "test_shaky"), (IN_CLEAN_UP, "test_shaky")],
    ids=["the test", "its set-up", "its clean-up"],
)
def test_a_test_that_passes_the_second_time_is_named(
    text: str, name: str, ways: "tuple[str, ...]", tmp_path: Path
) -> None:
    if ways:
        pytest.importorskip("xdist")
    done = run(tmp_path, {"test_a": GOOD, "test_b": text}, *ways)
    assert done.returncode == 0, done.stdout
    assert done.stdout.splitlines()[-1] == f"FLAKY test_b.py::{name}"
    assert " passed" in done.stdout.splitlines()[-2]


@WAYS
@pytest.mark.parametrize(
    "files",
    [
        {"test_b": BAD},
        {"test_b": FLAKY.format(name="first"), "test_c": FLAKY.format(name="second")},
        {"test_b": FLAKY.format(name="once"), "test_c": BAD},
    ],
    ids=["fails again", "two that are flaky", "one of each"],
)
def test_two_that_fail_or_one_that_fails_again_fail_the_run(
    files: Dict[str, str], ways: "tuple[str, ...]", tmp_path: Path
) -> None:
    if ways:
        pytest.importorskip("xdist")
    done = run(tmp_path, {"test_a": GOOD, **files}, *ways)
    assert done.returncode == 1, done.stdout
    assert "FLAKY" not in done.stdout


def test_a_crashed_worker_and_a_file_that_cannot_be_collected_are_failures_as_they_are(tmp_path: Path) -> None:
    pytest.importorskip("xdist")
    for name, text in (("crashed", CRASHED), ("broken", "import no_such_module\n")):
        folder = tmp_path / name
        folder.mkdir()
        done = run(folder, {"test_a": GOOD, "test_b": text}, *WORKER)
        assert done.returncode not in (0, 5), done.stdout
        assert "FLAKY" not in done.stdout and "Once more" not in done.stdout


def test_where_all_pass_nothing_is_added_and_no_tests_is_no_success(tmp_path: Path) -> None:
    done = run(tmp_path, {"test_a": GOOD})
    assert (done.returncode, "Once more" in done.stdout) == (0, False)
    assert "1 passed" in done.stdout.splitlines()[-1]
    assert run(tmp_path, {}, "-k", "nothing_has_this_name").returncode == 5
