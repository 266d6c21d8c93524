"""Which files of tests execute which lines, and how they end in a copy of the project. `./run mutants` asks it."""

from __future__ import annotations

import contextlib
import os
import resource
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, FrozenSet, Iterable, List, Mapping, Optional, Sequence, Set

import coverage

_TIMES, _MORE = 3.0, 10.0
"""Tests of a mutant may take so many times the processor time that they usually take, and so many seconds more."""

_WALL = 4.0
"""By the clock they may take so many times that: they may wait for ever without computing."""

_FIRST, _GROWTH = 1.5, 4.0
"""Seconds of the tests that are tried first, and how many times longer the next ones may take."""

_PACKAGES = ("pursue_runtime", "pursue_gen")

_START = "import coverage\n\ncoverage.process_startup()\n"
"""Python executes a module of this content, sitecustomize, in each process that the tests start."""

_SETTINGS = """\
[run]
parallel = true
data_file = {data}
include = {files}
disable_warnings = no-data-collected, module-not-measured
"""

ENDS = {0: "passed", 1: "failed", 2: "failed", 4: "failed", 5: "passed"}
"""What pytest's statuses mean; 5: all that was chosen was skipped."""


@dataclass(frozen=True)
class Measured:
    """A file of tests: how it ends without a mutant, its seconds, and which lines of each file it executes."""

    name: str
    end: str
    seconds: float
    lines: Mapping[str, FrozenSet[int]]

    def executes(self, file: str, lines: range) -> bool:
        """Whether it executes one of these lines."""
        return not self.lines.get(file, frozenset()).isdisjoint(lines)


def measured(folder: Path, name: str) -> Measured:
    """A file of tests, run in a copy of the project. What is executed counts also in processes that the tests start;
    not in those that are killed."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "sitecustomize.py").write_text(_START)
        (Path(place) / "coverage").symlink_to(Path(coverage.__file__).parent)  # nodes have the system's Python
        settings = Path(place) / "settings"
        files = ", ".join(f"*/{package}/*" for package in _PACKAGES)
        settings.write_text(_SETTINGS.format(data=Path(place) / "data", files=files))
        began = time.monotonic()
        end = ran(folder, [name], None, {"COVERAGE_PROCESS_START": str(settings), "PYTHONPATH": f"{place}:{folder}"})
        seconds = time.monotonic() - began
        lines: Dict[str, Set[int]] = {}
        for each in Path(place).glob("data.*"):
            data = coverage.CoverageData(str(each))
            with contextlib.suppress(coverage.CoverageException):  # of a process that was killed while it wrote
                data.read()
                for path in data.measured_files():
                    lines.setdefault(_from_the_root(path), set()).update(data.lines(path) or ())
    return Measured(name, end, seconds, {file: frozenset(found) for file, found in lines.items()})


def _from_the_root(path: str) -> str:
    """The name of a file of ours; also of one that was copied into a workspace."""
    parts = Path(path).parts
    first = max(number for number, part in enumerate(parts) if part in _PACKAGES)
    return "/".join(parts[first:])


def batches(files: Iterable[Measured], of: str) -> List[List[Measured]]:
    """The files of tests of a mutant: those first that have the name of its file `of`, then the quickest ones; each
    further batch may take longer than the one before."""
    own = f"test_{Path(of).stem}"
    ordered = sorted(files, key=lambda each: each.seconds)
    found = [batch for batch in [[each for each in ordered if Path(each.name).stem == own]] if batch]
    most, so_far = 0.0, 0.0
    for each in [each for each in ordered if Path(each.name).stem != own]:
        if so_far + each.seconds > most:
            most = max(_FIRST, most * _GROWTH, each.seconds)
            found.append([])
            so_far = 0.0
        found[-1].append(each)
        so_far += each.seconds
    return found


def outcome(folder: Path, files: Iterable[Measured], of: str) -> str:
    """How these tests end in a copy in which the file `of` is a mutant: "passed", or as the first that do not pass."""
    for batch in batches(files, of):
        end = ran(folder, [each.name for each in batch], _TIMES * sum(each.seconds for each in batch) + _MORE)
        if end != "passed":
            return end
    return "passed"


def ran(folder: Path, tests: Sequence[str], cpu: Optional[float], variables: Optional[Mapping[str, str]] = None) -> str:
    """How the tests end in a copy: "passed", "failed", "too long" (`cpu` is in seconds), or what pytest says."""
    most = resource.RLIM_INFINITY if cpu is None else int(cpu) + 1
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1", **(variables or {})}
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", *tests]
    process = subprocess.Popen(
        command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        start_new_session=True, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (most, most)),
    )  # fmt: skip
    try:
        status: Optional[int] = process.wait(None if cpu is None else _WALL * cpu)
    except subprocess.TimeoutExpired:
        status = None
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    if status in (None, -signal.SIGKILL, -signal.SIGXCPU):
        return "too long"
    return ENDS.get(status, f"pytest ended with {status}")
