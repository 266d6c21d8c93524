"""Runs pytest; a single test that fails is run once more, alone: if it passes then, it is FLAKY and the run goes on.

    python -m tests.retry [PYTEST ARGUMENT...]

It fails as pytest does where two or more tests fail, where the one fails again, and where pytest ends with anything but
failures of tests: an error of the collection, an interrupted or crashed session. A test whose set-up or clean-up fails
has failed. The last line says which test is flaky.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import List, Optional, Sequence, Set

import pytest

FAILURES = int(pytest.ExitCode.TESTS_FAILED)
_TOLD = "PURSUE_FAILED_TESTS"


class Told:
    """A plug-in that writes down what fails; with pytest-xdist the process that shares out the tests sees all of it."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._failed: Set[str] = set()
        self._others = 0

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """A test's set-up, call or clean-up has ended. A worker that crashed is a report of its own kind."""
        if report.failed and report.when in ("setup", "call", "teardown"):
            self._failed.add(report.nodeid)
        elif report.failed:
            self._others += 1

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """A file has been collected."""
        self._others += report.failed

    def pytest_sessionfinish(self) -> None:
        """All has ended: names, a line each; nothing where more than tests failed."""
        self._file.write_text("" if self._others else "\n".join(sorted(self._failed)), encoding="utf-8")


def pytest_configure(config: pytest.Config) -> None:
    """Called as the plug-in `tests.retry` of the process that shares out the tests."""
    file = os.environ.get(_TOLD)
    if file and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Told(Path(file)))


def only_failed(arguments: Sequence[str], file: Path) -> "tuple[int, List[str]]":
    """Run pytest: its exit status, and the tests that failed, as far as nothing else did."""
    environment = {**os.environ, _TOLD: str(file)}
    command = [sys.executable, "-m", "pytest", "-p", "tests.retry", *arguments]
    status = subprocess.run(command, env=environment, check=False).returncode
    told = file.read_text(encoding="utf-8").splitlines() if file.is_file() else []
    return status, told


def flaky_of(arguments: Sequence[str]) -> "tuple[int, Optional[str]]":
    """Run the tests, and the one that failed once more: the exit status, and the test that is flaky."""
    with tempfile.TemporaryDirectory() as folder:
        status, failed = only_failed(arguments, Path(folder) / "failed")
        if status != FAILURES or len(failed) != 1:
            return status, None
        print(f"\nOnce more, alone: {failed[0]}", flush=True)
        again, _ = only_failed(["-rfE", "-m", "", failed[0]], Path(folder) / "again")
    return (0, failed[0]) if again == 0 else (status, None)


def main() -> int:
    """The exit status of the command."""
    status, flaky = flaky_of(sys.argv[1:])
    if flaky is not None:
        print(f"FLAKY {flaky}", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
