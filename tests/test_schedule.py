"""How tests are shared out among workers."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import List

import pytest

pytest.importorskip("xdist", reason="pytest-xdist is not installed")
from tests.schedule import LONGEST, ROS_WORKERS, best, collected_by, files_in, rank

TESTS = Path(__file__).resolve().parent


def test_the_longest_files_are_there() -> None:
    assert [name for name in LONGEST if not (TESTS / f"{name}.py").is_file()] == []


def test_each_worker_collects_all_files_from_another_one_on() -> None:
    files = files_in([str(TESTS / "zones"), str(TESTS / "synthesis")])
    orders = [collected_by(worker, 5, files) for worker in range(5)]
    assert len({order[0] for order in orders}) == 5
    assert all(sorted(order) == sorted(files) for order in orders)
    on_ros = files_in([str(TESTS / "ros")])
    assert all(sorted(collected_by(worker, 5, on_ros)) == sorted(on_ros) for worker in range(5))


def test_some_workers_collect_tests_on_ros_alone() -> None:
    files = files_in([str(TESTS)])
    assert str(TESTS / "test_schedule.py") in files
    few, *others = [collected_by(worker, len(ROS_WORKERS) + 1, files) for worker in range(len(ROS_WORKERS) + 1)][::-1]
    assert sorted(few) == sorted(files)
    assert others == [files_in([str(TESTS / "ros")])] * len(ROS_WORKERS)
    assert all(sorted(collected_by(worker, 2, files)) == sorted(files) for worker in range(2)), "nobody else is there"


FILES = {
    "test_{}.py": "import pytest\n\n@pytest.mark.parametrize('k', range(4))\ndef test_{}(k):\n    pass\n",
    "ros/test_ros_{}.py": "def test_ros_{}():\n    pass\n",
}


@pytest.mark.parametrize(("chosen", "passed"), [([], 45), (["-k", "test_3"], 4)])
def test_each_test_runs_once_whoever_collected_it(tmp_path: Path, chosen: List[str], passed: int) -> None:
    (tmp_path / "tests/ros").mkdir(parents=True)
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    for name in ("__init__.py", "conftest.py", "schedule.py"):
        shutil.copy(str(TESTS / name), str(tmp_path / "tests"))
    for number in range(10):
        for name, text in FILES.items():
            if number < 5 or "ros" not in name:
                (tmp_path / "tests" / name.format(number)).write_text(text.format(number))
    options = ["-n", "5", "-q", "-p", "no:cacheprovider", *chosen]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    done = subprocess.run(
        [sys.executable, "-m", "pytest", *options, "tests"], cwd=str(tmp_path), stdout=subprocess.PIPE, text=True,
        env={**environment, "PYTHONPATH": str(tmp_path)}, check=False,
    )  # fmt: skip
    assert f"{passed} passed in" in done.stdout, done.stdout


def test_what_is_named_by_hand_is_collected_as_it_is_named() -> None:
    assert files_in([str(TESTS), f"{TESTS}/test_schedule.py"]) == files_in([f"{TESTS}/test_schedule.py::test"]) == []


def test_a_worker_gets_the_longest_file_of_its_kind_and_then_any() -> None:
    long, short = "tests/ros/test_faults.py", "tests/ros/test_deaf.py"
    slow, quick = "tests/scenarios/test_scenarios.py", "tests/test_files.py"
    assert rank(long) < rank(slow) < rank(short) == rank(quick)
    left = [quick, short, slow, long]
    for worker, given in (("gw4", slow), ("gw0", long), ("gw4", quick), ("gw4", short)):
        assert best(left, worker) == given
        left.remove(given)
    assert best([quick, slow], "gw1") == slow
