"""How tests are shared out among workers."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("xdist", reason="pytest-xdist is not installed")
from tests.schedule import LONGEST, best, files_in, from_its_share_on, rank

TESTS = Path(__file__).resolve().parent


def test_the_longest_files_are_there() -> None:
    assert [name for name in LONGEST if not (TESTS / f"{name}.py").is_file()] == []


def test_each_worker_collects_all_files_from_another_one_on() -> None:
    files = files_in([str(TESTS)])
    assert str(TESTS / "test_schedule.py") in files
    orders = [from_its_share_on(files, worker, 4) for worker in range(4)]
    assert len({order[0] for order in orders}) == 4
    assert all(sorted(order) == sorted(files) for order in orders)


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
