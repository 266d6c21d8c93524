"""What a process took, and that one which does not end is ended."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from benchmarks.process import Ran, run

pytestmark = pytest.mark.benchmark


def python(code: str, seconds: float, folder: Path, memory: int = 0) -> Ran:
    return run([sys.executable, "-c", code], seconds, folder, memory)


def test_status_output_folder_and_cost_are_those_of_the_process(tmp_path: Path) -> None:
    code = "import os, sys; print(os.getcwd()); print('a word', file=sys.stderr); sys.exit(4)"
    ran = python(code, 600, tmp_path)
    assert (ran.status, ran.late, ran.out.strip(), ran.last_line) == (4, False, str(tmp_path), "a word")
    assert ran.cpu > 0 and ran.memory > 1


def test_processor_time_is_that_of_this_process_and_not_of_the_clock(tmp_path: Path) -> None:
    worked = python("import time\nwhile time.process_time() < 0.5: pass", 600, tmp_path)
    slept = python("import time; time.sleep(0.5)", 600, tmp_path)
    assert worked.cpu >= 0.5
    assert slept.cpu < worked.cpu


@pytest.mark.parametrize("code", ["while True: pass", "import time; time.sleep(6000)"])
def test_a_process_that_does_not_end_is_ended(tmp_path: Path, code: str) -> None:
    ran = python(f"print('so far', flush=True)\n{code}", 1, tmp_path)
    assert ran.late and ran.status < 0


def test_a_process_that_wants_too_much_memory_fails(tmp_path: Path) -> None:
    until = "import resource, time\nwhile resource.getrlimit(resource.RLIMIT_AS)[0] < 0: time.sleep(0.01)"
    ran = python(f"{until}\nbytes(2**31)", 600, tmp_path, memory=1024)
    assert ran.status == 1 and "MemoryError" in ran.last_line


def test_a_program_that_does_not_exist_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        run([str(tmp_path / "missing")], 600, tmp_path)
