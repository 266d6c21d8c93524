"""Runs a program to its end, or to a limit, and says what it took: processor time and memory of this process alone."""

from __future__ import annotations

import contextlib
import math
import os
import resource
import signal
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Sequence

_BY_THE_CLOCK = 4
"""On a busy machine a second of the processor may take so many by the clock, unless the caller says otherwise."""


@dataclass(frozen=True)
class Ran:
    """What became of a process.

    `status`: its exit status, negative for the signal that ended it; `late`: it was ended at a limit on time; `out`,
    `err`: what it printed; `cpu`: seconds of the processor (user and system); `memory`: MiB, the most that it had.
    """

    status: int
    late: bool
    out: str
    err: str
    cpu: float
    memory: float

    @property
    def last_line(self) -> str:
        """The last line of its messages, or of what it printed; "" where there is neither."""
        lines = (self.err.strip() or self.out.strip()).splitlines()
        return lines[-1].strip() if lines else ""


def run(
    command: Sequence[str], seconds: float, folder: Path, memory: int = 0, by_the_clock: float = _BY_THE_CLOCK
) -> Ran:
    """Runs a command in a folder for at most so many seconds of the processor, so many times as many by the clock, and
    with at most so many MiB of addresses (0: no limit).

    Raises OSError where it cannot be started.
    """
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        # An installed program is compiled, whatever this shell says.
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
        process = subprocess.Popen(
            list(command), cwd=str(folder), env=environment, stdin=subprocess.DEVNULL, stdout=out, stderr=err
        )
        with contextlib.suppress(ProcessLookupError):
            whole = max(1, math.ceil(seconds))
            resource.prlimit(process.pid, resource.RLIMIT_CPU, (whole, whole + 1))
            if memory:
                resource.prlimit(process.pid, resource.RLIMIT_AS, (memory * 2**20, memory * 2**20))
        status, late, usage = _ended(process.pid, by_the_clock * seconds)
        process.returncode = status  # it was waited for here: only that says what one process took
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode(errors="replace"))
    late = late or status == -signal.SIGXCPU
    return Ran(status, late, texts[0], texts[1], usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024)


def _ended(pid: int, seconds: float) -> "tuple[int, bool, resource.struct_rusage]":
    """The exit status of a process that is killed after so many seconds, whether it was, and what it took."""
    deadline = time.monotonic() + seconds
    ended, late = threading.Event(), threading.Event()

    def end_it() -> None:
        if not ended.wait(max(0.0, deadline - time.monotonic())):
            late.set()
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)

    watch = threading.Thread(target=end_it, daemon=True)
    watch.start()
    try:
        _, status, usage = os.wait4(pid, 0)
    except BaseException:  # Ctrl-C: leave nothing behind
        os.kill(pid, signal.SIGKILL)
        os.wait4(pid, 0)
        raise
    finally:
        ended.set()
        watch.join()
    return (-os.WTERMSIG(status) if os.WIFSIGNALED(status) else os.WEXITSTATUS(status)), late.is_set(), usage
